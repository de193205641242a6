"""Walls of grains from the mesh of their gas: what its patches hold back, kept in the run folder as a surface mesh."""

from __future__ import annotations

import dataclasses
import math
import os
from pathlib import Path

import numpy as np

from coupling.choice import OWN_MESH
from coupling.openfoam import patches, poly_mesh
from sdph.case import forces
from sdph.case import read as cases
from sdph.effects.around import nozzles
from sdph.effects.around.streams import streams_of
from sdph.engine import state as particles
from sdph.engine.walls import facets
from sdph.engine.world import ALONE
from sdph.methods.grains import start
from sdph.running import inputs
from sdph.schema import CaseError

FILE, SIZE = "patches.vtk", "domain.size_m"
AS_WRITTEN = 1e-6  # of a volume: as far as text files of a mesh tell it


def walled(case, gas, folder: Path):
    """The case with walls.mesh made of the patches of `gas`, where it asks for them and OpenFOAM's mesh is its own, or
    with boundaries on the sides of the domain, where these are the walls; of a generated mesh all is known without."""
    mesh = own_mesh(gas, folder)
    if mesh is None:
        return case
    _refuse_unknown(case, patches.types(mesh))
    own = case.parameters.get("walls")
    if own is None or (own.mesh and own.source == "gas"):
        return case
    if own.source == "mesh" or own.mesh:
        return dataclasses.replace(case, boundaries=_on_sides(case, poly_mesh.read(mesh)))
    found = _refused_none(patches.facets(mesh, case.boundaries, case.dimensions))
    path = folder / inputs.place("walls.mesh", Path(FILE))
    path.parent.mkdir(parents=True, exist_ok=True)
    facets.save(path, found)
    return _with(case, path)


def _refused_none(found: facets.Facets) -> facets.Facets:
    """Facets that were found; CaseError where none of them holds grains."""
    if found.open.all():
        raise CaseError(
            'walls.source = "gas", and no patch of its mesh holds grains back: call some of type wall, name them in '
            '[boundaries], give walls.mesh, or set walls.source = "mesh" for the sides of the domain'
        )
    return found


def _with(case, path: Path):
    """The case with the walls of a mesh that was made of its patches."""
    made = dataclasses.replace(case.parameters["walls"], source="gas", mesh=os.path.abspath(path))
    found = dataclasses.replace(case, parameters=case.parameters | {"walls": made})
    forces.check(found)
    return found


def _refuse_unknown(case, known) -> None:
    """CaseError where a boundary is no patch of the mesh that the case brings."""
    for name in case.boundaries:
        if name not in known:
            raise CaseError(f"boundaries.{name} is no patch of the mesh of the gas; it has {', '.join(known)}")


def refuse_beside(case, mesh: Path | None) -> None:
    """CaseError where the domain, a mouth or a probe is not where the gas is: before a run, and in its rehearsal.
    `mesh` is the OpenFOAM case with a mesh of its own; None where the gas fills the domain."""
    if mesh:
        _refuse_other_size(case, mesh)
    cells = Cells(case, mesh)
    _refuse_mouths_outside(case, cells)
    _refuse_probes_outside(case, cells)


def own_mesh(gas, folder: Path) -> Path | None:
    """The OpenFOAM case of `gas` where the mesh of the run in `folder` is not made by us, but its own; else None."""
    brought = any((inputs.gas_of(folder) / name).exists() for name in OWN_MESH)
    return Path(gas.case_folder) if brought and hasattr(gas, "case_folder") else None


class Cells:
    """Places of the gas's cells: all over the domain, or those of an own `mesh`."""

    def __init__(self, case, mesh: Path | None):
        self.domain, self.dimensions = case.domain, case.dimensions
        self.grid = None
        if mesh and not fills(case, mesh):
            self.grid = patches.cells(mesh, case.dimensions)

    def outside(self, places) -> np.ndarray:
        """Mask of places (N, d) [m] that are in no cell."""
        if self.grid is not None:
            return np.asarray(self.grid.find_containing_cell(np.pad(places, ((0, 0), (0, 3 - places.shape[1]))))) < 0
        free = np.array([not period for period in self.domain.period[: self.dimensions]])
        return (((places < self.domain.corner) | (places > self.domain.upper)) & free).any(axis=1)


def _refuse_probes_outside(case, cells: Cells) -> None:
    """CaseError where a probe is off a mesh that is no box by more than half a spacing: walls are of facets."""
    for name, probe in case.probes.items() if cells.grid is not None else ():
        place = np.array(probe.at)
        if not cells.outside(place[None])[0]:
            continue
        here = [*place, 0.0][:3]
        _, near = cells.grid.find_closest_cell(here, return_closest_point=True)
        off = math.dist(here, near)
        if off > 0.5 * case.resolution.spacing:
            raise CaseError(
                f"probes.{name}.at_m = {_told(place)} m is in no cell of the gas: the nearest, at "
                f"{_told(near[: case.dimensions])} m, is {off:.3g} m away; move it in"
            )


def _refuse_other_size(case, mesh: Path) -> None:
    """CaseError where the domain is another box than that around the mesh of the gas, by more than a spacing: grains
    would leave the domain within the gas, or have a place where no gas is."""
    low, high = (corner[: case.dimensions] for corner in poly_mesh.box(mesh))
    off = max(np.abs(low - case.domain.corner).max(), np.abs(high - case.domain.upper).max())
    if off > case.resolution.spacing:
        has, given = (
            f"from {_told(a)} to {_told(b)} m" for a, b in ((low, high), (case.domain.corner, case.domain.upper))
        )
        raise CaseError(
            f"the mesh of the gas reaches {has}, and the domain {given}: leave {SIZE} and domain.lower_m out, and "
            f"they are taken from the mesh, or make the mesh anew"
        )


