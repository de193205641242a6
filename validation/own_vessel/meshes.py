"""Small meshes of vessels that are no boxes, as folders polyMesh: each is a unit of 1 m refined by a whole number.

The axis is z. Patches are `inlet` (below), `outlet` (above) and `wall`.
"""

from __future__ import annotations

import itertools
import math
from pathlib import Path
from typing import NamedTuple

import numpy as np

HEAD = "FoamFile {{ version 2.0; format ascii; class {cls}; object {name}; }}\n"
PATCHES = {"inlet": "patch", "outlet": "patch", "wall": "wall"}
CORE = 0.4  # half the side of the square in the middle of an O-grid, in radii; our choice
HALF = math.radians(20.0)  # rad, between the axis of the cone and its wall; our choice
APEX = 1.0  # m, from the apex of the cone to its floor, a cap of a sphere as its lid is; our choice
SHAKEN = 0.2  # of a cell, by which the points inside a mesh of tetrahedra are moved; our choice
# faces of a hexahedron, seen from outside; corner k is upper along axis a where bit a is set
HEXAHEDRON = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3))
TETRAHEDRON = ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2))


class Mesh(NamedTuple):
    """Points (P, 3) [m], faces as tuples of points seen from their owner, inner ones first; `owner` of all and
    `neighbour` of the inner ones; `patches` name -> range of faces."""

    points: np.ndarray
    faces: list[tuple[int, ...]]
    owner: list[int]
    neighbour: list[int]
    patches: dict[str, range]

    def centres(self, patch: str) -> np.ndarray:
        """(F, 3) [m] of the faces of a patch."""
        return np.array([area_and_centre(self.points[list(self.faces[k])])[1] for k in self.patches[patch]])

    def areas(self, patch: str) -> np.ndarray:
        """Area vectors (F, 3) [m2] of the faces of a patch, outwards."""
        return np.array([area_and_centre(self.points[list(self.faces[k])])[0] for k in self.patches[patch]])

    def corners(self, patch: str) -> list[np.ndarray]:
        return [self.points[list(self.faces[k])] for k in self.patches[patch]]


