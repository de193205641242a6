"""Flows of grains, droplets and liquids by SPH particles, coupled to a finite-volume gas.

    import sdph
    case = sdph.Case.load("disc_cluster")
    case["resolution.spacing_mm"] = 1.25
    run = sdph.run(case, gas="embedded", out="my_run")
    run.history.plot("time_s", "disc_centre_temperature_K")

What is public stands in `PUBLIC`, described in sdph.api; each name is imported when it is first asked for, so that
`sdph --help` is quick.
"""

import importlib

from sdph.engine import device as environment
from sdph.version import __version__

PUBLIC = {  # name -> the module that has it
    "Case": "sdph.api.case", "CaseError": "sdph.schema", "Run": "sdph.api.results", "Tank": "sdph.api.tank",
    "explain": "sdph.api.explaining", "load": "sdph.api.results", "resume": "sdph.api.running",
    "run": "sdph.api.running", "stepping": "sdph.api.running",
}  # fmt: skip
ROOMS = ("laws", "scenes")  # packages that are public as they are
__all__ = [*PUBLIC, *ROOMS, "__version__"]

environment.prepare()


def __getattr__(name: str):
    if name in ROOMS:
        return importlib.import_module(f"sdph.{name}")
    if name not in PUBLIC:
        raise AttributeError(f"module 'sdph' has no attribute {name!r}; it has: {', '.join(sorted(__all__))}")
    found = globals()[name] = getattr(importlib.import_module(PUBLIC[name]), name)
    return found


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
