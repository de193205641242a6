"""Conjugate gradients preconditioned by geometric multigrid, for the pressure.

Cells join in pairs along every axis whose cells are not much longer than the others'. Coarse conductances add
those of the fine faces, scaled by the distance between centres; corrections go up by linear interpolation on the
simplex of the own coarse cell and its nearest neighbours, residuals come down by its transpose; one red-black
Gauss-Seidel sweep before and its mirror after keep the whole symmetric. All levels share packed arrays, so that
one solve is one call.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from coupling.embedded.grid import build_grid, indices
from coupling.embedded.linear import ITERATIONS, coupled

ELONGATED = 1.5  # an axis waits while its cells are this much longer than the shortest; our choice
NEAR = 0.25  # weight of a coarse neighbour: a fine centre lies a quarter of a coarse cell off


class Levels(NamedTuple):
    """Packed levels: level l owns [first[l], first[l + 1]) of each packed array and rows[row_first[l]: ...].

    strides (L, d), run (L,); rows, odd (R,): first index of each run of cells, and its colour; parent (P,) and
    near (d, P): coarse cell and its neighbours that a fine cell interpolates from; ratio (d, P): distance over
    coarse distance of the faces that lie on coarse faces, 0 for others.
    """

    first: np.ndarray
    row_first: np.ndarray
    strides: np.ndarray
    run: np.ndarray
    rows: np.ndarray
    odd: np.ndarray
    parent: np.ndarray
    near: np.ndarray
    ratio: np.ndarray


def build_levels(grid) -> Levels:
    """Coarsen `grid` down to one cell."""
    grids, maps = [grid], []
    while max(grids[-1].counts) > 1:
        coarse, parent = _coarsen(grids[-1])
        maps.append(_family(grids[-1], coarse, parent))
        grids.append(coarse)
    last = grids[-1]
    maps.append((np.zeros(last.size, dtype=np.int64), np.zeros((last.dimensions, last.size), dtype=np.int64), last.zeros(last.dimensions)))
    return Levels(
        first=np.cumsum([0] + [g.size for g in grids]), row_first=np.cumsum([0] + [len(g.rows) for g in grids]),
        strides=np.array([g.strides for g in grids]), run=np.array([g.run for g in grids]),
        rows=np.concatenate([g.rows for g in grids]), odd=np.concatenate([_odd(g) for g in grids]),
        parent=np.concatenate([m[0] for m in maps]), near=np.concatenate([m[1] for m in maps], axis=1),
        ratio=np.concatenate([m[2] for m in maps], axis=1),
    )  # fmt: skip


def _odd(grid) -> np.ndarray:
    """Colour of the first cell of every row: the parity of its index."""
    others = np.indices(grid.counts[:0:-1]).reshape(grid.dimensions - 1, -1)
    return (others.sum(axis=0) & 1).astype(np.int64)


def _coarsen(grid):
    """The next coarser grid, and along each axis the coarse index of every fine one (one more: the upper ghost)."""
    width = [(e[-1] - e[0]) / n for e, n in zip(grid.edges, grid.counts)]
    shortest = min(w for w, n in zip(width, grid.counts) if n > 1)
    edges, parent = [], []
    for e, w, n in zip(grid.edges, width, grid.counts):
        join = 2 if n > 1 and w < ELONGATED * shortest else 1
        edges.append(np.append(e[:-1:join], e[-1]))
        parent.append(np.append(np.arange(n) // join, (n + join - 1) // join))
    return build_grid(tuple(edges)), parent


def _family(grid, coarse, parent):
    """parent, near and ratio of one level."""
    d = grid.dimensions
    wide = indices(grid.counts, (0,) * d, tuple(n + 1 for n in grid.counts))
    place = np.indices(tuple(n + 1 for n in reversed(grid.counts))).reshape(d, -1)[::-1]
    origin = indices(coarse.counts, (0,) * d, (1,) * d)[0]
    above = [p[i] for p, i in zip(parent, place)]
    into = np.zeros(grid.size, dtype=np.int64)
    into[wide] = origin + sum(s * i for s, i in zip(coarse.strides, above))
    near, ratio = np.tile(into, (d, 1)), np.zeros((d, grid.size))
    for a in range(d):
        fresh = (place[a] == 0) | (parent[a][place[a]] != parent[a][place[a] - 1])
        face = wide[fresh]
        ratio[a, face] = grid.gap[a, face] / coarse.gap[a, into[face]]
        towards = np.where(fresh, -1, 1)
        exists = (above[a] + towards >= 0) & (above[a] + towards < coarse.counts[a]) & (grid.counts[a] > coarse.counts[a])
        near[a, wide] += np.where(exists, towards, 0) * coarse.strides[a]
    return into, near, ratio


@njit(error_model="numpy")
def _smooth(rows, odd, run, strides, colour, conductance, diagonal, b, x):
    for n in range(len(rows)):
        for c in range(rows[n] + ((odd[n] + colour) & 1), rows[n] + run, 2):
            total, weighted = coupled(conductance, strides, x, c)
            x[c] = (b[c] + weighted) / diagonal[c] if diagonal[c] > 0.0 else 0.0


@njit(error_model="numpy")
def _sum_conductances(rows, run, strides, conductance, diagonal):
    for row in rows:
        for c in range(row, row + run):
            diagonal[c] = 0.0
            for a in range(len(strides)):
                diagonal[c] += conductance[a, c] + conductance[a, c + strides[a]]


@njit(error_model="numpy")
def _prepare(levels, strides, conductance, diagonal):
    """Conductances of the coarse levels from those of the finest, and every diagonal."""
    count = len(levels.run)
    for l in range(count):
        o, end = levels.first[l], levels.first[l + 1]
        k = conductance[:, o:end]
        rows = levels.rows[levels.row_first[l] : levels.row_first[l + 1]]
        _sum_conductances(rows, levels.run[l], strides[l], k, diagonal[o:end])
        if l + 1 == count:
            break
        above = conductance[:, end : levels.first[l + 2]]
        above[:] = 0.0
        for a in range(k.shape[0]):
            for c in range(end - o):
                if k[a, c] > 0.0:
                    above[a, levels.parent[o + c]] += k[a, c] * levels.ratio[a, o + c]


@njit(error_model="numpy")
def _restrict(levels, l, strides, k, diagonal, b, x, below):
    """Hand the residual of level l to the next coarser one."""
    o = levels.first[l]
    own = 1.0 - NEAR * k.shape[0]
    below[:] = 0.0
    for n in range(levels.row_first[l], levels.row_first[l + 1]):
        for c in range(levels.rows[n], levels.rows[n] + levels.run[l]):
            total, weighted = coupled(k, strides, x, c)
            r = b[c] + weighted - diagonal[c] * x[c]
            below[levels.parent[o + c]] += own * r
            for a in range(k.shape[0]):
                below[levels.near[a, o + c]] += NEAR * r


@njit(error_model="numpy")
def _interpolate(levels, l, dimensions, coarse, x):
    """Add the correction of the next coarser level to level l."""
    o = levels.first[l]
    own = 1.0 - NEAR * dimensions
    for n in range(levels.row_first[l], levels.row_first[l + 1]):
        for c in range(levels.rows[n], levels.rows[n] + levels.run[l]):
            x[c] += own * coarse[levels.parent[o + c]]
            for a in range(dimensions):
                x[c] += NEAR * coarse[levels.near[a, o + c]]


@njit(error_model="numpy")
def _cycle(levels, strides, conductance, diagonal, b, x):
    """One symmetric V(1,1) cycle: x = about A^-1 b on the finest level."""
    count = len(levels.run)
    for l in range(count):
        o, end = levels.first[l], levels.first[l + 1]
        rows = levels.rows[levels.row_first[l] : levels.row_first[l + 1]]
        odd = levels.odd[levels.row_first[l] : levels.row_first[l + 1]]
        k = conductance[:, o:end]
        x[o:end] = 0.0
        for colour in range(2):
            _smooth(rows, odd, levels.run[l], strides[l], colour, k, diagonal[o:end], b[o:end], x[o:end])
        if l + 1 < count:
            _restrict(levels, l, strides[l], k, diagonal[o:end], b[o:end], x[o:end], b[end : levels.first[l + 2]])
    for l in range(count - 2, -1, -1):
        o, end = levels.first[l], levels.first[l + 1]
        rows = levels.rows[levels.row_first[l] : levels.row_first[l + 1]]
        odd = levels.odd[levels.row_first[l] : levels.row_first[l + 1]]
        _interpolate(levels, l, conductance.shape[0], x[end : levels.first[l + 2]], x[o:end])
        for colour in range(1, -1, -1):
            _smooth(rows, odd, levels.run[l], strides[l], colour, conductance[:, o:end], diagonal[o:end], b[o:end], x[o:end])


@njit(cache=True, error_model="numpy")
def solve_pressure(levels, strides, conductance, diagonal, b, z, source, scale, x, tolerance):
    """Solve sum K (x - x_nb) = source on the cells, x (S,) from zero, until |residual| <= tolerance scale on each.

    conductance (d, P) holds K on its finest level; diagonal, b, z (P,) are work space. Returns the iterations and
    the last residual over scale. Without an open boundary x is fixed up to a constant, and source must sum to zero.
    """
    size, run = levels.first[1], levels.run[0]
    rows = levels.rows[: levels.row_first[1]]
    k, s = conductance[:, :size], strides[0]
    r, p, q = b[:size], np.zeros(size), np.zeros(size)
    r[:], x[:] = source, 0.0
    ready, rho, iterations = False, 1.0, 0
    while True:
        error = 0.0
        for row in rows:
            for c in range(row, row + run):
                error = max(error, abs(r[c]) / scale[c])
        if not error > tolerance or iterations == ITERATIONS:
            return iterations, error
        if not ready:
            _prepare(levels, strides, conductance, diagonal)
            ready = True
        iterations += 1
        _cycle(levels, strides, conductance, diagonal, b, z)
        new = 0.0
        for row in rows:
            for c in range(row, row + run):
                new += r[c] * z[c]
        share = new / rho if iterations > 1 else 0.0
        rho, curvature = new, 0.0
        for row in rows:
            for c in range(row, row + run):
                p[c] = z[c] + share * p[c]
        for row in rows:
            for c in range(row, row + run):
                total, weighted = coupled(k, s, p, c)
                q[c] = diagonal[c] * p[c] - weighted
                curvature += p[c] * q[c]
        step = rho / curvature
        for row in rows:
            for c in range(row, row + run):
                x[c] += step * p[c]
                r[c] -= step * q[c]
