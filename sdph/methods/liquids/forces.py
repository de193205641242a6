"""What the loops over liquids share: separations, acceleration from outside, small symmetric matrices."""

from __future__ import annotations

import numpy as np
from numba import njit

from sdph.effects.around import frame, gravity
from sdph.engine.rows import deep, nearest_image

# Sums may be reordered and vectorised; nan and inf keep their meaning, so that a run that bursts is noticed.
FAST = {"reassoc", "nsz", "arcp", "contract", "afn"}
SINGULAR = 1e-3  # determinant of a renormalisation matrix; 1 inside, 0.1-0.5 at a surface; our choice


@njit(cache=True, error_model="numpy")
def apart(s, box, i, j):
    """r_i - r_j (3 components; the last 0 in two dimensions), through periodic boundaries."""
    dz = s.z[i] - s.z[j] if deep(box) else 0.0
    return nearest_image(box, s.x[i] - s.x[j], s.y[i] - s.y[j], dz)


@njit(cache=True, error_model="numpy")
def faster(s, box, i, j):
    """v_i - v_j (3 components; the last 0 in two dimensions)."""
    return s.u[i] - s.u[j], s.v[i] - s.v[j], s.w[i] - s.w[j] if deep(box) else 0.0


@njit(cache=True, error_model="numpy")
def held_off(wall_p, signed, rho, r):
    """Pressure [Pa] by which a wall particle holds off liquid of density rho that came nearer to it than it stands at rest.

    rho c^2 (1 - r/near), our choice. The wall's other pressure is extrapolated from the liquid around: it knows nothing of
    a particle that came closer than the rest, and what got in among the particles of a wall would lie there at rest.
    """
    over = rho * wall_p.stiffness * max(1.0 - r * wall_p.near, 0.0)
    return 0.0 if signed > 0.0 else over


@njit(cache=True, error_model="numpy")
def body(gravity_p, frame_p, s, i, still):
    """Acceleration [m/s2] from outside of particle i, or at its place of what stands `still` in the frame."""
    gx, gy, gz = gravity.acceleration(gravity_p)
    z = s.z[i] if len(s.z) else 0.0
    w = s.w[i] if len(s.z) else 0.0
    moving = 0.0 if still else 1.0
    fx, fy, fz = frame.acceleration(frame_p, s.x[i], s.y[i], z, moving * s.u[i], moving * s.v[i], moving * w)
    return gx + fx, gy + fy, gz + fz


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
    spread = np.sqrt((a * a + b * b + c * c + 2.0 * (xy * xy + yz * yz + zx * zx)) / 6.0)
    if spread == 0.0:
        return mean
    half = (a * (b * c - yz * yz) - xy * (xy * c - yz * zx) + zx * (xy * yz - b * zx)) / (2.0 * spread**3)
    angle = np.arccos(min(max(half, -1.0), 1.0)) / 3.0
    return mean + 2.0 * spread * np.cos(angle + 2.0 * np.pi / 3.0)
