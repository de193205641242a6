"""Gas alone in a vessel of `meshes`, by sdphGasFoam with the schemes of the template that every case gets."""

from __future__ import annotations

import contextlib
import shutil
from pathlib import Path

import numpy as np

from coupling.openfoam.solver import OpenFoamGas
from sdph.case import read as cases
from sdph.scenes import paths

from . import meshes

DENSITY, HEAT_CAPACITY, TEMPERATURE = 1.2, 1000.0, 300.0  # kg/m3, J/(kg K), K: air, rounded
VISCOSITY, CONDUCTIVITY = 1.8e-5, 0.025  # Pa s, W/(m K)
MOLAR_MASS = 28.96  # kg/kmol
VAPOUR = {
    "molar_mass_kg_kmol": 142.284, "diffusivity_m2_s": 3.79e-6, "heat_capacity_J_kg_K": 2470.0,
    "conductivity_W_m_K": 0.0178, "viscosity_Pa_s": 7e-6,
}  # fmt: skip
DEFAULT = "tolerance       1e-7;"  # of the pressure, in the template
CLOSED = {name: {"kind": "slip_wall"} for name in meshes.PATCHES}
OPEN_ABOVE = CLOSED | {"outlet": {"kind": "pressure_outlet", "pressure_Pa": 0.0}}
# field -> class and dimensions of its start file
FIELDS = {
    "U": ("volVectorField", "[0 1 -1 0 0 0 0]"),
    "p_rgh": ("volScalarField", "[1 -1 -2 0 0 0 0]"),
    "T": ("volScalarField", "[0 0 0 1 0 0 0]"),
}


@contextlib.contextmanager
def started(
    mesh: meshes.Mesh, folder: Path, boundaries=CLOSED, fields=(), gravity=(0.0, 0.0, 0.0), tolerance=None,
    repeats=None, **gas,
):  # fmt: skip
    """A gas solver that runs on `mesh` in `folder`; `fields` are those of `start_field`, `tolerance` that of the
    pressure in place of the template's, `repeats` of its solution at most on crooked faces, `gas` overrides the gas
    above."""
    own = folder / "template"
    shutil.copytree(paths.data("openfoam_case_templates") / "disc_cluster" / "gas", own)
    numbers = own / "system" / "fvSolution"
    text = numbers.read_text(encoding="utf-8")
    if tolerance is not None:
        text = text.replace(DEFAULT, f"tolerance       {tolerance};")
    if repeats is not None:
        text = text.replace("PIMPLE\n{", f"PIMPLE\n{{\n    nStraightened {repeats};")
    numbers.write_text(text, encoding="utf-8")
    meshes.write(mesh, own / "constant" / "polyMesh")
    (own / "0").mkdir(exist_ok=True)
    for name, text in fields:
        (own / "0" / name).write_text(text, encoding="utf-8")
    solver = OpenFoamGas(_case(mesh, boundaries, gravity, **gas), folder / "gas", own)
    try:
        yield solver
    finally:
        solver.close()


def _case(mesh, boundaries, gravity, vapour=None, **gas):
    size = (mesh.points.max(axis=0) - mesh.points.min(axis=0)).tolist()
    air = {
        "density_kg_m3": DENSITY, "viscosity_Pa_s": VISCOSITY, "conductivity_W_m_K": CONDUCTIVITY,
        "heat_capacity_J_kg_K": HEAT_CAPACITY, "temperature_K": TEMPERATURE, "molar_mass_kg_kmol": MOLAR_MASS,
    }  # fmt: skip
    table = {
        "title": "gas alone", "dimensions": 3, "effects": [],
        "run": {"end_time_s": 100.0, "output_interval_s": 100.0},
        "domain": {"size_m": size, "gravity_m_s2": list(map(float, gravity))},
        "resolution": {"spacing_mm": 50.0, "cell_mm": 50.0},  # of grains and a box that are not there
        "gas": air | gas,
        "grains": {"density_kg_m3": 2500.0, "diameter_mm": 0.5, "heat_capacity_J_kg_K": 800.0,
                   "conductivity_W_m_K": 1.0},
        "boundaries": boundaries,
    }  # fmt: skip
    return cases.from_table(table | ({"vapour": vapour} if vapour else {}))


def start_field(name: str, conditions: dict[str, str]) -> tuple[str, str]:
    """Name and text of a start field that is 0 inside (300 K of T), from patch -> condition."""
    cls, dimensions = FIELDS[name]
    inside = {"volVectorField": "(0 0 0)", "volScalarField": repr(TEMPERATURE) if name == "T" else "0"}[cls]
    rows = "".join(f"    {patch} {{ {condition} }}\n" for patch, condition in conditions.items())
    head = meshes.HEAD.format(cls=cls, name=name)
    return name, f"{head}dimensions {dimensions};\ninternalField uniform {inside};\nboundaryField\n{{\n{rows}}}\n"


def fixed(values: np.ndarray) -> str:
    """Condition of a patch: values (F,) or (F, 3), one a face."""
    rows = [repr(v) if isinstance(v, float) else f"({' '.join(map(repr, v))})" for v in values.tolist()]
    kind = "vector" if values.ndim == 2 else "scalar"
    return f"type fixedValue; value nonuniform List<{kind}> {len(rows)} ({' '.join(rows)});"


SLIPS, LEVEL = "type slip;", "type fixedFluxPressure; value uniform 0;"


def total(gas, per_volume: np.ndarray):
    """Volume integral of a cell field (C,) or (C, 3)."""
    return np.tensordot(gas.mesh.volumes, per_volume, axes=(0, 0))
