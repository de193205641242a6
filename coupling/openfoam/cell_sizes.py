"""Sizes of the cells of an OpenFOAM mesh: their edges, places spread in them, how much neighbours differ in width."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from coupling.gas import Mesh
from coupling.openfoam import poly_mesh
from coupling.openfoam.poly_mesh import PolyMesh
from sdph.laws.constants import TINY

COLLAPSED = 1e-9  # of the longest edge of a mesh: one that has shrunk to a point, as of a wedge; our choice


class Edges(NamedTuple):
    """Middles (C, d) [m] of the cells of a mesh, shortest and longest edge of each (C,) [m]."""

    middles: np.ndarray
    shortest: np.ndarray
    longest: np.ndarray


def edges(mesh: PolyMesh, dimensions: int) -> Edges:
    """The edges of each cell; of a plane mesh those in its plane."""
    face, after = poly_mesh.around(mesh.first)
    length = np.linalg.norm((mesh.points[mesh.corners[after]] - mesh.points[mesh.corners])[:, :dimensions], axis=1)
    none = length <= COLLAPSED * length.max()
    cells = int(mesh.owner.max()) + 1
    shortest, longest = np.full(cells, np.inf), np.zeros(cells)
    inner = face < len(mesh.neighbour)
    for own, of in ((np.full(len(face), True), mesh.owner), (inner, mesh.neighbour)):
        np.maximum.at(longest, of[face[own]], length[own])
        np.minimum.at(shortest, of[face[own]], np.where(none, np.inf, length)[own])
    return Edges(middles(mesh)[:, :dimensions], shortest, longest)


def middles(mesh: PolyMesh) -> np.ndarray:
    """(C, 3) [m] mean of the middles of each cell's faces."""
    cells, inner = int(mesh.owner.max()) + 1, len(mesh.neighbour)
    of, place = np.concatenate((mesh.owner, mesh.neighbour)), np.concatenate((mesh.centres, mesh.centres[:inner]))
    sums = [np.bincount(of, axis, cells) for axis in place.T]
    return np.stack(sums, axis=1) / np.bincount(of, minlength=cells)[:, None]


def spread(mesh: Mesh, case, folder: Path) -> Mesh:
    """The mesh as a solver in `folder` tells it; with places half way from the middle of each cell to its corners where
    it does not fill the box of the case. Of a cell that is a box these are an even lattice."""
    if mesh.fills(case.domain.size):
        return mesh
    own, ranks = poly_mesh.read(folder), case.coupling.gas_ranks
    cell, corner = _corners(own)
    count = np.bincount(cell)
    middle = np.stack([np.bincount(cell, axis) for axis in own.points[corner].T], axis=1) / count[:, None]
    told = np.argsort(poly_mesh.numbers_by_rank(folder, ranks)) if ranks > 1 else np.arange(len(count))
    places = mesh.centres[told[cell]] + 0.5 * (own.points[corner] - middle[cell])
    places[:, mesh.dimensions :] = 0.0
    return replace(mesh, spread=(places, told[cell]))


def _corners(mesh: PolyMesh) -> tuple[np.ndarray, np.ndarray]:
    """Cell and point of each corner of each cell, (M,) both."""
    face, _ = poly_mesh.around(mesh.first)
    inner = face < len(mesh.neighbour)
    cell = np.concatenate((mesh.owner[face], mesh.neighbour[face[inner]]))
    pairs = np.unique(cell * len(mesh.points) + np.concatenate((mesh.corners, mesh.corners[inner])))
    return pairs // len(mesh.points), pairs % len(mesh.points)


def largest_jump(mesh: PolyMesh) -> tuple[float, np.ndarray]:
    """Width of a cell over that of its neighbour, across the face that they share: the largest of the mesh, and where
    (3,) [m] that face is; 1 where there is one cell."""
    inner, centre = len(mesh.neighbour), middles(mesh)
    if not inner:
        return 1.0, mesh.centres[0]
    normal = mesh.areas[:inner] / np.maximum(np.linalg.norm(mesh.areas[:inner], axis=1), TINY)[:, None]
    widths = [
        np.maximum(np.abs(((centre[of[:inner]] - mesh.centres[:inner]) * normal).sum(axis=1)), TINY)
        for of in (mesh.owner, mesh.neighbour)
    ]
    ratio = np.maximum(widths[0] / widths[1], widths[1] / widths[0])
    return float(ratio.max()), mesh.centres[int(ratio.argmax())]
