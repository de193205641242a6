"""Neighbours by a cell-linked list: counting sort into cells, particles reordered, fixed-stride rows with a skin.

`Neighbours.update` reorders the particles so that those of one cell lie together, and lists for each particle all
others within `reach * (1 + skin)`; the rows hold until some particle has moved half the skin.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit, prange

from sdph.engine import state as particles
from sdph.engine.geometry import OPEN, OPEN_PLANE, box_of, nearest_image
from sdph.engine.kept import Many

SKIN = 0.1  # of the reach; our choice: 0.2 h measured best (about 5-8 steps per list), and the reach is 2 h
CELLS_A_PARTICLE = 16  # memory of the cells stays below that of the rows; our choice
LANES = 4  # doubles of a vector register of 256 bit, as wide as pays on today's x86
MOST_CELLS = 2**20  # along an axis, so that their product is an int64


class Grid(NamedTuple):
    """Cells of side `size` [m] from `origin` (3,) [m]; `shape` (3,) cells; `period` (3,) [m], 0 where open."""

    origin: np.ndarray
    size: np.ndarray
    shape: np.ndarray
    period: np.ndarray


class Rows(NamedTuple):
    """Neighbours of particle i: `index[i, :count[i]]`, filled up to a multiple of LANES with i itself."""

    index: np.ndarray
    count: np.ndarray


class Neighbours:
    """Neighbour rows of a state that moves."""

    KEPT, FORMS = ("built",), {"built": Many(np.zeros(0))}  # see sdph.engine.kept

    def __init__(self, reach: float, period=(OPEN, OPEN, OPEN), skin: float = SKIN):
        if any(0.0 < length < 2.0 * reach for length in period):
            raise ValueError(
                f"periods {tuple(period)} m: a periodic box must be at least two reaches ({2.0 * reach:g} m) wide, or "
                "images are missed"
            )
        self.reach, self.skin = reach, skin
        self.period = np.array([*period, OPEN][:3])
        self.box = OPEN_PLANE  # of the particles that rows were last made for
        self.stride = 32
        self.built = ()  # positions at the last build
        self.room = np.empty((0, 0), np.uint32)

    def revive(self) -> None:
        """The rows of a checkpoint that was put back: those of the last build."""
        if self.built:
            self.rows = self._rows(self._grid(self.built), self.built)

    def update(self, state):
        """The state (reordered where the list had to be rebuilt) and its rows."""
        here = particles.axes(state)
        if self._holds(here):
            return state, self.rows
        for axis, period in zip(here, self.period):
            if period:
                np.mod(axis, period, out=axis)
        grid = self._grid(here)
        state = self._sorted(grid, state)
        self.rows = self._listed(grid, state)
        self.built = tuple(axis.copy() for axis in particles.axes(state))
        return state, self.rows

    def _sorted(self, grid: Grid, state):
        """The state in the order of its cells."""
        return particles.take(state, order(cells(grid, *three(particles.axes(state))), int(grid.shape.prod())))

    def _listed(self, grid: Grid, state) -> Rows:
        """Rows of a state in that order."""
        return self._rows(grid, particles.axes(state))

    def _holds(self, here) -> bool:
        if len(here) != len(self.built) or len(here[0]) != len(self.built[0]):
            return False
        if len(here[0]) == 0:
            return True
        moved = sum((a - b) ** 2 for a, b in zip(here, self.built))
        return bool(moved.max() < (0.5 * self.skin * self.reach) ** 2)

    def _grid(self, here) -> Grid:
        """Cells no smaller than the cutoff; larger ones where a few stray particles make the box mostly empty."""
        cutoff = self.reach * (1.0 + self.skin)
        while (grid := self._cells_of(here, cutoff)).shape.prod() > CELLS_A_PARTICLE * max(64, len(here[0])):
            cutoff *= 2.0
        return grid

    def _cells_of(self, here, cutoff: float) -> Grid:
        size, origin, shape = np.ones(3), np.zeros(3), np.ones(3, np.int64)
        for a, axis in enumerate(here):
            low, high = (0.0, self.period[a]) if self.period[a] else _extent(axis)
            cells = max(1, int(min((high - low) / cutoff, MOST_CELLS)))
            origin[a], shape[a] = low, cells
            size[a] = (high - low) / cells if self.period[a] else max(cutoff, (high - low) / cells * (1.0 + 1e-12))
        return Grid(origin, size, shape, self.period)

    def _rows(self, grid: Grid, here, at=None) -> Rows:
        """Rows of the points `here`, sorted by cell, for the points `at` (None: for each other)."""
        own, other = three(here), three(at or here)
        self.box = box_of(self.period, len(here))
        start = starts(cells(grid, *own), int(grid.shape.prod()))
        while True:
            index = self._room(len(other[0]))
            count = np.empty(len(other[0]), np.int64)
            _fill(grid, start, *own, *other, at is None, self.box, (self.reach * (1.0 + self.skin)) ** 2, index, count)
            most = int(count.max(initial=0))
            if most < self.stride:
                return Rows(index, count)
            # a few spare, so that a slow compaction does not rebuild each time
            self.stride = (most + 8) // LANES * LANES

    def _room(self, count: int) -> np.ndarray:
        """Rows for `count` points; those of the last time where they fit, which nobody needs any more."""
        if self.room.shape != (count, self.stride):
            self.room = np.empty((0, 0), np.uint32)  # given back before more is taken
            self.room = np.empty((count, self.stride), np.uint32)
        return self.room

    def sort(self, here) -> np.ndarray:
        """Order in which fixed points have to stand for `seen_from`."""
        grid = self._grid(here)
        return order(cells(grid, *three(here)), int(grid.shape.prod()))

    def seen_from(self, here, at) -> Rows:
        """Rows of fixed points `here`, in the order of `sort`, for the points `at`."""
        return self._rows(self._grid(here), here, at)


def three(here):
    """Positions in three arrays; the last without length in two dimensions."""
    return here if len(here) == 3 else (*here, np.zeros(0))


def _extent(axis):
    return (float(axis.min()), float(axis.max())) if len(axis) else (0.0, 0.0)


@njit(cache=True, error_model="numpy")
def _place(grid, a, value):
    cell = int((value - grid.origin[a]) / grid.size[a])
    return min(max(cell, 0), grid.shape[a] - 1)


@njit(cache=True, parallel=True, error_model="numpy")
def cells(grid, x, y, z):
    """Cell number of each particle, x fastest."""
    number = np.empty(len(x), np.int64)
    for i in prange(len(x)):
        layer = _place(grid, 2, z[i]) if len(z) else 0
        number[i] = (layer * grid.shape[1] + _place(grid, 1, y[i])) * grid.shape[0] + _place(grid, 0, x[i])
    return number


@njit(cache=True, error_model="numpy")
def starts(number, total):
    """Where the particles of each cell begin, (total + 1,), from their cell numbers."""
    start = np.zeros(total + 1, np.int64)
    for cell in number:
        start[cell + 1] += 1
    return np.cumsum(start)


@njit(cache=True, error_model="numpy")
def order(number, total):
    """Row of each particle after a stable counting sort by cell."""
    start = starts(number, total)
    rows = np.empty(len(number), np.int64)
    for i, cell in enumerate(number):
        rows[start[cell]] = i
        start[cell] += 1
    return rows


@njit(cache=True, error_model="numpy")
def fill_up(index, i, count):
    """Puts i itself behind the `count` neighbours in its row, as far as `length` goes."""
    for k in range(count, min((count + LANES - 1) // LANES * LANES, index.shape[1])):
        index[i, k] = i


@njit(cache=True, error_model="numpy")
def length(rows, i):
    """Entries to loop over in row i, a multiple of LANES: a loop of pairs then runs in whole vectors. The last ones may
    be i itself, whose separation from i, and so every pair term, is 0."""
    return (rows.count[i] + LANES - 1) // LANES * LANES


@njit(cache=True, error_model="numpy")
def span(grid, a, value):
    """First and one past the last cell to look at along an axis; beyond the ends on a periodic one."""
    cell = _place(grid, a, value)
    if grid.period[a] > 0.0:
        return (cell - 1, cell + 2) if grid.shape[a] >= 3 else (0, grid.shape[a])
    return max(cell - 1, 0), min(cell + 2, grid.shape[a])


@njit(cache=True, error_model="numpy")
def _run(start, row, shape, x0, x1):
    """First and one past the last particle in the cells x0 to x1 of a row of `shape` cells; none where x1 <= x0. They
    are unsigned: of an index that might be negative numba asks so each time."""
    x0, x1 = max(x0, 0), min(x1, shape)
    return (np.uint64(start[row + x0]), np.uint64(start[row + x1])) if x0 < x1 else (np.uint64(0), np.uint64(0))


@njit(cache=True, parallel=True, error_model="numpy")
def _fill(grid, start, x, y, z, at_x, at_y, at_z, same, box, cutoff2, index, count):
    """Rows of neighbours (x, y, z), sorted by cell, of the points at_x, at_y, at_z; with `same` i is not its own.

    An entry is written before it is known to count, which saves a branch: a row that `count` fills was too short.
    """
    shape, room = grid.shape[0], np.uint64(index.shape[1] - 1)
    for i in prange(len(at_x)):
        found, own = np.uint64(0), np.uint64(i if same else len(x))
        xi, yi, zi = at_x[i], at_y[i], at_z[i] if len(z) else 0.0
        z0, z1 = span(grid, 2, zi) if len(z) else (0, 1)
        y0, y1 = span(grid, 1, yi)
        x0, x1 = span(grid, 0, xi)
        for kz in range(z0, z1):
            for ky in range(y0, y1):
                row = ((kz % grid.shape[2]) * grid.shape[1] + ky % grid.shape[1]) * shape
                for turn in range(-1, 2):  # through the ends of a periodic box
                    first, last = _run(start, row, shape, x0 + turn * shape, x1 + turn * shape)
                    for j in range(first, last):
                        dz = zi - z[j] if len(z) else 0.0
                        dx, dy, dz = nearest_image(box, xi - x[j], yi - y[j], dz)
                        index[i, min(found, room)] = j
                        found += np.uint64((j != own) & (dx * dx + dy * dy + dz * dz < cutoff2))
        if same:
            fill_up(index, i, np.int64(found))
        count[i] = found
