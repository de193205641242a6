"""Patches of an OpenFOAM mesh as facets with their normals into the vessel: what holds grains back, and outlets."""

from __future__ import annotations

import itertools
import re
from pathlib import Path

import numpy as np

from coupling.gas import GasError
from sdph.engine.walls.facets import Facets
from sdph.schema import CaseError

FLAT = "empty"  # type of the two sides of a plane mesh
WALL, OUTLET = "wall", "pressure_outlet"
KINDS = (WALL, "slip_wall", "velocity_inlet", OUTLET)  # of boundaries; all but the last hold grains, as sides of a box
PATCH = re.compile(r"([\w.+:-]+)\s*\{[^{}]*?\btype\s+(\w+)\s*;")


def types(folder: Path) -> dict[str, str]:
    """Patches of constant/polyMesh/boundary and their types."""
    text = (Path(folder) / "constant/polyMesh/boundary").read_text(encoding="utf-8", errors="replace")
    return {name: kind for name, kind in PATCH.findall(text) if name != "FoamFile"}


def mesh_reader(folder: Path):
    """Reader of the mesh of a case with case.foam. Fields are left out: VTK warns on the terminal of each
    that has no entry for the sides of a plane mesh, which OpenFOAM does not ask for."""
    import pyvista

    reader = pyvista.POpenFOAMReader(str(Path(folder) / "case.foam"))
    reader.disable_all_cell_arrays()
    reader.disable_all_point_arrays()
    return reader


def cells(folder: Path, dimensions: int, ranks: int = 1):
    """Cells (pyvista) of the mesh of a case with case.foam, of a plane mesh a cut through its middle, at z = 0; with
    several `ranks` those of its parts, as they wrote them."""
    reader = mesh_reader(folder)
    reader.case_type = "decomposed" if ranks > 1 else "reconstructed"
    grid = reader.read()["internalMesh"]
    if dimensions == 2:
        grid = grid.slice(normal="z").translate((0.0, 0.0, -grid.center[2]))
    grid.clear_data()
    return grid


def facets(folder: Path, boundaries: dict, dimensions: int) -> Facets:
    """Facets of the patches that hold grains back, and of outlets. A patch that `boundaries` (name -> its section of
    the case) names holds them unless it is a pressure outlet, others where OpenFOAM calls them a wall. `folder` is a
    case with case.foam and a mesh."""
    reader = mesh_reader(folder)
    reader.enable_all_patch_arrays()
    patches = reader.read()["boundary"]
    found = [_facets(np.zeros((0, dimensions, dimensions)), WALL, -1)]
    for name, kind in types(folder).items():
        kind = _kind(boundaries[name]) if name in boundaries and kind != FLAT else kind
        if kind not in KINDS or name not in patches.keys() or not patches[name].n_cells:  # noqa: SIM118  (MultiBlock)
            continue
        corners = _lines(name, patches[name]) if dimensions == 2 else _triangles(patches[name])
        found.append(_facets(corners, kind, _number(name, boundaries)))
    return Facets(*map(np.concatenate, zip(*found)))


def _facets(corners, kind: str, owner: int) -> Facets:
    """Facets of a patch of a kind, that of the boundary with a number."""
    like = np.full(len(corners), kind)
    return Facets(corners, like == "slip_wall", like == OUTLET, np.full(len(corners), owner))


def _kind(boundary) -> str:
    """Kind of a boundary for grains: one that lets them out is an outlet."""
    return OUTLET if boundary.lets_out else boundary.kind


def _number(name: str, boundaries: dict) -> int:
    """Number of the boundary that a patch is, -1 where it is none."""
    return list(boundaries).index(name) if name in boundaries else -1


def of_mesh(mesh, boundaries: dict, dimensions: int) -> Facets:
    """The same of a `PolyMesh`, before there is a case to be read: faces as fans about their first corner, of a plane
    mesh the edges that lie at its lower side."""
    every = [_facets(np.zeros((0, dimensions, dimensions)), WALL, -1)]
    low = mesh.points[:, 2].min() + 0.5 * np.ptp(mesh.points[:, 2])
    for name, patch in mesh.patches.items():
        kind = _kind(boundaries[name]) if name in boundaries and patch.kind != FLAT else patch.kind
        for k in range(patch.faces.start, patch.faces.stop) if kind in KINDS else ():
            face = mesh.points[mesh.corners[mesh.first[k] : mesh.first[k + 1]]]
            if dimensions == 3:
                found = [(face[0], face[i + 1], face[i]) for i in range(1, len(face) - 1)]
            else:
                pairs = itertools.pairwise([*face, face[0]])
                found = [(a[:2], b[:2]) for a, b in pairs if a[2] < low and b[2] < low]
                if len(found) != 1:
                    raise CaseError(
                        f"patch {name} of the gas's mesh is {patch.kind} and lies in the plane of a case in two "
                        f"dimensions; give front and back of a mesh of one layer the type {FLAT}, or set dimensions = 3"
                    )
            every.append(_facets(np.array(found), kind, _number(name, boundaries)))
    return Facets(*map(np.concatenate, zip(*every)))


def _triangles(patch) -> np.ndarray:
    """(F, 3, 3) of the faces of a patch, turned round: OpenFOAM's normals are outwards."""
    surface = patch.extract_surface(algorithm=None).triangulate()
    return np.asarray(surface.points, float)[surface.faces.reshape(-1, 4)[:, :0:-1]]


def _lines(name: str, patch) -> np.ndarray:
    """(F, 2, 2): the lower edges of the faces of a plane mesh, with the vessel to their left."""
    found = []
    for face in patch.cell:
        points, low = np.asarray(face.points, float), patch.center[2]
        edges = [(a, b) for a, b in itertools.pairwise([*points, points[0]]) if a[2] < low and b[2] < low]
        if len(edges) != 1:
            raise GasError(f"patch {name} of a plane mesh has a face that does not go across its one layer of cells")
        found.append([edges[0][0][:2], edges[0][1][:2]])
    return np.array(found).reshape(-1, 2, 2)
