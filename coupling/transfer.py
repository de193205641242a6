"""Kernel interpolation between particles and the cells of any mesh.

One sparse matrix of weights serves both ways. Row k holds the weights of particle k over the cells it covers,
`w_kc = V_c W(|x_k - x_c|, h_c) / sum`, normalised so that each row sums to 1 (Eq. 26 of the SDPH closure sheet):

* `gather` takes cell values to particles with the rows: a uniform field is reproduced exactly;
* `deposit` takes extensive particle values to cells with the columns: totals are kept to round-off.

Where the gas fills a box, the kernel is folded at its sides (particles are mirrored there), so that grains spread
evenly up to a wall are seen evenly by the cells; on other meshes cells along a wall see somewhat more.

The smoothing length of cell c is `h_c = max(h, s_c)` with s_c the cell's own size, so that a coarse cell is seen
too, and weights stay smooth as a particle crosses from a fine part of a mesh to a coarse one. W is normalised in space
with that h_c, so that uniform grains are all but uniform in cells that jump in size: of cells that double from one to
the next, the finer as wide as h, the worst is 6 % off, 2 % where h is 0.75 of the coarser (it was 49 and 30 %).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import prange

from coupling import by_cell
from sdph.engine import arrays
from sdph.laws.by_reference import by_reference
from sdph.laws.compiled import inlined, parallel, serial
from sdph.laws.constants import TINY
from sdph.laws.kernels import SUPPORT

NOTHING = np.zeros(0, np.int64)
ROUNDS = 8  # from 18 % to 0.4 to 2 % off in cones of 8, 5 and 4 rings (measured); our choice


@by_reference
class Weights(NamedTuple):
    """Weights of N particles: row k is cells[k, :number[k]] with weight[k, :number[k]]; of `total` cells.

    `outside` names the particles that cover no cell centre and took the nearest cell. On a device, which deposits cell
    by cell, `slot` has the entries of each cell from its `start` on, particle by particle, as if rows stood one behind
    the other.
    """

    number: np.ndarray
    cells: np.ndarray
    weight: np.ndarray
    total: int
    outside: np.ndarray
    start: np.ndarray = NOTHING
    slot: np.ndarray = NOTHING


class Transfer:
    """Weights between particles and one mesh, for particles of smoothing length `smoothing` [m].

    `box` (d,) [m] is that of the domain, from its lower `corner` (d,) [m] or the origin; the kernel is folded at its
    sides where the mesh fills it. Where it does not, walls are where cells end, and the mesh says what places fill it
    evenly: V_c gets a factor by which they fill its cells evenly. Places are counted from the corner.
    """

    def __init__(self, mesh, smoothing: float, box=(), corner=()):
        self.volumes = mesh.volumes
        size = (mesh.volumes / mesh.depth) ** (1.0 / mesh.dimensions)
        self.smoothing = np.maximum(smoothing, size)
        filled = len(box) > 0 and mesh.fills(box)
        self.sides = np.array([*box, *[np.inf] * (3 - len(box))]) if filled else np.full(3, np.inf)
        self.corner = np.array([*corner, *[0.0] * (3 - len(corner))])
        # V_c/h_c^d but for a factor that rows take over: 1/h_c^d is the part of W that r/h does not tell
        share = mesh.volumes * (self.smoothing / self.smoothing.max()) ** -mesh.dimensions
        self.bins = _bins((mesh.centres - self.corner)[:, : mesh.dimensions], self.smoothing, share)
        self.stride, self.bins_there = 16, None
        if mesh.spread:
            self._even(mesh)

    def _even(self, mesh) -> None:
        """Change the cells' shares until grains that stand evenly in them fill each with its own volume: columns of a
        matrix whose rows stay 1 (Sinkhorn & Knopp 1967, Pac. J. Math. 21, 343)."""
        places, cell = mesh.spread
        own = (mesh.volumes / np.bincount(cell))[cell]
        for _ in range(ROUNDS):
            filled = deposit(self.weights(places), own)
            factor = mesh.volumes / np.maximum(filled, TINY)
            self.bins = self.bins._replace(share=self.bins.share * factor[self.bins.cell])

    def weights(self, positions: np.ndarray) -> Weights:
        """Weights of particles at (N, 3) positions [m]; a particle that covers no cell centre takes the nearest."""
        bins, count = self._bins_beside(positions), len(positions)
        while True:
            number = arrays.empty(count, positions, np.int64)
            cells, weight = (arrays.empty((count, self.stride), positions, kind) for kind in (np.int64, np.float64))
            _fill(bins, self.sides, self.corner, positions, number, cells, weight)
            most = int(arrays.ends(number)[1])
            if most < self.stride:
                break
            self.stride = most + 2
        outside = arrays.chosen(number == 0)
        if len(outside):
            _nearest(bins, self.corner, positions, outside, number, cells, weight)
        found = Weights(number, cells, weight, len(self.volumes), outside)
        return found if arrays.here(positions) else by_cell.listed(found)

    def _bins_beside(self, positions) -> Bins:
        """The bins where the positions are."""
        if arrays.here(positions):
            return self.bins
        if self.bins_there is None:
            own = (arrays.beside(part, positions) if isinstance(part, np.ndarray) else part for part in self.bins)
            self.bins_there = Bins(*own)
        return self.bins_there


def gather(weights: Weights, field: np.ndarray) -> np.ndarray:
    """Cell values (C,) or (C, m) at the particles: (N,) or (N, m)."""
    out = arrays.empty((len(weights.number), *field.shape[1:]), weights.number)
    _gather(weights, arrays.beside(_columns(field), out), _columns(out))
    return out


def deposit(weights: Weights, field: np.ndarray) -> np.ndarray:
    """Extensive particle values (N,) or (N, m) summed into cells: (C,) or (C, m), in memory. In order, so that it
    repeats bit for bit."""
    if not arrays.here(weights.number):
        out = arrays.empty((weights.total, math.prod(field.shape[1:])), weights.number)
        by_cell.deposit(weights, arrays.beside(_columns(field), out), out)
        return arrays.brought(out).reshape(weights.total, *field.shape[1:])
    out = np.zeros((weights.total, *field.shape[1:]))
    _deposit(weights, _columns(field), _columns(out))
    return out


def _columns(field):
    """(n, m) view of a field (n,) or (n, m); n may be 0."""
    shape = len(field), math.prod(field.shape[1:])
    return np.ascontiguousarray(field).reshape(shape) if arrays.here(field) else field.reshape(shape)


@by_reference
class Bins(NamedTuple):
    """Cells sorted into square bins of side `size`, each with its centre, 1/h^2 of its smoothing length (h `widest` of
    all), `share` (its volume over the volume that its kernel is wide), number."""

    low: np.ndarray
    size: np.ndarray
    shape: np.ndarray
    start: np.ndarray
    centres: np.ndarray
    inverse_square: np.ndarray
    share: np.ndarray
    cell: np.ndarray
    widest: float


def _bins(centres, smoothing, share) -> Bins:
    """`centres` (C, 2) or (C, 3); a missing axis is one bin thick."""
    points = np.zeros((len(centres), 3))
    points[:, : centres.shape[1]] = centres
    low, high = points.min(axis=0), points.max(axis=0)
    shape = np.maximum(1, ((high - low) / (SUPPORT * smoothing.max())).astype(np.int64))
    size = np.maximum(SUPPORT * smoothing.max(), (high - low) / shape)
    place = np.minimum(((points - low) / size).astype(np.int64), shape - 1)
    number = np.ravel_multi_index(tuple(place.T), tuple(shape), order="F")  # x fastest
    order = np.argsort(number, kind="stable")
    start = np.concatenate(([0], np.cumsum(np.bincount(number, minlength=int(shape.prod())))))
    return Bins(
        low, size, shape, start, points[order], smoothing[order] ** -2.0, share[order], order, float(smoothing.max())
    )


@serial
def _spline(q):
    """Cubic spline (M4) without its normalisation, which `Bins.share` has, but for what rows take over."""
    a, b = max(0.0, SUPPORT - q), max(0.0, 1.0 - q)
    return 0.25 * a * a * a - b * b * b


@serial
def _around(bins, a, value):
    """First and one past the last bin to look at along an axis, both from 0 to the number of bins, however far `value`
    is."""
    place = int(math.floor((value - bins.low[a]) / bins.size[a]))  # noqa: RUF046 - a float on a device
    first = min(max(place - 1, 0), bins.shape[a])
    return first, max(min(place + 2, bins.shape[a]), first)


@inlined
def _add(bins, x, y, z, cells, weight, found):
    """Appends the cells that a kernel at (x, y, z) reaches, by their place in the bins, and (r/h)^2 of each; returns
    how many there are then. An entry is written before it is known to count, which saves a branch: a row that they fill
    was too short. Indices are unsigned: of one that might be negative numba asks so each time."""
    x0, x1 = _around(bins, 0, x)
    y0, y1 = _around(bins, 1, y)
    z0, z1 = _around(bins, 2, z)
    room = np.uint64(len(cells) - 1)
    for bz in range(z0, z1):
        for by in range(y0, y1):
            row = (bz * bins.shape[1] + by) * bins.shape[0]
            for c in range(np.uint64(bins.start[row + x0]), np.uint64(bins.start[row + x1])):
                dx, dy, dz = x - bins.centres[c, 0], y - bins.centres[c, 1], z - bins.centres[c, 2]
                e, square = min(found, room), (dx * dx + dy * dy + dz * dz) * bins.inverse_square[c]
                cells[e], weight[e] = c, square
                found += np.uint64(square < SUPPORT * SUPPORT)
    return found


@serial
def _inside(side, reach, place):
    """True where a place is so far from both ends of an axis that none mirrors it."""
    return side == np.inf or reach <= place <= side - reach


@serial
def _image(side, reach, place, which):
    """A place along one axis (0), or its mirror image at the origin (1) or at `side` (2), where that is near; else
    nan."""
    if which == 0:
        return place
    if side == np.inf:
        return np.nan
    distance = place if which == 1 else side - place
    if not 0.0 <= distance < reach:
        return np.nan
    return -place if which == 1 else 2.0 * side - place


@inlined
def _row(bins, sides, x, y, z, cells, weight):
    """One normalised row, mirror images included; returns how many entries there are, also when the row is too
    short."""
    found, reach = np.uint64(0), SUPPORT * bins.widest
    if _inside(sides[0], reach, x) and _inside(sides[1], reach, y) and _inside(sides[2], reach, z):
        return _weighed(bins, cells, weight, _add(bins, x, y, z, cells, weight, found))
    for a in range(3):
        image_x = _image(sides[0], reach, x, a)
        for b in range(3):
            image_y = _image(sides[1], reach, y, b)
            for c in range(3):
                image_z = _image(sides[2], reach, z, c)
                if image_x == image_x and image_y == image_y and image_z == image_z:  # none is nan
                    found = _add(bins, image_x, image_y, image_z, cells, weight, found)
    return _weighed(bins, cells, weight, found)


@inlined
def _weighed(bins, cells, weight, found):
    """`found`, with cells by their number and weights that sum to 1."""
    total, entries = 0.0, min(found, np.uint64(len(cells)))
    for e in range(entries):
        weight[e] = _spline(math.sqrt(weight[e]))
    for e in range(entries):
        weight[e] *= bins.share[cells[e]]
        total += weight[e]
    for e in range(entries):
        cells[e], weight[e] = bins.cell[cells[e]], weight[e] / total
    return np.int64(found)


@parallel
def _fill(bins, sides, corner, points, number, cells, weight):
    for k in prange(len(points)):
        x, y, z = points[k, 0] - corner[0], points[k, 1] - corner[1], points[k, 2] - corner[2]
        number[k] = _row(bins, sides, x, y, z, cells[k], weight[k])


@parallel
def _nearest(bins, corner, points, outside, number, cells, weight):
    """Rows of the particles `outside`: the nearest cell."""
    for n in prange(len(outside)):
        k, least, best = outside[n], np.inf, 0
        x, y, z = points[k, 0] - corner[0], points[k, 1] - corner[1], points[k, 2] - corner[2]
        for c in range(len(bins.cell)):
            dx, dy, dz = bins.centres[c, 0] - x, bins.centres[c, 1] - y, bins.centres[c, 2] - z
            square = dx * dx + dy * dy + dz * dz
            if square < least:
                least, best = square, c
        cells[k, 0] = bins.cell[best]
        weight[k, 0] = number[k] = 1


@parallel
def _gather(weights, field, out):
    for k in prange(len(out)):
        entries = np.uint64(weights.number[k])
        for m in range(field.shape[1]):
            total = 0.0
            for e in range(entries):
                total += weights.weight[k, e] * field[np.uint64(weights.cells[k, e]), m]
            out[k, m] = total


@serial
def _deposit(weights, field, out):
    for k in range(len(field)):
        for e in range(np.uint64(weights.number[k])):
            cell, weight = np.uint64(weights.cells[k, e]), weights.weight[k, e]
            for m in range(field.shape[1]):
                out[cell, m] += weight * field[k, m]
