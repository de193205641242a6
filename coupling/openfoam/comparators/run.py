"""Reference runs of stock OpenFOAM solvers on the same case: twoPhaseEulerFoam (two fluids), reactingParcelFoam
(droplets).

A run takes its files from `openfoam_case_templates/<scene>/{tfm,dpm}`, two fluids of what a scene has not from
`two_fluid/tfm` there; every physical number reaches it from the case by macros. A finished run is kept in the user's
cache, so that it is made once.
"""

from __future__ import annotations

import os
import re
import shutil
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from coupling.openfoam import fields, poly_mesh
from coupling.openfoam.case import HEAD, others, write_case
from coupling.openfoam.code import refuse_code
from coupling.openfoam.comparators import droplet_numbers, two_fluid_fields, two_fluid_numbers
from coupling.openfoam.comparators.reference import Reference, keep, key, load
from coupling.openfoam.comparators.start import Start
from coupling.openfoam.programs import barrier, build, install
from coupling.openfoam.programs import run as programs
from coupling.openfoam.programs.run import Progress
from sdph.case.sections import Case
from sdph.scenes import paths
from sdph.schema import CaseError

PARCEL_FILES = {"d": "diameter", "T": "temperature", "nParticle": "count", "rho": "density", "U": "velocity"}
SHARED = paths.data("openfoam_case_templates") / "two_fluid" / "tfm"
CLOUD = "lagrangian/reactingCloud1"
# folders of a case; numbers are times
OPENFOAM = re.compile(r"system|constant|dynamicCode|postProcessing|processor.*|[-+.\d].*|inf.*|nan.*")


@dataclass(frozen=True)
class Solver:
    """A stock solver: its name, the kind of template, the macro file it needs besides the case's, the programs that
    prepare a run, its fields (file -> name here) and the probes that a template may ask for (name -> file ->
    column)."""

    name: str
    kind: str
    macros: str
    prepare: tuple[str, ...]
    fields: dict[str, str]
    probes: dict[str, dict[str, str]]


TWO_FLUID = Solver(
    name="twoPhaseEulerFoam",
    kind="tfm",
    macros="sdphTwoFluid",
    prepare=("blockMesh", "setFields"),
    fields={
        "alpha.particles": "alpha_p",
        "T.particles": "particle_temperature",
        "T.gas": "gas_temperature",
        "U.particles": "particle_velocity",
        "U.gas": "gas_velocity",
        "Theta.particles": "granular_temperature",
        "p": "pressure",
    },
    probes={"centre": {"T.particles": "centre_temperature_K", "T.gas": "centre_gas_temperature_K"}},
)
DROPLETS = Solver(
    name="reactingParcelFoam",
    kind="dpm",
    macros="sdphDroplets",
    prepare=("blockMesh",),
    fields={"T": "gas_temperature", "U": "gas_velocity", "p": "pressure", "C10H22": "vapour_mass_fraction"},
    probes={},
)


def run_two_fluid(
    case: Case,
    folder: Path,
    ranks: int = 1,
    progress: Progress | None = None,
    courant: float = two_fluid_numbers.COURANT,
    start: Start | None = None,
    again: bool = False,
) -> Reference:
    """Run twoPhaseEulerFoam on the case in `folder`, or take what it gave from the cache.

    `progress(time, end)` [s] hears where the run is; `courant` is the largest Courant number of inlets and of grains
    at the start. `start` says how the grains stand then, and on which mesh; without it the scene's template does.
    `again`: run whatever the cache has. `GasError` when OpenFOAM fails.
    """
    mesh = poly_mesh.read(start.mesh) if start and start.mesh else None
    files = {TWO_FLUID.macros: two_fluid_numbers.macros(case, courant, mesh)}
    return _run(TWO_FLUID, case, folder, ranks, files, progress, start, again)


def run_droplets(
    case: Case,
    source: droplet_numbers.Nozzle | droplet_numbers.Plug,
    liquid: droplet_numbers.Liquid,
    folder: Path,
    progress: Progress | None = None,
    courant: float = droplet_numbers.COURANT,
) -> Reference:
    """Run reactingParcelFoam on the case in `folder`, or take what it gave from the cache; `courant` is that of the
    droplets. Serial: parcels enter on one rank."""
    files = {
        DROPLETS.macros: droplet_numbers.macros(case, source, liquid, courant),
        "nozzle": droplet_numbers.source_rows(case, source),
    }
    return _run(DROPLETS, case, folder, 1, files, progress)


