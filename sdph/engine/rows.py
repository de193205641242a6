"""Rows of neighbours as loops take them, and the loops that list who is near.

Rows stand one behind the other, so that none takes more room than it needs, and are counted before they are filled: to
count is quick, in whole vectors. On a device those of ABREAST particles stand side by side: their threads read what
lies together.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import prange

from sdph.engine import arrays
from sdph.engine.cells import span, turned
from sdph.engine.geometry import nearest_image
from sdph.laws.by_reference import by_reference
from sdph.laws.compiled import inlined, parallel, serial

LANES = 4  # doubles of a vector register of 256 bit, as wide as pays on today's x86
ABREAST = 32  # rows side by side: threads of a warp, which go through theirs together


@by_reference
class Rows(NamedTuple):
    """Neighbours of particle i: `number[i]` of the `entries` from `start[i]` on, then i itself, once at least, up to a
    multiple of LANES."""

    entries: np.ndarray
    start: np.ndarray
    number: np.ndarray


class Abreast(NamedTuple):
    """The same of a device: each entry of a row lies ABREAST places behind the last."""

    entries: np.ndarray
    start: np.ndarray
    number: np.ndarray
    abreast: int = ABREAST


def laid(taken) -> tuple:
    """Kind of rows that take as many entries (N,), where each begins, and the end."""
    if arrays.here(taken):
        return Rows, arrays.begins(taken)
    return Abreast, arrays.card.begins_abreast(taken, ABREAST)


@inlined
def stride(rows):
    """Places from an entry of a row to its next."""
    return ABREAST if len(rows) == 4 else 1  # walls have their rows in a group of more


@inlined
def place(rows, i, k):
    """Index of the k-th entry of row i, among the entries and in arrays along them. It is unsigned: of an index that
    might be negative numba asks so each time."""
    return np.uint64(rows.start[i] + k * stride(rows))


@inlined
def entry(rows, i, k):
    """The k-th neighbour of particle i."""
    return rows.entries[place(rows, i, k)]


@inlined
def length(rows, i):
    """Entries to loop over in row i, a multiple of LANES: a loop of pairs then runs in whole vectors. The last ones may
    be i itself, whose separation from i, and so every pair term, is 0."""
    return (rows.number[i] + LANES - 1) // LANES * LANES


@serial
def _end(rows, entries, first, i, number):
    """Put i itself from the place `first` on as far as row i has `number` entries."""
    for e in range(first, np.int64(place(rows, i, number)), stride(rows)):
        entries[e] = i


@serial
def shorten(rows, i, number):
    """Leave row i its first `number` entries, and put i itself behind them as far as `length` goes."""
    rows.number[i] = number
    _end(rows, rows.entries, np.int64(place(rows, i, number)), i, length(rows, i))


@serial
def _run(begin, line, shape, x0, x1, blind, n):
    """First and one past the last particle of the n-th run of a line of `shape` cells, of which x0 to x1 are looked at:
    one run for each time round a periodic box, or for who is blind to what is solid the first half of each cell. They
    are unsigned: of an index that might be negative numba asks so each time, and nothing is done in whole vectors."""
    if blind:
        half = 2 * (line + turned(x0 + n, shape))
        return begin[half], begin[half + 1]
    turn = (n - 1) * shape
    low, high = max(x0 - turn, 0), min(x1 - turn, shape)
    return (begin[2 * (line + low)], begin[2 * (line + high)]) if low < high else (np.uint64(0), np.uint64(0))


@serial
def _counted(x, y, z, box, xi, yi, zi, cutoff2, first, last):
    """Number of a run's particles within the cutoff."""
    found = 0
    for j in range(first, last):
        dx, dy, dz = nearest_image(box, xi - x[j], yi - y[j], zi - z[j] if len(z) else 0.0)
        found += 1 if dx * dx + dy * dy + dz * dz < cutoff2 else 0
    return found


@serial
def _listed(x, y, z, box, xi, yi, zi, own, cutoff2, first, last, rows, entries, end):
    """Appends those to the entries and returns their end. One is written before it is known to count, which saves a
    branch; a device rather has branches than writes."""
    step = np.uint64(stride(rows))
    for j in range(first, last):
        dx, dy, dz = nearest_image(box, xi - x[j], yi - y[j], zi - z[j] if len(z) else 0.0)
        counts = (j != own) & (dx * dx + dy * dy + dz * dz < cutoff2)
        if stride(rows) == 1 or counts:
            entries[end] = j
        end += np.uint64(counts) * step
    return end


@parallel
def count(grid, begin, x, y, z, at_x, at_y, at_z, blind, idle, same, box, cutoff2, number, taken):
    """number (n,) of neighbours (x, y, z), sorted by cell, of the points at_x, at_y, at_z; with `same` i is not its
    own; taken (n,): entries that its row takes, a multiple of LANES and one at least."""
    for i in prange(len(at_x)):
        if len(idle) > 0 and idle[i]:
            number[i], taken[i] = 0, LANES
            continue
        found = -1 if same and not blind[i] else 0  # who sees itself
        xi, yi, zi = at_x[i], at_y[i], at_z[i] if len(z) else 0.0
        z0, z1 = span(grid, 2, zi) if len(z) else (0, 1)
        y0, y1 = span(grid, 1, yi)
        x0, x1 = span(grid, 0, xi)
        runs = (0, x1 - x0) if blind[i] else (0, 3) if grid.period[0] > 0.0 else (1, 2)
        for kz in range(z0, z1):
            for ky in range(y0, y1):
                line = (turned(kz, grid.shape[2]) * grid.shape[1] + turned(ky, grid.shape[1])) * grid.shape[0]
                for n in range(runs[0], runs[1]):
                    first, last = _run(begin, line, grid.shape[0], x0, x1, blind[i], n)
                    found += _counted(x, y, z, box, xi, yi, zi, cutoff2, first, last)
        number[i] = max(found, 0)  # who is nowhere does not see itself
        taken[i] = (number[i] // LANES + 1) * LANES


@parallel
def fill(grid, begin, x, y, z, at_x, at_y, at_z, blind, idle, same, box, cutoff2, rows, taken, entries):
    """entries: those of the rows, of what `count` has counted."""
    for i in prange(len(at_x)):
        if rows.number[i] == 0:
            _end(rows, entries, np.int64(place(rows, i, 0)), i, taken[i])
            continue
        end, own = place(rows, i, 0), np.uint64(i if same else len(x))
        xi, yi, zi = at_x[i], at_y[i], at_z[i] if len(z) else 0.0
        z0, z1 = span(grid, 2, zi) if len(z) else (0, 1)
        y0, y1 = span(grid, 1, yi)
        x0, x1 = span(grid, 0, xi)
        runs = (0, x1 - x0) if blind[i] else (0, 3) if grid.period[0] > 0.0 else (1, 2)
        for kz in range(z0, z1):
            for ky in range(y0, y1):
                line = (turned(kz, grid.shape[2]) * grid.shape[1] + turned(ky, grid.shape[1])) * grid.shape[0]
                for n in range(runs[0], runs[1]):
                    first, last = _run(begin, line, grid.shape[0], x0, x1, blind[i], n)
                    end = _listed(x, y, z, box, xi, yi, zi, own, cutoff2, first, last, rows, entries, end)
        _end(rows, entries, np.int64(end), i, taken[i])


@parallel
def renumber(entries, many, order):
    """Give the first `many` entries the numbers that order (N,) has in their places."""
    for e in prange(many):
        entries[e] = order[entries[e]]
