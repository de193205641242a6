"""Walls made of facets, lines in two dimensions and triangles in three: read, drawn, and strewn with points that stand
one spacing apart whatever the facets are."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy

from sdph.engine import surface
from sdph.engine.walls.surface_points import EVEN, SAMPLES, evened
from sdph.laws.constants import ROUND_OFF
from sdph.schema import CaseError

OPPOSITE = -0.5  # cosine of facets that look away from each other, by 120 degrees or more; our choice
ORDER = np.array([1.0, 2.0**0.5, 3.0**0.5])  # one of two facets comes first by its normal along this: our choice


class Facets(NamedTuple):
    """Facets of walls, and of openings among them: corners (F, d, d) [m], normals into the vessel, to the left of a
    line or by the right hand; whether grains slip on each or leave through it (F,); and the number (F,) of the boundary
    of the case whose patch it is of, -1 where of none."""

    corners: np.ndarray
    slip: np.ndarray
    open: np.ndarray
    owner: np.ndarray

    def those(self, chosen) -> Facets:
        """The facets of a mask (F,)."""
        return Facets(*(own[chosen] for own in self))


def read(path: str, dimensions: int, unit: surface.Unit = surface.METRES) -> np.ndarray:
    """Corners (F, d, d) [m] of the facets of a surface mesh that hold grains, in their `unit`."""
    return walls(path, dimensions, unit).corners


def walls(path: str, dimensions: int, unit: surface.Unit = surface.METRES) -> Facets:
    """The facets of a surface mesh that hold grains; in its `unit`."""
    found = every(path, dimensions, unit)
    return found.those(~found.open)


def every(path: str, dimensions: int, unit: surface.Unit = surface.METRES) -> Facets:
    """All facets of a surface mesh, those without a size left out; cells may have values `slip`, `open` and `boundary`
    that are those of `Facets`."""
    places, cells = _cells(path, dimensions)
    corners = unit.placed(places)[cells][:, :, :dimensions]
    slip, open_, owner = (
        _given(path, dimensions, name, otherwise) for name, otherwise in (("slip", 0), ("open", 0), ("boundary", -1))
    )
    return Facets(corners, slip != 0, open_ != 0, owner).those(sizes(corners) > 0.0)


def _given(path: str, dimensions: int, name: str, otherwise: int) -> np.ndarray:
    """(F,) values of a name that the cells of a mesh have."""
    mesh, kind = _mesh(path, dimensions)
    return np.asarray(mesh.cell_data_dict.get(name, {}).get(kind, np.full(len(mesh.cells_dict[kind]), otherwise)))


def save(path, found: Facets) -> None:
    """Facets as a surface mesh in VTK's format."""
    import meshio

    count, d = found.corners.shape[:2]
    points = np.pad(found.corners.reshape(-1, d), ((0, 0), (0, 3 - d)))
    cells = np.arange(count * d).reshape(count, d)
    kind = "line" if d == 2 else "triangle"
    data = {"slip": found.slip, "open": found.open, "boundary": found.owner}
    meshio.write_points_cells(
        path, points, {kind: cells}, cell_data={name: [own.astype(np.int32)] for name, own in data.items()}
    )


def drawn(path: str, dimensions: int, unit: surface.Unit = surface.METRES):
    """A surface mesh of walls as pyvista has it, of what holds grains; in its `unit`."""
    import pyvista

    places, facets = _cells(path, dimensions)
    facets = facets[_given(path, dimensions, "open", 0) == 0]
    places, cells = unit.placed(places), np.insert(facets, 0, facets.shape[1], axis=1).ravel()
    return pyvista.PolyData(places, lines=cells) if dimensions == 2 else pyvista.PolyData(places, faces=cells)


