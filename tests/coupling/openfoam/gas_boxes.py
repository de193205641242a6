"""Cases of gas alone in a box, run by sdphGasFoam, and shorthands of their tests."""

import contextlib

import numpy as np

from coupling.openfoam.solver import OpenFoamGas
from sdph.case.read import from_table
from sdph.scenes import paths

TEMPLATE = paths.data("openfoam_case_templates") / "disc_cluster" / "gas"
AIR = {
    "density_kg_m3": 1.2, "viscosity_Pa_s": 1.8e-5, "conductivity_W_m_K": 0.025, "heat_capacity_J_kg_K": 1000.0,
    "temperature_K": 300.0,
}  # fmt: skip
WALLS = {"walls": {"kind": "wall"}}


def box_case(
    size, cell, *, boundaries=WALLS, gravity=None, vapour=None, ranks=1, transport="socket", stretch=None, **gas
):
    """A case of gas alone: `size` [m], cubes of `cell` [m], `gas` overriding AIR."""
    d = len(size)
    table = {
        "title": "gas alone", "dimensions": d, "effects": [],
        "run": {"end_time_s": 1.0, "output_interval_s": 1.0},
        "domain": {"size_m": [float(s) for s in size], "gravity_m_s2": [float(g) for g in gravity or [0.0] * d]},
        "resolution": {"spacing_mm": cell * 1e3, "cell_mm": cell * 1e3} | ({"stretch": stretch} if stretch else {}),
        "gas": AIR | gas,
        "grains": {"density_kg_m3": 2500.0, "diameter_mm": 0.5, "heat_capacity_J_kg_K": 800.0,
        "conductivity_W_m_K": 1.0},
        "boundaries": boundaries,
        "coupling": {"gas_ranks": ranks, "transport": transport},
    }  # fmt: skip
    return from_table(table | ({"vapour": vapour} if vapour else {}))


def template(folder, outers=None):
    """A case for sdphGasFoam without start fields and mesh, in `folder`/template; of so many `outers` in a step, or of
    as many as it has by itself."""
    for part in ("constant", "system"):
        (folder / "template" / part).mkdir(parents=True, exist_ok=True)
        for path in (TEMPLATE / part).iterdir():
            (folder / "template" / part / path.name).write_bytes(path.read_bytes())
    if outers:
        with open(folder / "template" / "system" / "fvSolution", "a", encoding="utf-8") as file:
            file.write(f"\nPIMPLE {{ nOuterCorrectors {outers}; }}\n")
    return folder / "template"


@contextlib.contextmanager
def box(folder, *args, outers=None, **kwargs):
    """A running gas solver on a case of `box_case`; `outers` as `template` has them."""
    gas = OpenFoamGas(box_case(*args, **kwargs), folder / "gas", template(folder, outers))
    try:
        yield gas
    finally:
        gas.close()


def total(gas, per_volume):
    """Volume integral of a cell field."""
    return np.tensordot(gas.mesh.volumes, per_volume, axes=(0, 0))
