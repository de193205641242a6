"""Small cases of moving particles for tests."""

from sdph.case import read as cases
from sdph.running.alone import Alone

SPACING = 1e-4  # m


def case(effects=("free_energy_tension", "laminar_viscosity"), sections=None, dimensions=3):
    """A drop of 8 spacings across, or what `sections` make of it; None takes a key out."""
    middle = [4e-3] * dimensions
    table = {
        "title": "drop", "dimensions": dimensions, "effects": list(effects),
        "run": {"end_time_s": 1e-3, "output_interval_s": 1e-4},
        "domain": {"size_m": [8e-3] * dimensions, "gravity_m_s2": [0.0] * dimensions},
        "resolution": {"spacing_mm": 1e3 * SPACING, "smoothing_ratio": 1.0},
        "method": {"name": "mps"},
        "liquid": {"density_kg_m3": 780.0, "viscosity_Pa_s": 2.4e-3},
        "pools": {"drop": {"shape": "sphere" if dimensions == 3 else "disc", "centre_m": middle, "radius_m": 4e-4}},
    }  # fmt: skip
    if "free_energy_tension" in effects:
        table["free_energy_tension"] = {"coefficient_N_m": 0.024}
    return cases.from_table(joined(table, sections or {}))


def joined(table: dict, other: dict) -> dict:
    """A table with what another one has put in its place, in all its parts."""
    found = dict(table)
    for key, value in other.items():
        found[key] = joined(found.get(key, {}), value) if isinstance(value, dict) else value
    return {key: value for key, value in found.items() if value is not None}


def started(folder, own) -> Alone:
    run = Alone(own, folder / "ledger.csv")
    run.start()
    return run
