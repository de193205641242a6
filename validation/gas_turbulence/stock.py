"""A gas of sdphGasFoam and one of OpenFOAM's own pimpleFoam, on the same mesh with the same fields and conditions."""

from __future__ import annotations

import contextlib
import re
import shutil
from pathlib import Path
from typing import NamedTuple

import numpy as np

from coupling.openfoam import fields
from coupling.openfoam.programs import install
from coupling.openfoam.programs import run as programs
from coupling.openfoam.solver import OpenFoamGas
from coupling.openfoam.start_fields import start_fields
from coupling.transport.messages import decode
from sdph.case import read as cases
from sdph.scenes import paths

DENSITY, VISCOSITY = 1.2, 1.8e-5  # kg/m3, Pa s: air, rounded
OWN = ("U", "k", "epsilon", "omega", "nut")
UPWIND = "Gauss linearUpwind grad(U)"  # scheme of the convection of momentum, in the template and below
HEAD = "FoamFile {{ version 2.0; format ascii; class dictionary; object {name}; }}\n"
# schemes of the template, under the names that the stock solver gives to terms
SCHEMES = """ddtSchemes { default Euler; }
gradSchemes { default Gauss linear; }
divSchemes
{
    default Gauss linear;
    div(phi,U) Gauss linearUpwind grad(U);
    "div\\(phi,(k|epsilon|omega)\\)" Gauss limitedLinear 1;
}
laplacianSchemes { default Gauss linear corrected; }
interpolationSchemes { default linear; }
snGradSchemes { default corrected; }
wallDist { method meshWave; }
"""
SOLVERS = """solvers
{
    "(p|pFinal)" { solver GAMG; smoother GaussSeidel; tolerance 1e-7; relTol 0; maxIter 100; }
    "(U|k|epsilon|omega).*" { solver smoothSolver; smoother symGaussSeidel; tolerance 1e-15; relTol 0; maxIter 200; }
}
"""
CONTROL = """application pimpleFoam; startFrom startTime; startTime 0; stopAt endTime; endTime {end!r}; deltaT {dt!r};
writeControl timeStep; writeInterval {steps}; writeFormat ascii; writePrecision 17; timePrecision 12;
runTimeModifiable no;
"""
FROZEN = "nCorrectors 0; momentumPredictor no;"  # of PIMPLE: the velocity stands still, in both solvers
FREE = "nCorrectors 2; momentumPredictor yes;"


def case(size, cell: float, boundaries: dict, turbulence: dict, viscosity: float = VISCOSITY):
    """A case of gas alone in a box of `size` [m] with cells of `cell` [m]."""
    air = {
        "density_kg_m3": DENSITY, "viscosity_Pa_s": viscosity, "conductivity_W_m_K": 0.025,
        "heat_capacity_J_kg_K": 1000.0, "temperature_K": 300.0,
    }  # fmt: skip
    return cases.from_table({
        "title": "turbulent gas", "dimensions": len(size), "effects": [],
        "run": {"end_time_s": 1e4, "output_interval_s": 1e4},
        "domain": {"size_m": list(map(float, size)), "gravity_m_s2": [0.0] * len(size)},
        "resolution": {"spacing_mm": cell * 1e3, "cell_mm": cell * 1e3},
        "gas": air | {"turbulence": turbulence},
        "grains": {"density_kg_m3": 2500.0, "diameter_mm": 0.5, "heat_capacity_J_kg_K": 800.0,
                   "conductivity_W_m_K": 1.0},
        "boundaries": boundaries,
    })  # fmt: skip


class Mesh(NamedTuple):
    """A mesh of one's own: its blockMeshDict less the head, type of the patches that the case does not name, and the
    scheme of the convection of momentum on it."""

    blocks: str
    others: dict[str, str]
    convection: str


def convecting(schemes: str, scheme: str) -> str:
    """Text of fvSchemes with another scheme of the convection of momentum; ValueError where it has not that of ours."""
    if UPWIND not in schemes:
        raise ValueError(f"fvSchemes does not have {UPWIND}")
    return schemes.replace(UPWIND, scheme)


