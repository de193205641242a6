"""`sdph compare`: a run against a reference."""

from __future__ import annotations

from pathlib import Path

from sdph.running import output
from sdph.schema import CaseError
from sdph.study import two_fluid
from sdph.study.compare import open_run, scene_module


def compare(folder: Path, against: str) -> list[dict]:
    """The checks of a run against `tfm`, `dpm` or `exact`, the scene's own first; the figure goes to the run folder."""
    run = open_run(folder)
    if run.case.mixed and against != "exact":
        raise CaseError(
            f"--against {against}: its grains are of one material, and those of {folder} of several "
            f"({', '.join(run.case.materials)}); compare a run of one"
        )
    module = scene_module(run.case.scene)
    shared = {"tfm": two_fluid.tfm} if run.case.grains and not run.case.vapour else {}
    function = getattr(module, against, shared.get(against))
    if function is None:
        known = [name for name in ("exact", "tfm", "dpm") if hasattr(module, name) or name in shared]
        raise CaseError(
            f"--against {against}: {run.case.scene or 'this case'} has no such reference; it has: "
            f"{', '.join(known) or 'none'}"
        )
    try:
        checks = function(run)
    except KeyError as error:  # regions, effects and arrays go by the names that the scene gives them
        lacks = f"{folder} cannot be compared as {run.case.scene}: it has no {error}"
        raise CaseError(f"{lacks}; compare a run of the scene as it is") from None
    if not checks:
        raise CaseError(
            f"the run ends at {run.summary['time_s']:g} s, before the first time that its reference tells of; go on "
            f"with: sdph run --resume {folder} --until T"
        )
    output.write_json(folder / f"compare_{against}.json", {"checks": checks})
    return checks
