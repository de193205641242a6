"""Deposits of a device into cells: a thread a cell, which adds up in the order of the particles, as processors do."""

from __future__ import annotations

import numpy as np
from numba import prange

from sdph.engine import arrays
from sdph.laws.compiled import parallel


def listed(weights):
    """Weights of coupling.transfer with the entries of each cell."""
    begin = arrays.begins(weights.number)
    cell, slot = (arrays.empty(int(arrays.last(begin)), begin, np.int64) for _ in range(2))
    _tell_entries(begin, weights.cells, cell, slot)
    start, order = arrays.starts(cell, weights.total), arrays.order(cell, weights.total)
    return weights._replace(start=start, slot=arrays.taken(slot, order))


@parallel
def _tell_entries(begin, cells, cell, slot):
    """cell and slot (E,) of each entry, row by row; begin (N + 1,): the first of each row."""
    for k in prange(len(cells)):
        for e in range(begin[k + 1] - begin[k]):
            cell[begin[k] + e], slot[begin[k] + e] = cells[k, e], k * cells.shape[1] + e


@parallel
def deposit(weights, field, out):
    """Sums (C, m) of extensive particle values (N, m) in the cells."""
    stride = weights.cells.shape[1]
    for c in prange(len(out)):
        for m in range(field.shape[1]):
            total = 0.0
            for n in range(weights.start[c], weights.start[c + 1]):
                k = weights.slot[n] // stride
                total += weights.weight[k, weights.slot[n] - k * stride] * field[k, m]
            out[c, m] = total