def area_and_centre(corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Area vector [m2] and centre [m] of a face, of triangles around its mean corner as OpenFOAM has it."""
    middle = corners.mean(axis=0)
    after = np.roll(corners, -1, axis=0)
    parts = 0.5 * np.cross(corners - middle, after - middle)
    area = parts.sum(axis=0)
    weight = parts @ (area / np.linalg.norm(area))
    return area, (weight[:, None] * (corners + after + middle) / 3.0).sum(axis=0) / weight.sum()


def assemble(points: np.ndarray, cells: list[list[tuple[int, ...]]], heights) -> Mesh:
    """A mesh of cells as lists of faces seen from outside; `heights` (P,) of the points, 0 at the inlet and 1 at the
    outlet."""
    sides: dict[frozenset[int], list[tuple[int, tuple[int, ...]]]] = {}
    for cell, faces in enumerate(cells):
        for face in faces:
            sides.setdefault(frozenset(face), []).append((cell, face))
    inner = sorted((pair[0][0], pair[1][0], pair[0][1]) for pair in sides.values() if len(pair) == 2)
    outer: dict[str, list] = {name: [] for name in PATCHES}
    for pair in sides.values():
        if len(pair) == 1:
            outer[_end(heights[list(pair[0][1])])].append(pair[0])
    faces, owner, patches = [row[2] for row in inner], [row[0] for row in inner], {}
    for name, rows in outer.items():
        patches[name] = range(len(faces), len(faces) + len(rows))
        owner += [row[0] for row in sorted(rows)]
        faces += [row[1] for row in sorted(rows)]
    return Mesh(points, faces, owner, [row[1] for row in inner], patches)


def write(mesh: Mesh, folder: Path) -> None:
    """constant/polyMesh, `folder`."""
    folder.mkdir(parents=True)
    lists = {
        "points": ("vectorField", [f"({row[0]!r} {row[1]!r} {row[2]!r})" for row in mesh.points.tolist()]),
        "faces": ("faceList", [f"{len(face)}({' '.join(map(str, face))})" for face in mesh.faces]),
        "owner": ("labelList", mesh.owner),
        "neighbour": ("labelList", mesh.neighbour),
        "boundary": (
            "polyBoundaryMesh",
            [
                f"{name} {{ type {PATCHES[name]}; nFaces {len(own)}; startFace {own.start}; }}"
                for name, own in mesh.patches.items()
            ],
        ),
    }
    for name, (cls, rows) in lists.items():
        text = "\n".join(map(str, rows))
        (folder / name).write_text(f"{HEAD.format(cls=cls, name=name)}{len(rows)}\n(\n{text}\n)\n", encoding="utf-8")


def _hexes(grid: np.ndarray) -> list[list[tuple[int, ...]]]:
    """Cells of hexahedra (C, 8)."""
    return [[tuple(int(cell[k]) for k in face) for face in HEXAHEDRON] for cell in grid]


def _lattice(counts) -> tuple[np.ndarray, np.ndarray]:
    """Points (P, 3) of a unit cube cut `counts` (3,) times, and its hexahedra (C, 8)."""
    ticks = [np.linspace(0.0, 1.0, n + 1) for n in counts]
    points = np.stack(np.meshgrid(*ticks, indexing="ij"), axis=-1).reshape(-1, 3)
    number = np.arange(len(points)).reshape([n + 1 for n in counts])
    corner = [number[tuple(slice(k >> a & 1, n + (k >> a & 1)) for a, n in enumerate(counts))] for k in range(8)]
    return points, np.stack([c.ravel() for c in corner], axis=1)


def _end(heights: np.ndarray) -> str:
    """Patch of an outer face by the heights of its corners."""
    return "inlet" if heights.max() < 1e-6 else "outlet" if heights.min() > 1.0 - 1e-6 else "wall"


def box(cells: int) -> Mesh:
    """A unit cube of cells^3."""
    return sheared(cells, 0.0)


def sheared(cells: int, degrees: float) -> Mesh:
    """A unit cube pushed over along x so that its upright edges lean by `degrees`."""
    points, grid = _lattice([cells] * 3)
    points[:, 0] += math.tan(math.radians(degrees)) * points[:, 2]
    return assemble(points, _hexes(grid), points[:, 2])


def _o_grid(cells: int, along: int) -> tuple[np.ndarray, np.ndarray]:
    """Points of a cylinder of radius 1 and height 1, and its hexahedra: a square core of cells^2 and four blocks
    around."""
    squares = [_lattice([cells, cells, along])]
    squares[0][0][:, :2] = CORE * (2.0 * squares[0][0][:, :2] - 1.0)
    for turn in range(4):
        points, grid = _lattice([max(2, cells // 2), cells, along])
        out, side = points[:, 0].copy(), 2.0 * points[:, 1] - 1.0
        angle = 0.25 * math.pi * side
        x = (1.0 - out) * CORE + out * np.cos(angle)
        y = (1.0 - out) * CORE * side + out * np.sin(angle)
        c, s = ((1, 0), (0, 1), (-1, 0), (0, -1))[turn]
        points[:, 0], points[:, 1] = c * x - s * y, s * x + c * y
        squares.append((points, grid))
    points = np.concatenate([p for p, _ in squares])
    first = np.cumsum([0, *(len(p) for p, _ in squares)])
    grid = np.concatenate([g + start for (_, g), start in zip(squares, first)])
    _, own, same = np.unique(np.round(points, 9), axis=0, return_index=True, return_inverse=True)
    return points[own], same.ravel()[grid]


def cylinder(cells: int) -> Mesh:
    """An O-grid of diameter 1 and height 1 on the origin."""
    points, grid = _o_grid(cells, 2 * cells)
    return assemble(points * [0.5, 0.5, 1.0], _hexes(grid), points[:, 2])


def cone(cells: int) -> Mesh:
    """An O-grid that widens from APEX to APEX + 1 m off its apex, which is the origin; its ends are caps of spheres,
    so that gas goes straight away from the apex."""
    points, grid = _o_grid(cells, 2 * cells)
    off, height = np.hypot(points[:, 0], points[:, 1]), points[:, 2].copy()
    angle = HALF * off
    aside = np.sin(angle) / np.where(off > 0.0, off, 1.0)
    rays = np.stack([aside * points[:, 0], aside * points[:, 1], np.cos(angle)], axis=1)
    return assemble((APEX + height)[:, None] * rays, _hexes(grid), height)


def hanging(cells: int) -> Mesh:
    """A unit cube of cells^3, cut in eight where it is in the middle half: coarse cells have four faces there, and
    their other faces the points that fine ones put on their edges, as snappyHexMesh leaves them."""
    size = 2 * cells + 1  # points on the lattice of half cells
    low, high = cells // 4, cells - cells // 4
    corner = np.array([[k >> a & 1 for a in range(3)] for k in range(8)])

    def fine(place) -> bool:
        return all(low <= a < high for a in place)

    fines, coarses = [], []
    for place in itertools.product(range(cells), repeat=3):
        start = 2 * np.array(place)
        if fine(place):
            fines += [[tuple(start + part + c) for c in corner] for part in corner]
        else:
            coarses.append([tuple(start + 2 * c) for c in corner])
    there = {point for cell in fines for point in cell}
    rows = [[tuple(cell[k] for k in face) for face in HEXAHEDRON] for cell in fines]
    rows += [[part for face in HEXAHEDRON for part in _split([cell[k] for k in face], there)] for cell in coarses]
    places = sorted({point for cell in rows for face in cell for point in face})
    number = {point: k for k, point in enumerate(places)}
    points = np.array(places, float) / (size - 1)
    return assemble(points, [[tuple(number[p] for p in f) for f in cell] for cell in rows], points[:, 2])


def _split(face, there) -> list[tuple]:
    """A face of four corners on the lattice of half cells: with the points `there` on its edges, or in four where there
    is one in its middle."""
    between = [tuple((np.add(a, b) // 2).tolist()) for a, b in zip(face, face[1:] + face[:1])]
    middle = tuple((np.add(face[0], face[2]) // 2).tolist())
    face = [tuple(int(a) for a in p) for p in face]
    if middle in there:
        return [(face[k], between[k], middle, between[k - 1]) for k in range(4)]
    return [tuple(p for a, b in zip(face, between) for p in ((a, b) if b in there else (a,)))]


def tetrahedra(cells: int) -> Mesh:
    """A unit cube of cells^3 cubes, each cut into six; points inside are moved at random."""
    points, _ = _lattice([cells] * 3)
    inner = ((points > 1e-9) & (points < 1.0 - 1e-9)).all(axis=1)
    points[inner] += np.random.default_rng(1).uniform(-SHAKEN, SHAKEN, (inner.sum(), 3)) / cells
    stride = np.array([(cells + 1) ** 2, cells + 1, 1])
    paths = [np.cumsum([0, *stride[list(order)]]) for order in itertools.permutations(range(3))]
    rows = []
    for place in itertools.product(range(cells), repeat=3):
        for path in paths:
            own = (stride @ place + path).tolist()
            a, b, c, d = points[own]
            own = own if np.dot(np.cross(b - a, c - a), d - a) > 0.0 else [own[0], own[2], own[1], own[3]]
            rows.append([tuple(own[k] for k in face) for face in TETRAHEDRON])
    return assemble(points, rows, points[:, 2])


# name -> number of cells across -> mesh
MESHES = {
    "box": box,
    "cylinder": cylinder,
    "cone": cone,
    "sheared by 30 degrees": lambda cells: sheared(cells, 30.0),
    "sheared by 60 degrees": lambda cells: sheared(cells, 60.0),
    "hanging cells": hanging,
    "tetrahedra": tetrahedra,
}
