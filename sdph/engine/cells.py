"""Cells that particles are sorted into, and which of them a particle has to look at.

A counting sort by cell (sdph.engine.arrays) leaves the particles of one cell together; what is solid lies behind the
rest of its cell.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import prange

from sdph.engine import arrays
from sdph.engine.state import WALL
from sdph.laws.compiled import parallel, serial


class Grid(NamedTuple):
    """Cells of side `size` [m] from `origin` (3,) [m]; `shape` (3,) cells; `period` (3,) [m], 0 where open."""

    origin: np.ndarray
    size: np.ndarray
    shape: np.ndarray
    period: np.ndarray


@serial
def _place(grid, a, value):
    cell = int((value - grid.origin[a]) / grid.size[a])
    return min(max(cell, 0), grid.shape[a] - 1)


def solid_of(kind):
    """Mask (N,) of the wall particles among those of these kinds."""
    solid = arrays.empty(len(kind), kind, np.bool_)
    _tell_solid(kind, solid)
    return solid


@parallel
def _tell_solid(kind, solid):
    for i in prange(len(kind)):
        solid[i] = kind[i] == WALL


@parallel
def halves(grid, x, y, z, solid, number):
    """Half of a cell that each particle is in, number (N,): twice the number of the cell, x fastest, and one more for
    what is solid."""
    for i in prange(len(x)):
        layer = _place(grid, 2, z[i]) if len(z) else 0
        number[i] = (
            2 * ((layer * grid.shape[1] + _place(grid, 1, y[i])) * grid.shape[0] + _place(grid, 0, x[i])) + solid[i]
        )


@serial
def span(grid, a, value):
    """First and one past the last cell to look at along an axis; beyond the ends on a periodic one."""
    cell = _place(grid, a, value)
    if grid.period[a] > 0.0:
        return (cell - 1, cell + 2) if grid.shape[a] >= 3 else (0, grid.shape[a])
    return max(cell - 1, 0), min(cell + 2, grid.shape[a])


@serial
def turned(cell, count):
    """A cell of `span`, one turn at most beyond the ends of an axis, by its number; % would cost more than the rest."""
    return cell + count if cell < 0 else cell - count if cell >= count else cell