def fills(case, mesh: Path) -> bool:
    """True where a mesh is the whole box of the domain."""
    own = poly_mesh.read(mesh)
    depth = float(np.ptp(own.points[:, 2])) if case.dimensions == 2 else 1.0
    return math.isclose(own.volumes.sum(), math.prod(case.domain.size) * depth, rel_tol=AS_WRITTEN)


def refuse_outside(case, cells: Cells, state, world=ALONE) -> None:
    """CaseError, the same of each process, where grains of a region stand in no cell of a mesh that is no box: region,
    how many, and where."""
    if not case.particles:
        return
    outside = _in_no_cell(cells, state, world)
    own = case.parameters["walls"] if "walls" in case.effects else None
    given = own and own.mesh and own.source != "gas"
    replaced = "; walls.mesh stands in place of the walls of the gas's mesh: it needs both" if given else ""
    for name, region in case.particles.items():
        low, high = start.extents(case, region)
        own = outside[((outside >= low) & (outside <= high)).all(axis=1)]
        if len(own):
            raise CaseError(
                f"particles.{name} holds {len(own)} particles in no cell of the gas, the first at {_told(own[0])} m; "
                f"move or shrink it, or leave what lies behind walls out by walls{replaced}"
            )


def _in_no_cell(cells: Cells, state, world) -> np.ndarray:
    """Places (n, d) [m] of the particles of all processes, each once and in the order of their numbers, that are in no
    cell. The first process alone has a mesh that is no box, and looks for all; every process is told."""
    d = cells.dimensions
    if not world.told(cells.grid is not None):  # regions lie in the domain
        return np.zeros((0, d))
    parts = world.gather((state.ident, particles.positions(state)[:, :d]))
    if parts is None:
        return world.told(None)
    number, places = map(np.concatenate, zip(*parts))
    places = places[np.unique(number, return_index=True)[1]]
    return world.told(places[cells.outside(places)])


def _refuse_mouths_outside(case, cells: Cells) -> None:
    """CaseError where a nozzle has a part of its mouth where nothing can come in. Streams are looked at half a spacing
    past the mouth."""
    for name, nozzle in case.nozzles.items():
        nozzles.check(case, name, nozzle)
        own = streams_of(case, nozzle)
        places = own.mouth + 0.5 * case.resolution.spacing * own.axis
        lost, where = _lost(case, cells, places)
        if lost.any():
            raise CaseError(
                f"nozzles.{name}: {np.count_nonzero(lost)} of its {len(places)} streams come in {where}, the first at "
                f"{_told(places[lost][0])} m; move the mouth in, make it smaller, or square to the wall that it is in"
            )


def _lost(case, cells: Cells, places) -> tuple[np.ndarray, str]:
    """Mask of places (N, d) [m] outside the gas, or outside the domain without one, where what comes in leaves at once
    or flies beside it, and where that is; else of those within walls.mesh, which would throw it out."""
    outside = cells.outside(places)
    if outside.any():
        return outside, "outside the gas" if case.gas else "outside the domain"
    return start.within_walls(case, places), "within walls.mesh"


def _told(place) -> str:
    return f"({', '.join(f'{a:.4g}' for a in place)})"


def load(file: Path, overrides: tuple[str, ...] = ()):
    """The case of a file, with the domain of its own mesh."""
    sized = any(text.startswith(SIZE) for text in overrides)
    return cases.load(file, (*(() if sized else domain(file, cases.parsed(file))), *overrides))


def domain(file: Path, table: dict) -> tuple[str, ...]:
    """Overrides that make the domain the box around the mesh that a case file brings, where its table leaves
    domain.size_m out."""
    own = table.get("domain", {})
    around = poly_mesh.box(file.parent / "gas") if isinstance(own, dict) and "size_m" not in own else None
    if around is None:
        return ()
    d = len(own.get("gravity_m_s2", [0.0] * 3))
    corner, size = around[0][:d].tolist(), (around[1] - around[0])[:d].tolist()
    low = (f"domain.lower_m={corner}",) if any(corner) and "lower_m" not in own else ()
    return (f"{SIZE}={size}", *low)


def foreseen(case, template: Path, folder: Path):
    """The case with its walls as a run would make them of a mesh that is there, kept in `folder`, and its patches on
    the sides of the domain where they lie: for estimates."""
    own = case.parameters.get("walls")
    if not (template / poly_mesh.FOLDER).is_dir() or "grains" not in case.matters:
        return case
    mesh = poly_mesh.read(template)
    _refuse_unknown(case, mesh.patches)
    case = dataclasses.replace(case, boundaries=_on_sides(case, mesh))
    if own is None or own.source == "mesh" or own.mesh:
        return case
    facets.save(folder / FILE, _refused_none(patches.of_mesh(mesh, case.boundaries, case.dimensions)))
    return _with(case, folder / FILE)


def _on_sides(case, mesh) -> dict:
    """The boundaries of a case, those without a side on that in which their patch of `mesh` lies, if one: as all of it
    where no other patch lies there, else over the span that they have."""
    spans = mesh.spans(case.domain.corner, case.domain.upper)
    found = {}
    for name, own in case.boundaries.items():
        side, span = spans.get(name, (None, None)) if own.side is None else (None, None)
        found[name] = own if side is None else dataclasses.replace(own, side=side, span=span)
    return found