class Surface:
    """Facets (F, d, d) [m] as one surface, for distances to it."""

    def __init__(self, corners: np.ndarray):
        half = np.ptp(corners.reshape(-1, corners.shape[2]), axis=0).sum()
        self.flat, double = corners.shape[2] == 2, _doubled(corners, half)
        self.mesh = _drawn(corners[~double], half)
        self.sheets = _drawn(corners[double], half)  # of no thickness: free on both sides

    @property
    def closed(self) -> bool:
        """True where no side of a facet is free; of lines, where each end meets another."""
        return not len(self.free())

    def rims(self) -> list[tuple[np.ndarray, float]]:
        """Middle (d,) [m] and length [m] of each row of free sides that hang together, the shortest first; of lines
        each free end, its length 0, as they stand in the file."""
        free = self.free()
        if not len(free):
            return []
        if self.flat:
            return [(end, 0.0) for end in free.mean(axis=1)[:, :2]]
        own = np.unique(free.reshape(-1, 3), axis=0, return_inverse=True)[1].reshape(-1, 2)
        links = scipy.sparse.coo_matrix((np.ones(len(own)), own.T), shape=(own.max() + 1,) * 2)
        row = scipy.sparse.csgraph.connected_components(links, directed=False)[1][own[:, 0]]
        length = np.linalg.norm(free[:, 1] - free[:, 0], axis=1)
        found = [(free[row == n].mean(axis=(0, 1)), float(length[row == n].sum())) for n in range(row.max() + 1)]
        return sorted(found, key=lambda rim: rim[1])

    def free(self) -> np.ndarray:
        """Sides (E, 2, 3) [m] that one triangle alone has; of strips, those at the ends of lines: their rims are free
        too."""
        if not self.mesh.n_cells:
            return np.zeros((0, 2, 3))
        ends = self.mesh.extract_feature_edges(
            boundary_edges=True, feature_edges=False, manifold_edges=False, non_manifold_edges=False
        )
        free = np.asarray(ends.points, float)[ends.lines.reshape(-1, 3)[:, 1:]]
        return free[np.ptp(free[:, :, 2], axis=1) > 0.0] if self.flat else free

    def distance(self, places: np.ndarray) -> np.ndarray:
        """(N,) [m] of places (N, d) from the surface, above 0 on the side of the normals."""
        found = _distance(self.mesh, places) if self.mesh.n_cells else np.full(len(places), np.inf)
        if not self.sheets.n_cells:
            return found
        return np.where(found > 0.0, np.minimum(found, np.abs(_distance(self.sheets, places))), found)


def parts(corners: np.ndarray) -> np.ndarray:
    """Number (F,), from 0, of the part that each of the facets (F, d, d) is of: those of a part hang together by their
    corners."""
    return hanging_together(numbered(corners))


def hanging_together(point: np.ndarray) -> np.ndarray:
    """The same of facets whose corners have the numbers point (F, d)."""
    first = np.repeat(point[:, 0], point.shape[1])
    links = scipy.sparse.coo_matrix((np.ones(point.size), (point.ravel(), first)), shape=(point.max() + 1,) * 2)
    return scipy.sparse.csgraph.connected_components(links, directed=False)[1][point[:, 0]]


def of_closed_parts(corners: np.ndarray) -> np.ndarray:
    """Mask (F,) of the facets (F, d, d) of parts without a free side."""
    part = parts(corners)
    return np.array([Surface(corners[part == n]).closed for n in range(part.max() + 1)])[part]


def _distance(mesh, places: np.ndarray) -> np.ndarray:
    """The same from triangles."""
    import pyvista

    cloud = pyvista.PolyData(np.pad(places, ((0, 0), (0, 3 - places.shape[1]))))
    return np.asarray(cloud.compute_implicit_distance(mesh)["implicit_distance"])


def _drawn(corners: np.ndarray, half: float):
    """Triangles (pyvista) of facets; lines become strips as wide as the surface is long, twice `half` [m]: nothing is
    nearer to their edges."""
    import pyvista

    if not len(corners):
        return pyvista.PolyData()
    if corners.shape[2] == 2:
        corners = np.pad(corners, ((0, 0), (0, 0), (0, 1)))
        rims = [corners + np.array([0.0, 0.0, z]) for z in (half, -half)]
        corners = np.concatenate([rims[0], rims[1][:, ::-1]], axis=1)
    count, size = corners.shape[:2]
    faces = np.insert(np.arange(count * size).reshape(count, size), 0, size, axis=1)
    return pyvista.PolyData(corners.reshape(-1, 3), faces.ravel()).triangulate().clean()


def _doubled(corners: np.ndarray, half: float) -> np.ndarray:
    """Mask (F,) of facets that one which faces the other way lies on: the two faces of a sheet of no thickness."""
    found, ahead = np.zeros(len(corners), bool), _turned(corners) @ ORDER[: corners.shape[2]] > 0.0
    for own, other in ((ahead, ~ahead), (~ahead, ahead)):
        if own.any() and other.any():
            found[own] = np.abs(_distance(_drawn(corners[other], half), corners[own].mean(axis=1))) < ROUND_OFF * half
    return found


def _cells(path: str, dimensions: int) -> tuple[np.ndarray, np.ndarray]:
    """Points (P, 3), in the unit of the file, of a surface mesh and its facets: lines in 2-D, triangles in 3-D."""
    mesh, kind = _mesh(path, dimensions)
    places = np.zeros((len(mesh.points), 3))
    places[:, : mesh.points.shape[1]] = mesh.points
    return places, mesh.cells_dict[kind]


def _mesh(path: str, dimensions: int):
    """A surface mesh as meshio has it, and the kind of its facets."""
    mesh = surface.read(path, "walls.mesh")
    kind = "line" if dimensions == 2 else "triangle"
    if kind not in mesh.cells_dict:
        raise CaseError(
            f"walls.mesh = {path!r} holds no cells of type {kind}; a wall in {dimensions}-D is made of them"
        )
    return mesh, kind


