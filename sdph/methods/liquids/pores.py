"""Voids of a torn shell, as far as they reach: what no particle fills, flooded from within.

A way through the tear is as wide as the widest thing that gets through it. A void ends there, as a thing of that width
within it sees it; it is open where the way is wider than a gap of the lattice, and one with the air where nothing
narrows it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy

FINE = 0.5  # spacings: a cell; gel-droplet.md, section 2
COVER = 0.75  # spacings around a particle that it fills: neighbours close a lattice; our choice
HALVINGS = 8  # of the width of a way; our choice
MARGIN = 8  # cells of air around all in the grid; our choice


class Grid(NamedTuple):
    """Distance (X, Y) [m] of cells to the nearest particle, infinite at the edge; middle (2,) [m] of the first cell,
    side of a cell [m]."""

    room: np.ndarray
    middle: np.ndarray
    cell: float

    @property
    def filled(self) -> float:
        """Distance [m] up to which a particle fills."""
        return COVER / FINE * self.cell

    def at(self, x, y) -> tuple[np.ndarray, np.ndarray]:
        """Cells in which places (N,) [m] are, those of the rim for what is outside."""
        return tuple(
            np.clip(np.rint((value - first) / self.cell).astype(int), 0, most - 1)
            for value, first, most in zip((x, y), self.middle, self.room.shape)
        )


class Pore(NamedTuple):
    """A void: its roomiest place (2,) [m], area [m2], width [m] of its way out (0: it has none), whether nothing
    narrows that; distance (X, Y) [m] of the grid's cells to the void and to the air outside."""

    rim: np.ndarray
    area: float
    width: float
    lost: bool
    depth: np.ndarray
    beyond: np.ndarray


def find(points, spacing: float) -> Grid:
    """Grid of the room between points (N, 2) [m]."""
    cell = FINE * spacing
    middle = points.min(axis=0) - MARGIN * cell
    cells = np.rint((points - middle) / cell).astype(int)
    empty = np.ones(cells.max(axis=0) + MARGIN + 1, bool)
    empty[tuple(cells.T)] = False
    room = cell * scipy.ndimage.distance_transform_edt(empty)
    room[[0, -1]] = room[:, [0, -1]] = np.inf  # the air goes on
    return Grid(room, middle, cell)


def start(grid: Grid, place, radius: float) -> tuple | None:
    """Cell that a void about a place (2,) [m] has: the roomiest within a radius [m]; None where all there is filled."""
    far = [np.arange(n) * grid.cell + corner - at for n, corner, at in zip(grid.room.shape, grid.middle, place)]
    near = np.add.outer(far[0] ** 2, far[1] ** 2) <= radius**2
    deep = _roomiest(grid.room, near)
    return deep if near[deep] and grid.room[deep] > grid.filled else None


def pore(grid: Grid, deep) -> Pore:
    """The void that a cell is in."""
    room, level = grid.room, _throat(grid, deep)
    held = _part(room > level, deep)
    held[deep] = True
    rim = _roomiest(room, held)
    depth, beyond = (_away(grid, part) - level for part in (held, _part(room > level, (0, 0))))
    width = 2.0 * (level - grid.cell) if level > grid.filled else 0.0
    lost = room[rim] <= level + grid.cell
    place = grid.middle + grid.cell * np.array(rim)
    return Pore(place, float((depth <= 0.0).sum()) * grid.cell**2, width, lost, depth, beyond)


def _throat(grid: Grid, deep) -> float:
    """Largest distance [m] that a way from a cell to the corner of the grid keeps; that which particles fill, where
    none leads there."""
    low, high = grid.filled, float(grid.room[deep])
    if not _leads(grid.room, low, deep):
        return low
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if _leads(grid.room, middle, deep) else (low, middle)
    return high


def _leads(room, least: float, deep) -> bool:
    """Tell whether a way that keeps a distance leads from a cell to the corner of the grid."""
    return bool(_part(room > least, (0, 0))[deep])


def _part(free, cell) -> np.ndarray:
    """(X, Y) bool: what hangs together with a cell; nothing where that is not free."""
    parts, _ = scipy.ndimage.label(free)
    return (parts == parts[cell]) & free


def _roomiest(room, among) -> tuple:
    """Cell with the most room `among` (X, Y)."""
    return np.unravel_index(int(np.where(among, room, -1.0).argmax()), room.shape)


def _away(grid: Grid, part) -> np.ndarray:
    """Distance (X, Y) [m] of cells to a part (X, Y) of them; infinite where that is empty."""
    if not part.any():
        return np.full(part.shape, np.inf)
    return grid.cell * scipy.ndimage.distance_transform_edt(~part)
