"""Small symmetric matrices: linear systems, eigenvalues."""

from __future__ import annotations

import math

from numba import njit

SINGULAR = 1e-3  # determinant of a renormalisation matrix; 1 inside, 0.1-0.5 at a surface; our choice


@njit(cache=True, error_model="numpy")
def solved(xx, yy, zz, xy, yz, zx, gx, gy, gz):
    """Solution of M x = g for a symmetric M; 0 where M is close to singular (a line of particles, or spray)."""
    a, b, c = yy * zz - yz * yz, zx * yz - xy * zz, xy * yz - zx * yy
    determinant = xx * a + xy * b + zx * c
    if determinant < SINGULAR:
        return 0.0, 0.0, 0.0
    e, f, g = xx * zz - zx * zx, zx * xy - xx * yz, xx * yy - xy * xy
    scale = 1.0 / determinant
    return scale * (a * gx + b * gy + c * gz), scale * (b * gx + e * gy + f * gz), scale * (c * gx + f * gy + g * gz)


@njit(cache=True, error_model="numpy")
def smallest(xx, yy, zz, xy, yz, zx):
    """Smallest eigenvalue of a symmetric matrix, by its invariants (Smith 1961, Commun. ACM 4, 168)."""
    mean = (xx + yy + zz) / 3.0
    a, b, c = xx - mean, yy - mean, zz - mean
    spread = math.sqrt((a * a + b * b + c * c + 2.0 * (xy * xy + yz * yz + zx * zx)) / 6.0)
    if spread == 0.0:
        return mean
    half = (a * (b * c - yz * yz) - xy * (xy * c - yz * zx) + zx * (xy * yz - b * zx)) / (2.0 * spread**3)
    angle = math.acos(min(max(half, -1.0), 1.0)) / 3.0
    return mean + 2.0 * spread * math.cos(angle + 2.0 * math.pi / 3.0)