def sizes(corners: np.ndarray) -> np.ndarray:
    """Lengths or areas (F,) [m^(d-1)] of facets (F, d, d)."""
    return np.linalg.norm(_turned(corners), axis=1) * (1.0 if corners.shape[2] == 2 else 0.5)


def enclosed(corners: np.ndarray) -> float:
    """Area or volume [m^d] that facets (F, d, d) with normals inwards enclose, below 0 where they point outwards; of an
    open surface, as if its rims were drawn together at the middle of its corners."""
    d = corners.shape[2]
    away = corners.mean(axis=1) - corners.reshape(-1, d).mean(axis=0)
    return -float(np.einsum("ij,ij->", away, _turned(corners))) / (d if d == 2 else 2 * d)


def normals(corners: np.ndarray) -> np.ndarray:
    """Unit normals (F, d) of facets (F, d, d) that have a size."""
    turned = _turned(corners)
    return turned / np.linalg.norm(turned, axis=1)[:, None]


def _turned(corners: np.ndarray) -> np.ndarray:
    """Normals (F, d) of facets, as long as a line is or twice a triangle is large."""
    edges = corners[:, 1:] - corners[:, :1]
    if corners.shape[2] == 2:
        return np.stack([-edges[:, 0, 1], edges[:, 0, 0]], axis=1)
    return np.cross(edges[:, 0], edges[:, 1])


def spread(corners: np.ndarray, spacing: float) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Points (P, d) [m] on facets (F, d, d), the normals (P, d) there, which facet each is on (P,), and the part (P,)
    of the area that is its, over the mean: one for each spacing^(d-1) of all facets together, whatever size each of
    them has; evenly along each chain of plane ones."""
    size = sizes(corners)
    if corners.shape[2] == 2:
        own, share = _along(chains(corners), size / spacing)
        places = corners[own, 0] + share[:, None] * (corners[own, 1] - corners[own, 0])
        return places, normals(corners)[own], own, np.ones(len(own))
    ends = np.cumsum(size)
    places, facing, own = _strewn(corners, ends, size, SAMPLES * max(1, round(ends[-1] / spacing**2)))
    points, normal, nearest, share = evened(places, facing, spacing)
    return points, normal, own[nearest], share


def _along(found: list[np.ndarray], size: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Number of the facet of chains that each point is on, and the share of its length before it; `size` (F,) of facets
    in spacings."""
    parts, passed, there = [], 0.0, 0
    for number, chain in enumerate(found):
        ends = np.cumsum(size[chain])
        passed += ends[-1]
        last = number == len(found) - 1
        count = max(round(passed), 1 if last and not there else 0) - there  # short chains together have their points
        at = (np.arange(count) + 0.5) * (ends[-1] / max(count, 1))
        own = np.minimum(np.searchsorted(ends, at, side="right"), len(chain) - 1)
        parts.append((chain[own], 1.0 - (ends[own] - at) / size[chain[own]]))
        there += count
    return tuple(np.concatenate(columns) for columns in zip(*parts))


def chains(corners: np.ndarray) -> list[np.ndarray]:
    """Facets (F, 2, 2) of a plane wall in chains, by number: each begins where the one before ends. In any other order
    points of neighbours may be two facets apart, and grains slip through."""
    point = numbered(corners)
    follower = dict(zip(point[:, 0].tolist(), range(len(point))))  # of a point: the facet that begins there
    first = np.flatnonzero(~np.isin(point[:, 0], point[:, 1]))
    found, known = [], set()
    for begin in (*first.tolist(), *range(len(point))):
        chain, facet = [], begin
        while facet is not None and facet not in known:
            known.add(facet)
            chain.append(facet)
            facet = follower.get(int(point[facet, 1]))
        if chain:
            found.append(np.array(chain))
    return found


def numbered(corners: np.ndarray) -> np.ndarray:
    """Numbers (F, d) of the points that corners of facets (F, d, d) are: those so near that they are one have one."""
    ends = corners.reshape(-1, corners.shape[2])
    near = ROUND_OFF * np.ptp(ends, axis=0).max()
    return np.unique(np.round(ends / near), axis=0, return_inverse=True)[1].reshape(corners.shape[:2])


def _strewn(corners, ends, size, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Places (N, 3) that lie on triangles in proportion to their areas, `ends` their sums, the normals there, and on
    which triangle each is."""
    own = np.minimum(np.searchsorted(ends, (np.arange(count) + 0.5) * (ends[-1] / count), side="right"), len(size) - 1)
    a, b = np.modf((np.arange(count)[:, None] + 1) * EVEN)[0].T
    # alike in area (Turk 1990, Graphics Gems, 24); folding the square would lay half of the sequence on the other half
    a = np.sqrt(a)
    edges = corners[own, 1:] - corners[own, :1]
    places = corners[own, 0] + (a * (1.0 - b))[:, None] * edges[:, 0] + (a * b)[:, None] * edges[:, 1]
    return places, normals(corners)[own], own
