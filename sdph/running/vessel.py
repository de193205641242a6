"""Walls of grains from the mesh of their gas: what its patches hold back, kept in the run folder as a surface mesh."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np

from coupling.choice import OWN_MESH
from coupling.openfoam import patches, poly_mesh
from sdph.case import forces
from sdph.case import read as cases
from sdph.effects.around.streams import streams_of
from sdph.engine import state as particles
from sdph.engine.walls import facets
from sdph.methods.grains import start
from sdph.running import inputs, output
from sdph.schema import CaseError

FILE, SIZE = "patches.vtk", "domain.size_m"


def walled(case, gas, folder: Path):
    """The case with walls.mesh made of the patches of `gas`, where it asks for them and OpenFOAM's mesh is its own; the
    sides of a generated mesh are known without."""
    if not hasattr(gas, "case_folder") or not any((inputs.gas_of(folder) / name).exists() for name in OWN_MESH):
        return case
    _refuse_unknown(case, patches.types(gas.case_folder))
    own = case.parameters.get("walls")
    if own is None or own.source == "mesh" or own.mesh:
        return case
    corners, slips, owners = patches.holding(gas.case_folder, case.boundaries, case.dimensions)
    if not len(corners):
        raise CaseError(
            'walls.source = "gas", and no patch of its mesh holds grains back: call some of type wall, name them in '
            '[boundaries], give walls.mesh, or set walls.source = "mesh" for the sides of the domain'
        )
    path = folder / inputs.place("walls.mesh", Path(FILE))
    path.parent.mkdir(parents=True, exist_ok=True)
    facets.save(path, corners, slips, owners)
    return _with(case, path)


def _with(case, path: Path):
    """The case with the walls of a mesh that was made of its patches."""
    made = dataclasses.replace(case.parameters["walls"], source="gas", mesh=str(path.absolute()))
    found = dataclasses.replace(case, parameters=case.parameters | {"walls": made})
    forces.check(found)
    return found


def _refuse_unknown(case, known) -> None:
    """CaseError where a boundary is no patch of the mesh that the case brings."""
    for name in case.boundaries:
        if name not in known:
            raise CaseError(f"boundaries.{name} is no patch of the mesh of the gas; it has {', '.join(known)}")


def refuse_outside(case, gas, state) -> None:
    """CaseError where grains of a region stand in no cell of a mesh that is no box: region, how many, and where."""
    if not hasattr(gas, "case_folder") or not case.particles:  # the embedded solver's box is the domain
        return
    grid, _ = output.gas_grid(gas)
    if grid.__class__.__name__ == "RectilinearGrid":  # fills the domain, and regions lie in that
        return
    places = particles.positions(state)
    outside = places[np.asarray(grid.find_containing_cell(places)) < 0]
    for name, region in case.particles.items():
        low, high = start.extents(case, region)
        own = outside[((outside >= _in_space(low)) & (outside <= _in_space(high))).all(axis=1)]
        if len(own):
            place = ", ".join(f"{a:.4g}" for a in own[0][: case.dimensions])
            raise CaseError(
                f"particles.{name} holds {len(own)} particles in no cell of the gas, the first at ({place}) m; move or "
                "shrink it, or leave what lies behind walls out by walls"
            )


def refuse_mouths_outside(case, gas) -> None:
    """CaseError where a nozzle of grains has a part of its mouth outside the gas: what comes in there leaves at once,
    or flies beside it. Streams are looked at half a spacing past the mouth."""
    for name, nozzle in case.nozzles.items():
        own = streams_of(case, nozzle)
        places = own.mouth + 0.5 * case.resolution.spacing * own.axis
        beside = _outside(case, gas, places)
        if beside.any():
            place = ", ".join(f"{a:.4g}" for a in places[beside][0])
            raise CaseError(
                f"nozzles.{name}: {np.count_nonzero(beside)} of its {len(places)} streams come in outside the gas, the "
                f"first at ({place}) m; move the mouth in, make it smaller, or square to the wall that it is in"
            )


def _outside(case, gas, places) -> np.ndarray:
    """Mask of places (N, d) [m] that are in no cell of the gas."""
    grid = output.gas_grid(gas)[0] if hasattr(gas, "case_folder") else None
    if grid is None or grid.__class__.__name__ == "RectilinearGrid":  # fills the domain
        free = np.array([not period for period in case.domain.period[: case.dimensions]])
        return (((places < case.domain.corner) | (places > case.domain.upper)) & free).any(axis=1)
    return np.asarray(grid.find_containing_cell(np.pad(places, ((0, 0), (0, 3 - places.shape[1]))))) < 0


def _in_space(corner) -> np.ndarray:
    """Corner (3,) of a box that a plane one is: 0 across."""
    return np.array([*corner, 0.0][:3])


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
    case = dataclasses.replace(case, boundaries=_on_sides(case, mesh))
    if own is None or own.source == "mesh" or own.mesh:
        return case
    facets.save(folder / FILE, *patches.of_mesh(mesh, case.boundaries, case.dimensions))
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
