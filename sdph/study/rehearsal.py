"""Rehearsal of `sdph run` up to its first window, without a gas: what cannot be is refused."""

from __future__ import annotations

import contextlib
import math
import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from coupling.choice import OWN_MESH, expected, refuse_elsewhere
from coupling.openfoam import cell_sizes, poly_mesh
from sdph.case import forces
from sdph.case.gas_cells import cell_edges, cells
from sdph.engine import state as particles
from sdph.engine.state import WALL
from sdph.exchange.window import Window
from sdph.methods.grains import start
from sdph.methods.grains.grains import Grains
from sdph.methods.liquids import bodies as immersion
from sdph.methods.liquids.parts import Parts
from sdph.methods.liquids.start import parts_of as parts_of_liquid
from sdph.methods.liquids.start import pipe_walls
from sdph.methods.mps.method import MpsStepper
from sdph.methods.solids.method import SolidStepper
from sdph.running import inputs, metrics, vessel
from sdph.schema import CaseError
from sdph.study import closed_vessels, crossing
from sdph.study import memory as room
from sdph.study.explain import prices

# method -> what makes all of it that a run begins with
MADE = {
    "grains": lambda case: (Grains(case), Window(case)), "liquid": parts_of_liquid, "mps": MpsStepper,
    "solid": SolidStepper,
}  # fmt: skip


def priced(case, template: Path):
    """Gas that a run would have, for estimates of its time; None for the embedded solver's, or without any. `template`
    as `rehearsed` yields it."""
    if "grains" not in case.matters or expected(case.only("grains")) == "embedded":
        return None
    if not (template / poly_mesh.FOLDER).is_dir():
        return prices.by_openfoam(math.prod(cells(case)))
    mesh = poly_mesh.read(template)
    grains = case.only("grains")
    through = crossing.flow(grains, mesh)
    crossed = crossing.among_grains(grains, mesh, _held(grains, cell_sizes.middles(mesh)), through)
    own = {"edges": _edges(grains, mesh), "crossed": crossed, "fastest": crossing.fastest(mesh, through)}
    return prices.by_openfoam(len(mesh.volumes))._replace(**own)


def _edges(case, mesh) -> tuple[float, float, np.ndarray]:
    """Shortest and longest edge [m] of the cells that hold grains at the start, and the shortest of each (C,); where
    none do, medians of all: nobody knows where grains will come to, and cells far off may be large."""
    own = cell_sizes.edges(mesh, case.dimensions)
    held = _held(case, own.middles)
    if not held.any():
        return float(np.median(own.shortest)), float(np.median(own.longest)), own.shortest
    return float(own.shortest[held].min()), float(own.longest[held].max()), own.shortest[held]


def _held(case, middles: np.ndarray) -> np.ndarray:
    """(C,) True for cells with their middles (C, d or more) [m] where grains are at the start."""
    held, middles = np.zeros(len(middles), bool), middles[:, : case.dimensions]
    for region in case.particles.values():
        low, high = start.extents(case, region)
        held |= ((middles >= low) & (middles <= high)).all(axis=1)
    return held


@contextlib.contextmanager
def rehearsed(case, template: Path, *, allow_code: bool = False, whole: bool = False) -> Iterator[tuple]:
    """CaseError where `sdph run` would end with one; then the case with walls as a run would have them, the OpenFOAM
    case with its mesh, as long as the context lasts, and its grains, if they are made. `template` and
    `allow_code` as in `coupling.choice.open_gas`; `whole` makes the particles too, which a run does next."""
    inputs.check(case)
    room.refuse_too_large(case)
    metrics.refuse_unknown(case)
    with _looked_at(case, template, allow_code) as mesh, tempfile.TemporaryDirectory() as folder:
        seen = vessel.foreseen(case, mesh, Path(folder))
        vessel.refuse_beside(seen, mesh if _brings_its_own(case, mesh) else None)
        yield seen, mesh, _made(case, seen, mesh) if whole else None


def _made(case, seen, mesh: Path) -> Grains | None:
    """Make what a run begins with, of the case as it is given and as it is `seen`, and refuse what the run would; the
    grains, if it has any."""
    made = {matter: MADE[case.moved_by(matter)](seen.only(matter)) for matter in case.matters}
    forces.refuse_nowhere(case, {name for matter, one in made.items() for name in _named(seen, matter, one)})
    forces.refuse_cold(case, set(made["grains"][0].heated) if "grains" in made else set())
    if {"liquid", "solid"} <= made.keys():
        _, wet, _ = made["liquid"]
        immersion.beside(case.only("liquid"), wet, particles.positions(made["solid"].state))
    if _brings_its_own(case, mesh):
        vessel.refuse_outside(seen.only("grains"), vessel.Cells(seen, mesh), made["grains"][0].state)
    return made["grains"][0] if "grains" in made else None


def _brings_its_own(case, mesh: Path) -> bool:
    """True where the OpenFOAM case has a mesh that is not to be made."""
    return "grains" in case.matters and (mesh / poly_mesh.FOLDER).is_dir()


def _named(case, matter: str, made) -> tuple[str, ...]:
    """Names of `run.forces` that are walls of what was made for a matter."""
    if matter == "grains":
        return made[0].pushed.names
    if case.moved_by(matter) != "liquid":
        return ()
    _, state, _ = made
    own = range(int((state.kind != WALL).sum()), len(state.x) - pipe_walls(case))
    return Parts(case, state, own).names


@contextlib.contextmanager
def _looked_at(case, template: Path, allow_code: bool) -> Iterator[Path]:
    """The OpenFOAM case with its mesh, where the gas can be made of it."""
    if "grains" not in case.matters:
        yield template
        return
    grains = case.only("grains")
    if expected(grains) == "embedded":
        _embedded(grains, template)
        closed_vessels.refuse_filling(grains, template)
        yield template
        return
    from coupling.openfoam.case import refuse_unread, write_case
    from coupling.openfoam.meshed import meshed
    from coupling.openfoam.programs.installation import require

    require()
    with meshed(grains, template, allow_code) as mesh, tempfile.TemporaryDirectory(prefix="sdph-explain-") as folder:
        made = Path(folder) / "gas"
        write_case(grains, mesh, made, case.coupling.gas_ranks, allow_code)
        refuse_unread(template)  # no code is in it
        closed_vessels.refuse_filling(grains, mesh)
        (made / "case.foam").touch()  # as a run has it, for who reads its mesh
        yield made if (made / poly_mesh.FOLDER).is_dir() else mesh


def _embedded(case, template: Path) -> None:
    """Rehearse what the embedded gas makes of the case before it starts."""
    if own := next((template / name for name in OWN_MESH if (template / name).exists()), None):
        why = (
            "; give --gas openfoam, or take the mesh away"
            if case.coupling.gas == "embedded"
            else ", and OpenFOAM was not found; get it with: sdph openfoam setup --install"
        )
        raise CaseError(f"{own} is a mesh that only OpenFOAM reads{why}")
    refuse_elsewhere(case)
    from coupling.embedded.box import Box
    from coupling.embedded.grid import build_grid

    Box(case, build_grid(cell_edges(case)), limited=True)
