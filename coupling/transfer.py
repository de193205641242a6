"""Kernel interpolation between particles and the cells of any mesh.

One sparse matrix of weights serves both ways. Row k holds the weights of particle k over the cells it covers,
`w_kc = V_c W(|x_k - x_c|, h_c) / sum`, normalised so that each row sums to 1 (Eq. 26 of the SDPH closure sheet):

* `gather` takes cell values to particles with the rows: a uniform field is reproduced exactly;
* `deposit` takes extensive particle values to cells with the columns: totals are kept to round-off.

The smoothing length of cell c is `h_c = max(h, s_c)` with s_c the cell's own size, so that a coarse cell is seen
too, and weights stay smooth as a particle crosses from a fine part of a mesh to a coarse one.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit, prange

SUPPORT = 2.0  # reach of the cubic spline in smoothing lengths


class Weights(NamedTuple):
    """Weights of N particles: row k is cells[start[k]:start[k+1]] with weight[...]; C cells in all."""

    start: np.ndarray
    cells: np.ndarray
    weight: np.ndarray
    count: int


class Transfer:
    """Weights between particles and one mesh, for particles of smoothing length `smoothing` [m]."""

    def __init__(self, mesh, smoothing: float):
        self.volumes = mesh.volumes
        size = (mesh.volumes / mesh.depth) ** (1.0 / mesh.dimensions)
        self.smoothing = np.maximum(smoothing, size)
        self.centres = np.ascontiguousarray(mesh.centres[:, : mesh.dimensions])
        self.bins = _bins(self.centres, SUPPORT * self.smoothing.max())

    def weights(self, positions: np.ndarray) -> Weights:
        """Weights of particles at (N, 3) positions [m]; a particle that covers no cell centre takes the nearest."""
        points = np.ascontiguousarray(positions[:, : self.centres.shape[1]])
        count = _count(self.bins, self.centres, self.smoothing, points)
        start = np.concatenate(([0], np.cumsum(np.maximum(count, 1))))
        cells, weight = np.empty(start[-1], np.int64), np.empty(start[-1])
        _fill(self.bins, self.centres, self.smoothing, self.volumes, points, start, cells, weight)
        for k in np.flatnonzero(count == 0):
            cells[start[k]] = ((self.centres - points[k]) ** 2).sum(axis=1).argmin()
            weight[start[k]] = 1.0
        return Weights(start, cells, weight, len(self.volumes))

    def outside(self, positions: np.ndarray) -> np.ndarray:
        """Mask of the particles that cover no cell centre."""
        points = np.ascontiguousarray(positions[:, : self.centres.shape[1]])
        return _count(self.bins, self.centres, self.smoothing, points) == 0


def gather(weights: Weights, field: np.ndarray) -> np.ndarray:
    """Cell values (C,) or (C, m) at the particles: (N,) or (N, m)."""
    out = np.empty((len(weights.start) - 1, *field.shape[1:]))
    _gather(weights, _columns(field), _columns(out))
    return out


def deposit(weights: Weights, field: np.ndarray) -> np.ndarray:
    """Extensive particle values (N,) or (N, m) summed into cells: (C,) or (C, m). In order, so that it repeats bit for bit."""
    out = np.zeros((weights.count, *field.shape[1:]))
    _deposit(weights, _columns(field), _columns(out))
    return out


def _columns(field):
    """(n, m) view of a field (n,) or (n, m); n may be 0."""
    return np.ascontiguousarray(field).reshape(len(field), math.prod(field.shape[1:]))


class Bins(NamedTuple):
    """Cell centres sorted into square bins of side `size`."""

    low: np.ndarray
    size: float
    shape: np.ndarray
    start: np.ndarray
    order: np.ndarray


def _bins(centres, size) -> Bins:
    low, high = centres.min(axis=0), centres.max(axis=0)
    shape = np.maximum(1, np.ceil((high - low) / size).astype(np.int64))
    place = np.minimum(((centres - low) / size).astype(np.int64), shape - 1)
    number = np.ravel_multi_index(tuple(place.T), tuple(shape))
    order = np.argsort(number, kind="stable")
    start = np.concatenate(([0], np.cumsum(np.bincount(number, minlength=int(shape.prod())))))
    return Bins(low, float(size), shape, start, order)


@njit(cache=True, error_model="numpy")
def _spline(q):
    """Cubic spline (M4) without its normalisation, which the rows' own takes over."""
    return 0.25 * (2.0 - q) ** 3 if q > 1.0 else 1.0 - 1.5 * q * q + 0.75 * q * q * q


@njit(cache=True, error_model="numpy")
def _visit(bins, centres, smoothing, point, cells, weight):
    """Cells whose kernel reaches `point`, with weights (not yet volume-weighted); writes while there is room."""
    found = 0
    dims = len(point)
    place = ((point - bins.low) / bins.size).astype(np.int64)
    first, last = np.maximum(place - 1, 0), np.minimum(place + 2, bins.shape)
    if dims == 3:
        z0, z1 = first[2], last[2]
    else:
        z0, z1 = 0, 1
    for bx in range(first[0], last[0]):
        for by in range(first[1], last[1]):
            for bz in range(z0, z1):
                b = bx * bins.shape[1] + by
                if dims == 3:
                    b = b * bins.shape[2] + bz
                for c in bins.order[bins.start[b] : bins.start[b + 1]]:
                    r2 = 0.0
                    for a in range(dims):
                        r2 += (point[a] - centres[c, a]) ** 2
                    q = np.sqrt(r2) / smoothing[c]
                    if q < SUPPORT:
                        if found < len(cells):
                            cells[found] = c
                            weight[found] = _spline(q)
                        found += 1
    return found


@njit(cache=True, parallel=True, error_model="numpy")
def _count(bins, centres, smoothing, points):
    count = np.empty(len(points), np.int64)
    none, nothing = np.empty(0, np.int64), np.empty(0)
    for k in prange(len(points)):
        count[k] = _visit(bins, centres, smoothing, points[k], none, nothing)
    return count


@njit(cache=True, parallel=True, error_model="numpy")
def _fill(bins, centres, smoothing, volumes, points, start, cells, weight):
    for k in prange(len(points)):
        _row(bins, centres, smoothing, volumes, points[k], cells[start[k] : start[k + 1]], weight[start[k] : start[k + 1]])


@njit(cache=True, error_model="numpy")
def _row(bins, centres, smoothing, volumes, point, cells, weight):
    """One normalised row; a function of its own, because numba takes `*=` inside a prange for a reduction."""
    if _visit(bins, centres, smoothing, point, cells, weight) > 0:
        weight *= volumes[cells]
        weight /= weight.sum()


@njit(cache=True, parallel=True, error_model="numpy")
def _gather(weights, field, out):
    for k in prange(len(out)):
        for m in range(field.shape[1]):
            total = 0.0
            for e in range(weights.start[k], weights.start[k + 1]):
                total += weights.weight[e] * field[weights.cells[e], m]
            out[k, m] = total


@njit(cache=True, error_model="numpy")
def _deposit(weights, field, out):
    for k in range(len(field)):
        for e in range(weights.start[k], weights.start[k + 1]):
            for m in range(field.shape[1]):
                out[weights.cells[e], m] += weights.weight[e] * field[k, m]
