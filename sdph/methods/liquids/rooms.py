"""Voids of a liquid told apart: what no particle fills on a grid of half a spacing, flooded from within."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import scipy

from sdph.laws.compiled import serial
from sdph.methods.liquids.pores import FINE

# spacings: how far a particle fills; a lattice of one spacing fills its emptiest place to 0.97; our choice
REACH = 1.5
# of a filled place: below it a cell is empty, a lone missing particle is not; our choice
EMPTY = 0.5
ROW = 0.75  # spacings from the outermost row of a lattice to the next empty cell, in the mean


class Rooms(NamedTuple):
    """Room (X, Y) that each cell of a grid is in, 0: filled, and that outside; how empty (X, Y) cells are, 0 to 1; the
    grid's corner (2,) [m] and its cell [m]."""

    label: np.ndarray
    outside: int
    empty: np.ndarray
    corner: np.ndarray
    cell: float

    def at(self, points) -> tuple[np.ndarray, np.ndarray]:
        """Cells in which points (N, 2) [m] are."""
        return tuple(((points - self.corner) / self.cell).astype(int).T)

    def places(self, cells) -> np.ndarray:
        """Places (N, 2) [m] of the middles of cells (2 arrays of indices)."""
        return self.corner + self.cell * (np.stack(cells, axis=1) + 0.5)


def find(points, volume, spacing: float) -> Rooms:
    """Rooms between points (N, 2) [m] of a volume (N,) [m2]."""
    cell, reach = FINE * spacing, REACH * spacing
    corner = points.min(axis=0) - 2.0 * reach
    shape = tuple(np.ceil((points.max(axis=0) - corner + 2.0 * reach) / cell).astype(int))
    filled = np.zeros(shape)
    fill(points[:, 0] - corner[0], points[:, 1] - corner[1], volume, cell, reach, filled)
    empty = np.maximum(1.0 - filled / EMPTY, 0.0)
    label, _ = scipy.ndimage.label(empty > 0.0)
    return Rooms(label, int(label[0, 0]), empty, corner, cell)


@serial
def fill(x, y, volume, cell, reach, filled):
    """Add to filled (X, Y) [-] what particles spread about them, 3 V/(pi a^2) (1 - r^2/a^2)^2 within a = reach."""
    wide, high = filled.shape
    scale = 3.0 / (math.pi * reach * reach)
    for n in range(len(x)):
        share = scale * volume[n]
        for i in range(int((x[n] - reach) / cell), min(int((x[n] + reach) / cell) + 1, wide)):
            dx = (i + 0.5) * cell - x[n]
            for j in range(int((y[n] - reach) / cell), min(int((y[n] + reach) / cell) + 1, high)):
                dy = (j + 0.5) * cell - y[n]
                left = 1.0 - (dx * dx + dy * dy) / (reach * reach)
                if left > 0.0:
                    filled[i, j] += share * left * left


def of(rooms: Rooms, place, radius: float) -> int:
    """Room of a bubble that was about a place (2,) [m] with a radius [m]; 0: there is none left."""
    inside = np.nonzero((rooms.label > 0) & (rooms.label != rooms.outside))
    if not len(inside[0]):
        return 0
    far = np.hypot(*(rooms.places(inside) - place).T)
    nearest = int(far.argmin())
    return int(rooms.label[inside[0][nearest], inside[1][nearest]]) if far[nearest] <= radius + rooms.cell else 0


def measure(rooms: Rooms, room: int) -> tuple[float, np.ndarray]:
    """Area [m2] of a room, and a place (2,) [m] in it: its middle, or the place nearest to that."""
    cells = np.nonzero(rooms.label == room)
    weight, places = rooms.empty[cells], rooms.places(cells)
    middle = weight @ places / weight.sum()
    if rooms.label[rooms.at(middle)] != room:
        middle = places[np.hypot(*(places - middle).T).argmin()]
    return float(weight.sum()) * rooms.cell**2, middle


def behind(rooms: Rooms, held, points) -> tuple[np.ndarray, np.ndarray]:
    """(N,) how far [m] points (N, 2) [m] lie behind the outermost row about the nearest of the rooms `held`, and (N,)
    which that is."""
    far, nearest = scipy.ndimage.distance_transform_edt(~np.isin(rooms.label, held), return_indices=True)
    cells = rooms.at(points)
    depth = rooms.cell * (far[cells] - ROW / FINE)
    return depth, rooms.label[tuple(axis[cells] for axis in nearest)]
