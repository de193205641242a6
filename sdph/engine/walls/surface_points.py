"""Points on a surface of any form moved along it until they lie evenly."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from sdph.laws import kernels

ROUNDS = 8  # from lattice points moved onto a sphere, 0.2 to 0.5 spacings apart at least, to 0.73 or more; 16 come no further; our choice
WIDTH = 1.5  # h over the spacing: the default of resolution.smoothing_ratio


def even_out(points, spacing: float, onto) -> np.ndarray:
    """(N, 3) after ROUNDS of r -= h^2/2 grad C, then `onto`(points) the surface; C the kernel's sum over points of area spacing^2.

    The coefficient is the largest stable one: Lind, Xu, Stansby & Rogers 2012, J. Comput. Phys. 231, 1499.
    """
    h = WIDTH * spacing
    for _ in range(ROUNDS):
        i, j = cKDTree(points).query_pairs(kernels.SUPPORT * h, output_type="ndarray").T
        apart = points[i] - points[j]
        slope = -5.0 * kernels.normalisation("wendland_c2", 2, h) / h**2 * (1.0 - 0.5 / h * np.linalg.norm(apart, axis=1)) ** 3
        rise, moved = spacing**2 * slope[:, None] * apart, points.copy()
        np.add.at(moved, i, -0.5 * h**2 * rise)
        np.add.at(moved, j, 0.5 * h**2 * rise)
        points = onto(moved)
    return points