@contextlib.contextmanager
def started(own, folder: Path, start: dict | None = None, control: str = FREE, mesh: Mesh | None = None):
    """The gas of a case, in `folder`/gas; `start` (field -> numbers in cells) replaces start fields of the case."""
    template = folder / "template"
    shutil.copytree(paths.data("openfoam_case_templates") / "disc_cluster" / "gas", template)
    if mesh:
        blocks = HEAD.format(name="blockMeshDict") + mesh.blocks
        (template / "system" / "blockMeshDict").write_text(blocks, encoding="utf-8")
        schemes = template / "system" / "fvSchemes"
        schemes.write_text(convecting(schemes.read_text(encoding="utf-8"), mesh.convection), encoding="utf-8")
    numbers = template / "system" / "fvSolution"
    text = numbers.read_text(encoding="utf-8").replace("tolerance       1e-10;", "tolerance       1e-15;")
    numbers.write_text(f"{text[: text.index('PIMPLE')]}PIMPLE {{ {control} }}\n", encoding="utf-8")
    (template / "0").mkdir()
    for name, values in (start or {}).items():
        (template / "0" / name).write_text(
            _holding(start_fields(own, mesh and mesh.others)[name], values), encoding="utf-8"
        )
    gas = OpenFoamGas(own, folder / "gas", template)
    try:
        yield gas
    finally:
        gas.close()


def _holding(text: str, values: np.ndarray) -> str:
    """A start field with `values` in its cells, (C,) or (C, 3)."""
    vector = values.ndim == 2
    rows = [f"({' '.join(map(repr, row))})" if vector else repr(row) for row in values.tolist()]
    inside = f"internalField nonuniform List<{'vector' if vector else 'scalar'}> {len(rows)} ({' '.join(rows)});"
    return re.sub(r"internalField uniform [^;]*;", lambda _: inside, text)


def remembered(gas, folder: Path, names: tuple[str, ...] = OWN) -> dict[str, np.ndarray]:
    """Fields of the gas, which runs on one rank, as its checkpoint has them; name.2 is that on the third patch."""
    gas.checkpoint(folder)
    values = decode((folder / "gas.0").read_bytes()).values
    return {name: np.asarray(values[name]) for name in names if name in values}


def pimple(
    gas, own, folder: Path, dt: float, steps: int, control: str = FREE, more: dict[str, str] | None = None
) -> dict[str, np.ndarray]:
    """Fields of pimpleFoam after `steps` of `dt` [s] from the start of a gas of a case; `more` are texts of files that
    it has besides or instead."""
    for name in ("constant/polyMesh", "0"):
        shutil.copytree(gas.case_folder / name, folder / name)
    shutil.copy(gas.case_folder / "constant/turbulenceProperties", folder / "constant")
    pressure = (folder / "0/p_rgh").read_text().replace("[1 -1 -2 0 0 0 0]", "[0 2 -2 0 0 0 0]")
    pressure = pressure.replace("type fixedFluxPressure; value uniform 0;", "type zeroGradient;")
    (folder / "0/p").write_text(pressure.replace("object p_rgh", "object p"))
    texts = {
        "constant/transportProperties": f"transportModel Newtonian; nu {own.gas.viscosity / own.gas.density!r};\n",
        "system/controlDict": CONTROL.format(end=dt * steps, dt=dt, steps=steps),
        "system/fvSchemes": SCHEMES,
        "system/fvSolution": f"{SOLVERS}PIMPLE {{ {control} }}\n",
    } | (more or {})
    for name, text in texts.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(HEAD.format(name=name.partition("/")[2]) + text)
    programs.run(["pimpleFoam"], folder, folder / "log.pimpleFoam", install.environment())
    last = fields.times(folder)[-1][1]
    return {name: fields.read(last / name, len(gas.mesh.volumes)) for name in OWN if (last / name).exists()}


def furthest(ours, theirs) -> float:
    """Largest difference over the largest value."""
    return float(np.abs(np.ravel(ours) - np.ravel(theirs)).max() / np.abs(theirs).max())
