"""Neighbour rows of a liquid and its walls, one behind the other, so that a row takes no more room than it needs.

Within a cell liquid comes before wall, and the row of a wall particle holds the liquid near it and no other wall. Rows
are counted before they are filled: to count is quick, in whole vectors.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit, prange

from sdph.engine import geometry, motion
from sdph.engine import rows as neighbours
from sdph.engine import state as particles
from sdph.engine.geometry import nearest_image
from sdph.engine.rows import LANES, span
from sdph.engine.state import WALL


class Rows(NamedTuple):
    """Neighbours of particle i: `count[i]` entries of `index` from `start[i]` on, then i itself, once at least, up to a
    multiple of LANES."""

    index: np.ndarray
    start: np.ndarray
    count: np.ndarray


class LiquidNeighbours(neighbours.Neighbours):
    """Rows that hold until some particle has moved half the skin; the distance is measured in parallel."""

    def __init__(self, reach: float, period, skin: float):
        super().__init__(reach, period, skin)
        self.room = np.empty(0, np.uint32)

    def revive(self) -> None:
        """Of a checkpoint that was put back; its rows need kinds, see `relist`."""

    def relist(self, kind) -> Rows:
        """The rows of the last build anew."""
        self.rows = self._rows_of(self._grid(self.built), self.built, kind)
        return self.rows

    def _sorted(self, grid, state):
        number = _halves(neighbours.cells(grid, *neighbours.three(particles.axes(state))), state.kind)
        return particles.take(state, neighbours.order(number, 2 * int(grid.shape.prod())))

    def _listed(self, grid, state) -> Rows:
        return self._rows_of(grid, particles.axes(state), state.kind)

    def _rows_of(self, grid, here, kind) -> Rows:
        places, self.box = neighbours.three(here), geometry.box_of(self.period, len(here))
        # see _runs
        halves = neighbours.starts(_halves(neighbours.cells(grid, *places), kind), 2 * int(grid.shape.prod())).view(
            np.uint64
        )
        near = (grid, halves, *places, kind, self.box, (self.reach * (1.0 + self.skin)) ** 2)
        count, start = np.empty(len(kind), np.int32), np.zeros(len(kind) + 1, np.int64)
        _count(*near, count)
        np.cumsum((count // LANES + 1) * LANES, out=start[1:])
        index = self._room_for(int(start[-1]))
        _fill(*near, start, count, index)
        return Rows(index, start, count)

    def _room_for(self, entries: int) -> np.ndarray:
        """Room for that many entries; that of the last time where they fit, which nobody needs any more."""
        if len(self.room) < entries:
            self.room = np.empty(0, np.uint32)  # given back before more is taken
            # some spare, so that a slow compaction does not ask each time
            self.room = np.empty(entries + entries // 16, np.uint32)
        return self.room

    def _holds(self, here) -> bool:
        if len(here) != len(self.built) or len(here[0]) != len(self.built[0]):
            return False
        z, z0 = (here[2], self.built[2]) if len(here) == 3 else (np.zeros(0), np.zeros(0))
        moved = motion.travelled(here[0], here[1], z, self.built[0], self.built[1], z0)
        return bool(moved < (0.5 * self.skin * self.reach) ** 2)


@njit(cache=True, parallel=True, error_model="numpy")
def _halves(number, kind):
    """Cells in halves, liquid before wall: (N,) twice the cell number, and one for a wall."""
    halves = np.empty(len(number), np.int64)
    for i in prange(len(number)):
        halves[i] = 2 * number[i] + (kind[i] == WALL)
    return halves


@njit(cache=True, error_model="numpy")
def _within(x, y, z, box, i, j, cutoff2):
    dz = z[i] - z[j] if len(z) else 0.0
    dx, dy, dz = nearest_image(box, x[i] - x[j], y[i] - y[j], dz)
    return dx * dx + dy * dy + dz * dz < cutoff2


@njit(cache=True, error_model="numpy")
def _runs(grid, halves, x, y, z, kind, i):
    """(C, 2) first and one past the last particle that i may meet in each cell around it. They are unsigned: of an
    index that might be negative numba asks so each time, and nothing is done in whole vectors."""
    layers, lines, cells = span(grid, 2, z[i]) if len(z) else (0, 1), span(grid, 1, y[i]), span(grid, 0, x[i])
    runs = np.empty(((layers[1] - layers[0]) * (lines[1] - lines[0]) * (cells[1] - cells[0]), 2), np.uint64)
    found, last = 0, 1 if kind[i] == WALL else 2
    for kz in range(layers[0], layers[1]):
        for ky in range(lines[0], lines[1]):
            line = ((kz % grid.shape[2]) * grid.shape[1] + ky % grid.shape[1]) * grid.shape[0]
            for kx in range(cells[0], cells[1]):
                cell = 2 * (line + kx % grid.shape[0])
                runs[found, 0], runs[found, 1] = halves[cell], halves[cell + last]
                found += 1
    return runs


@njit(cache=True, parallel=True, error_model="numpy")
def _count(grid, halves, x, y, z, kind, box, cutoff2, count):
    """count (N,) of neighbours; a particle is not its own."""
    for i in prange(len(x)):
        found = 0 if kind[i] == WALL else -1  # a liquid particle finds itself
        runs = _runs(grid, halves, x, y, z, kind, i)
        for n in range(len(runs)):
            for j in range(runs[n, 0], runs[n, 1]):
                found += 1 if _within(x, y, z, box, i, j, cutoff2) else 0
        count[i] = found


@njit(cache=True, parallel=True, error_model="numpy")
def _fill(grid, halves, x, y, z, kind, box, cutoff2, start, count, index):
    """index: the rows, each from its start on. An entry is written before it is known to count, which saves a
    branch."""
    for i in prange(len(x)):
        end = start[i]
        runs = _runs(grid, halves, x, y, z, kind, i)
        for n in range(len(runs) if count[i] else 0):
            for j in range(runs[n, 0], runs[n, 1]):
                index[end] = j
                end += 1 if j != i and _within(x, y, z, box, i, j, cutoff2) else 0
        for e in range(end, start[i + 1]):
            index[e] = i
