"""Reference runs of stock OpenFOAM solvers on the same case: twoPhaseEulerFoam (two fluids), reactingParcelFoam
(droplets).

Two fluids take their files from `openfoam_case_templates/<scene>/tfm`, what a scene has not from `two_fluid/tfm`,
droplets from `droplets/dpm`; every physical number reaches them from the case. A run is kept in the user's cache.
"""

from __future__ import annotations

import dataclasses
import os
import re
import shutil
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from coupling.gas import GasError
from coupling.openfoam import fields, poly_mesh
from coupling.openfoam.case import DEPTH, HEAD, others, refuse_reference, write_case
from coupling.openfoam.code import refuse_code
from coupling.openfoam.comparators import (
    droplet_cloud,
    droplet_fields,
    droplet_log,
    droplet_numbers,
    droplet_sources,
    known,
    price,
    remedies,
    two_fluid_fields,
    two_fluid_numbers,
)
from coupling.openfoam.comparators.droplet_sources import Drops
from coupling.openfoam.comparators.reference import Reference, keep, key, load
from coupling.openfoam.comparators.start import Start, digest_of_mesh
from coupling.openfoam.programs import barrier, build, install
from coupling.openfoam.programs import run as programs
from coupling.openfoam.start_fields import EMPTY
from sdph.case.sections import Case, Coupling
from sdph.scenes import paths
from sdph.schema import CaseError

PARCEL_FILES = {"d": "diameter", "T": "temperature", "nParticle": "count", "rho": "density", "U": "velocity"}
TEMPLATES = paths.data("openfoam_case_templates")
SHARED = {"tfm": TEMPLATES / "two_fluid" / "tfm", "dpm": TEMPLATES / "droplets" / "dpm"}
CLOUD = "lagrangian/reactingCloud1"
# folders of a case; numbers are times
OPENFOAM = re.compile(r"system|constant|dynamicCode|postProcessing|processor.*|[-+.\d].*|inf.*|nan.*")


@dataclass(frozen=True)
class Solver:
    """A stock solver: its name, the solver as it must be on cells that are no boxes, the kind of template, the macro
    file it needs besides the case's, the programs that prepare a run, its start fields, its fields (file -> name here)
    and the probes that a template may ask for (name -> file -> column)."""

    name: str
    off_boxes: Callable[[], Path]
    kind: str
    macros: str
    prepare: tuple[str, ...]
    start_fields: Callable[..., dict[str, str]]
    fields: dict[str, str]
    probes: dict[str, dict[str, str]]


TWO_FLUID = Solver(
    name="twoPhaseEulerFoam",
    off_boxes=install.two_fluid_solver,
    kind="tfm",
    macros="sdphTwoFluid",
    prepare=("blockMesh", "setFields"),
    start_fields=two_fluid_fields.start_fields,
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
    off_boxes=install.droplet_solver,
    kind="dpm",
    macros="sdphDroplets",
    prepare=("blockMesh",),
    start_fields=droplet_fields.start_fields,
    fields={
        "T": "gas_temperature",
        "U": "gas_velocity",
        "p": "pressure",
        "rho": "density",
        droplet_fields.VAPOUR: "vapour_mass_fraction",
    },
    probes={},
)


def run_two_fluid(
    case: Case,
    folder: Path,
    ranks: int = 1,
    courant: float = two_fluid_numbers.COURANT,
    start: Start | None = None,
    again: bool = False,
) -> Reference:
    """Run twoPhaseEulerFoam on the case in `folder`, or take what it gave from the cache.

    `courant` is the largest Courant number of inlets and of grains at the start. `start` says how the grains stand
    then, and on which mesh; without it the scene's template does. `again`: run whatever the cache has. `GasError` when
    OpenFOAM fails.
    """
    mesh = poly_mesh.read(start.mesh) if start and start.mesh else None
    numbers = two_fluid_numbers.macros(case, courant, mesh)
    files, told = {TWO_FLUID.macros: _macros(TWO_FLUID.macros, numbers)}, price.of_two_fluids(case, numbers, mesh)
    try:
        return _run(TWO_FLUID, case, folder, ranks, files, told, start, start.mesh if start else None, again)
    except GasError as error:
        step = float(numbers.get("time_step") or numbers["first_time_step"])
        raise GasError(f"{error}{remedies.remedy(str(error), mesh, step)}") from None


def run_droplets(
    case: Case,
    folder: Path,
    drops: Drops | None = None,
    courant: float = droplet_numbers.COURANT,
    mesh: Path | None = None,
) -> Reference:
    """Run reactingParcelFoam on the case in `folder`, or take what it gave from the cache.

    `drops` are those at the start; `courant` is that of the fastest droplet or inlet; `mesh` is an OpenFOAM case whose
    mesh is taken, without it that of the case's box. Serial: parcels enter on one rank. Masses of a plane case are by
    the metre. `CaseError` where the case has what the reference lacks, `GasError` when OpenFOAM fails.
    """
    known.refuse(droplet_cloud.lacks(case))
    drops = droplet_sources.none(case.dimensions) if drops is None else drops
    own, depth = poly_mesh.read(mesh) if mesh else None, DEPTH
    if own and case.dimensions == 2:
        depth = float(np.ptp(own.points[:, 2]))
    files, told = _droplet_files(case, drops, courant, own, depth)
    found = _run(DROPLETS, _less(case), folder, 1, files, told, mesh=mesh)
    return found if depth == DEPTH else droplet_log.by_the_metre(found, depth)