def _run(
    solver: Solver, case: Case, folder: Path, ranks: int, files: dict, progress: Progress | None,
    start: Start | None = None, again: bool = False,
) -> Reference:  # fmt: skip
    environment = _environment()
    _clear(folder)
    _write(solver, case, folder, ranks, start)
    for name, content in files.items():
        (folder / "constant" / name).write_text(HEAD.format(name=name) + _text(content), encoding="utf-8")
    mesh, begun = (start.mesh, start.digest) if start else (None, "")
    program = str(install.two_fluid_solver()) if mesh else solver.name  # stock is right on boxes alone
    kept = shelf() / f"{key(folder, f'{program} {_made_with()} {begun}')}.npz"
    if kept.exists() and not again:
        return load(kept)
    for tool in solver.prepare if start is None else () if mesh else ("blockMesh",):
        programs.run([tool], folder, folder / f"log.{tool}", environment)
    if start:
        _cells(folder, environment)
        two_fluid_fields.tell_start(folder, start)
    began = time.perf_counter()
    programs.run_solver(program, folder, folder / f"log.{solver.name}", case.run.end_time, progress, environment, ranks)
    reference = _read(solver, folder, environment, time.perf_counter() - began)
    keep(reference, kept)
    return reference


def _write(solver: Solver, case: Case, folder: Path, ranks: int, start: Start | None) -> None:
    """The case of OpenFOAM, less its macros of a solver: files that all cases share, what the scene has of its own, and
    start fields where it has none. Our own templates, our own library: code in them is allowed."""
    own = template(case, solver.kind) if start is None else SHARED
    mesh = start.mesh if start else None
    if mesh:  # it may come from elsewhere
        shutil.copytree(mesh / poly_mesh.FOLDER, folder / poly_mesh.FOLDER)
        refuse_code(folder)
    if not (own / "system" / "controlDict").exists():
        shutil.copytree(own, folder, dirs_exist_ok=True)
        own = SHARED
    if own == SHARED:
        (folder / "0").mkdir(parents=True, exist_ok=True)
        for name, text in two_fluid_fields.start_fields(case, others(case, folder) if mesh else None).items():
            (folder / "0" / name).write_text(text, encoding="utf-8")
    write_case(case, own, folder, ranks, allow_code=True)


def _cells(folder: Path, environment: dict[str, str]) -> None:
    """Write middles and volumes of the cells into `0/C` and `0/V`."""
    for function in ("writeCellCentres", "writeCellVolumes"):
        programs.run(["postProcess", "-func", function, "-time", "0"], folder, folder / f"log.{function}", environment)


def _clear(folder: Path) -> None:
    """Drop what OpenFOAM reads in the folder: of an earlier run, or of whoever made the run folder that it is in."""
    if folder.is_symlink():
        raise CaseError(f"{folder} is a link, and leads out of the run folder; remove it")
    for path in folder.iterdir() if folder.is_dir() else ():
        if path.is_symlink():
            path.unlink()
        elif path.is_dir() and OPENFOAM.fullmatch(path.name):
            shutil.rmtree(path)


def shelf() -> Path:
    """Folder of finished runs."""
    return build.cache().parent / "references"


def template(case: Case, kind: str) -> Path:
    """The folder of OpenFOAM files of a case's scene, `kind` "tfm" or "dpm"."""
    folder = paths.data("openfoam_case_templates") / case.scene / kind
    if not case.scene or not folder.is_dir():
        raise CaseError(f"scene = {case.scene!r} has no OpenFOAM reference of kind {kind!r}")
    return folder


def _text(content: dict[str, str] | str) -> str:
    return content if isinstance(content, str) else "".join(f"{name} {value};\n" for name, value in content.items())


def _environment() -> dict[str, str]:
    """Environment of OpenFOAM's programs, in which they find the closures library."""
    variables = barrier.environment(libraries=True)
    places = [str(install.two_fluid_closures().parent), *filter(None, [variables.get("LD_LIBRARY_PATH")])]
    return variables | {"LD_LIBRARY_PATH": os.pathsep.join(places)}


def _made_with() -> str:
    return f"{install.require().package} {install.two_fluid_closures().parent.name}"


def _read(solver: Solver, folder: Path, environment: dict[str, str], wall: float) -> Reference:
    _cells(folder, environment)
    cells = fields.cell_count(folder)
    outputs = fields.times(folder)
    present = {file: name for file, name in solver.fields.items() if (outputs[-1][1] / file).exists()}
    return Reference(
        solver=solver.name,
        wall=wall,
        centres=fields.read(folder / "0/C", cells),
        volumes=fields.read(folder / "0/V", cells),
        fields={
            when: {name: fields.read(path / file, cells) for file, name in present.items()} for when, path in outputs
        },
        history=_history(solver, folder),
        parcels={when: _parcels(path / CLOUD) for when, path in outputs if (path / CLOUD).is_dir()},
    )


def _history(solver: Solver, folder: Path) -> dict[str, np.ndarray]:
    history = {}
    for probe, columns in solver.probes.items():
        for file, column in columns.items() if (folder / "postProcessing" / probe).is_dir() else ():
            history["time_s"], values = fields.read_probe(folder, probe, file)
            history[column] = values[:, 0]
    return history


def _parcels(folder: Path) -> dict[str, np.ndarray]:
    parcels = {name: fields.read_parcels(folder / file) for file, name in PARCEL_FILES.items()}
    return parcels | {"position": fields.read_parcels(folder / "positions")[:, :3]}
