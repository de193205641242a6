"""Reference weights: neighbours of the undeformed body, kernel gradients that are constants, and their correction.

    g_ij = V_j L_i grad_0 W,  L_i^-1 = M_i = sum V_j (X_j - X_i) grad_0 W

so that any linear map is told exactly (Bonet & Lok 1999, Comput. Methods Appl. Mech. Engrg. 180, 97; Vignjevic et al.
2006, Comput. Model. Eng. Sci. 16, 53). The slope of a link that damage has cut is 0 for good. A particle whose M has so
small a determinant after cuts that its neighbours no longer tell a deformation bears nothing from then on, but its
links stay: were they cut too, the next would be as badly off, and a ring would come apart link by link all round.
Those beside a cut tell another deformation without its links, though nothing has moved: their elastic strain stays as
it was (`keep_strain`), else a cut would make energy (our choice).
"""

from __future__ import annotations

import math

import numpy as np
from numba import prange

from sdph.engine import kernels as smoothing
from sdph.engine.neighbours import Neighbours
from sdph.engine.rows import entry, place
from sdph.engine.state import SOLID
from sdph.laws.compiled import parallel
from sdph.laws.matrices import SINGULAR
from sdph.methods.solids.equations import carried, inverse

# det M below which cuts free a particle, by dimensions: an uncut corner of a square has 0.137 (gel-droplet.md, section
# 2), of a cube 0.021, its edge 0.081
LOOSE = {2: 0.15, 3: 0.023}


class Weights:
    """Rows of neighbours of undeformed bodies and what is constant along them, but for cuts. Particles stand in the
    order of `sorted_by_cell`.

    reference  places (N, 3) [m]; volume (N,) [m^d]; slope, along the entries of the rows: (dW/dr)/r [1/m^(d+2)];
    correction (N, 9) L of each particle; broken (N,) 1 where all its links are cut; free (N,) 1 of these and of those
    that bear nothing
    """

    def __init__(self, kernel, places, volume, body, dimensions: int):
        self.reference, self.volume, self.dimensions = places, volume, dimensions
        self.axes = tuple(np.ascontiguousarray(axis) for axis in places.T)  # X, Y, Z
        near = Neighbours(2.0 * kernel.h, skin=0.0)
        near.built = self.axes[:dimensions]
        self.rows = near.relist(np.full(len(volume), SOLID, np.int8))
        self.slope = np.zeros(len(self.rows.entries))
        _slopes(kernel, places, body, self.rows, self.slope)
        self.free, self.broken = np.zeros((2, len(volume)), np.int8)
        self.torn = np.zeros(len(volume), np.int8)  # 1 of particles that have lost a link
        self.correction, _ = inverses(self._moments(), dimensions, self.free)

    def _moments(self) -> np.ndarray:
        moments = np.zeros((len(self.volume), 9))
        _sum_moments(self.reference, self.volume, self.rows, self.slope, moments)
        return moments

    def cut(self, failed) -> None:
        """Cut the links of the particles `failed` (N,) bool, and free those that this leaves loose."""
        self.broken[failed] = 1
        _cut(self.rows, self.broken, self.slope, self.torn)
        self.correction, weak = inverses(self._moments(), self.dimensions, self.broken)
        self.free[(self.broken != 0) | (weak & (self.torn != 0))] = 1
        self.correction[self.free != 0] = 0.0


@parallel
def _slopes(kernel, places, body, rows, slope):
    """Kernel slopes along the rows; 0 between bodies."""
    for i in prange(len(places)):
        for k in range(rows.number[i]):
            j = entry(rows, i, k)
            r2 = 0.0
            for a in range(3):
                r2 += (places[i, a] - places[j, a]) ** 2
            if body[i] == body[j]:
                slope[place(rows, i, k)] = smoothing.slope(kernel, math.sqrt(r2))


@parallel
def _sum_moments(places, volume, rows, slope, moments):
    """M (N, 9) = -sum V_j slope X_ij X_ij^T."""
    for i in prange(len(places)):
        for k in range(rows.number[i]):
            j = entry(rows, i, k)
            weight = -volume[j] * slope[place(rows, i, k)]
            for a in range(3):
                for b in range(3):
                    moments[i, 3 * a + b] += weight * (places[i, a] - places[j, a]) * (places[i, b] - places[j, b])


@parallel
def _cut(rows, free, slope, torn):
    """Set the slopes of all links of free particles to 0, and mark those that have lost one."""
    for i in prange(len(free)):
        for k in range(rows.number[i]):
            e = place(rows, i, k)
            if slope[e] < 0.0 and (free[i] or free[entry(rows, i, k)]):
                slope[e] = 0.0
                torn[i] = 1


@parallel
def keep_strain(free, last, gradient, unloaded):
    """C_p^-1 (N, 6) for which the elastic strain b_e is as it was, where F (N, 9) was `last` and is `gradient` now:
    F^-1 b_e F^-T."""
    for i in prange(len(gradient)):
        if free[i] == 0:
            b = carried(last[i], unloaded[i])
            _, back = inverse(gradient[i])
            now = carried(back, b)
            for k in range(6):
                unloaded[i, k] = now[k]


def sorted_by_cell(points, reach: float) -> np.ndarray:
    """Order (N,) in which points (N, d) [m] have to stand for rows of neighbours within `reach` [m]."""
    return Neighbours(reach, skin=0.0).sort(tuple(np.ascontiguousarray(axis) for axis in points.T))


def inverses(moments, dimensions: int, free) -> tuple[np.ndarray, np.ndarray]:
    """L (N, 9), 0 of free particles and where M is singular, and (N,) bool where det M is below LOOSE."""
    matrices = moments.reshape(-1, 3, 3).copy()
    if dimensions == 2:
        matrices[:, 2, 2] = 1.0
    determinant = np.linalg.det(matrices)
    kept = (free == 0) & (np.abs(determinant) > SINGULAR)
    found = np.zeros_like(matrices)
    found[kept] = np.linalg.inv(matrices[kept])
    return found.reshape(-1, 9), determinant < LOOSE[dimensions]