def _droplet_files(case: Case, drops: Drops, courant: float, mesh, depth: float) -> tuple[dict[str, str], str]:
    """Files in `constant` that tell of the droplets, and words on their price; `depth` [m] is that of a plane mesh."""
    numbers = droplet_numbers.macros(case, drops, courant, mesh)
    step, middle = float(numbers["time_step"]), float(mesh.points[:, 2].mean()) if mesh else 0.5 * depth
    injectors = droplet_sources.injectors(case, drops, step)
    patches = [name for name, patch in mesh.patches.items() if patch.kind != EMPTY] if mesh else list(case.boundaries)
    tables = {
        each.name: HEAD.format(name=each.name) + droplet_sources.table(case, each, middle, depth) for each in injectors
    }
    cloud = droplet_cloud.cloud(case, injectors, patches, step, depth)
    told = price.of_droplets(case, injectors, step, mesh)
    return tables | {DROPLETS.macros: _macros(DROPLETS.macros, numbers), "sdphCloud": cloud}, told


def _less(case: Case) -> Case:
    """The case less what reaches the droplets otherwise or not at all, so that one run of them serves all of ours."""
    groups = {"particles": {}, "nozzles": {}, "probes": {}, "parameters": {}, "effects": (), "track": ()}
    run = dataclasses.replace(case.run, metrics=(), report_at=(), forces=())
    resolution = dataclasses.replace(case.resolution, spacing=case.resolution.cell)
    more = {"title": "", "scene": "", "coupling": Coupling(), "run": run, "resolution": resolution}
    return dataclasses.replace(case, **groups, **more)


def _run(
    solver: Solver, case: Case, folder: Path, ranks: int, files: dict[str, str], told: str, start: Start | None = None,
    mesh: Path | None = None, again: bool = False,
) -> Reference:  # fmt: skip
    refuse_reference(case, folder)
    known.refuse_no_output(case)
    environment = _environment(solver)
    _clear(folder)
    own = SHARED[solver.kind] if start or solver is DROPLETS else template(case, solver.kind)
    _write(solver, case, folder, ranks, own, mesh)
    for name, text in files.items():
        (folder / "constant" / name).write_text(text, encoding="utf-8")
    begun = start.digest if start else digest_of_mesh(mesh)
    program = str(solver.off_boxes()) if mesh else solver.name  # stock is right on boxes alone
    made_with = [program, install.require().package, *(path.name for path in _libraries(solver)), begun]
    kept = shelf() / f"{key(folder, ' '.join(made_with))}.npz"
    if kept.exists() and not again:
        programs.say(f"{folder.name}: {solver.name} ran this before; delete {kept} to run it anew")
        return load(kept)
    programs.say(f"{folder.name}: {solver.name} begins, {told}")
    for tool in () if mesh else ("blockMesh",) if start else solver.prepare:
        programs.run([tool], folder, folder / f"log.{tool}", environment)
    if start:
        _cells(folder, environment)
        two_fluid_fields.tell_start(folder, start)
    began = time.perf_counter()
    programs.run_solver(program, folder, folder / f"log.{solver.name}", case.run.end_time, environment, ranks)
    reference = _read(solver, folder, environment, time.perf_counter() - began)
    keep(reference, kept)
    return reference


def _write(solver: Solver, case: Case, folder: Path, ranks: int, own: Path, mesh: Path | None) -> None:
    """The case of OpenFOAM, less its macros of a solver: files that all cases share, what a scene has of its own in
    `own`, and start fields where it has none. Our own templates, our own library: code in them is allowed."""
    shared = SHARED[solver.kind]
    if mesh:  # it may come from elsewhere
        shutil.copytree(mesh / poly_mesh.FOLDER, folder / poly_mesh.FOLDER)
        refuse_code(folder)
    if not (own / "system" / "controlDict").exists():
        shutil.copytree(own, folder, dirs_exist_ok=True)
        own = shared
    if own == shared:
        (folder / "0").mkdir(parents=True, exist_ok=True)
        for name, text in solver.start_fields(case, others(case, folder) if mesh else None).items():
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
    """The folder of OpenFOAM files of a case's scene, of a kind."""
    if not case.scene or not (folder := TEMPLATES / case.scene / kind).is_dir():
        raise CaseError(f"scene = {case.scene!r} has no OpenFOAM reference of kind {kind!r}")
    return folder


def _macros(name: str, values: dict[str, str]) -> str:
    return HEAD.format(name=name) + "".join(f"{key} {value};\n" for key, value in values.items())


def _environment(solver: Solver) -> dict[str, str]:
    """Environment of OpenFOAM's programs, in which a solver finds its libraries."""
    variables = barrier.environment(libraries=True)
    places = [*map(str, _libraries(solver)), *filter(None, [variables.get("LD_LIBRARY_PATH")])]
    return variables | ({"LD_LIBRARY_PATH": os.pathsep.join(places)} if places else {})


def _libraries(solver: Solver) -> list[Path]:
    """Folders of the libraries of ours that a solver loads: two fluids our closures, droplets none."""
    return [] if solver is DROPLETS else [install.two_fluid_closures().parent]


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
        history=droplet_log.history(folder / f"log.{solver.name}") if solver is DROPLETS else _history(solver, folder),
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
