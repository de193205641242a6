"""The equations of the particles: loops over neighbours, one signed term per line.

Each term belongs to an effect (`sdph/effects/`) and takes that effect's parameters first; with `OFF` the compiler
drops it. Sums are local and written once.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit, prange

from sdph.effects import conduction
from sdph.laws import kernels
from sdph.neighbours import nearest_image


class Kernel(NamedTuple):
    """Cubic spline: h [m], sigma [1/m^d], divided by the lattice sum so that a perfect lattice has its own density."""

    h: float
    sigma: float


def kernel_of(case) -> Kernel:
    """Kernel of a case. The correction by the lattice sum (+0.344 % at h = 1.5 dx in 2-D) is our choice."""
    lattice = kernels.lattice_factor("cubic_spline", case.dimensions, case.resolution.smoothing_ratio)
    sigma = kernels.normalisation("cubic_spline", case.dimensions, case.smoothing_length)
    return Kernel(case.smoothing_length, sigma / lattice)


@njit(cache=True, error_model="numpy")
def separation(s, box, i, j):
    """r_i - r_j (3 components; the last 0 in two dimensions) through periodic boundaries, and its square."""
    dz = s.z[i] - s.z[j] if len(s.z) else 0.0
    dx, dy, dz = nearest_image(box, s.x[i] - s.x[j], s.y[i] - s.y[j], dz)
    return dx, dy, dz, dx * dx + dy * dy + dz * dz


# Outputs are arguments of their own: numba drops writes to arrays of a tuple inside a prange without a word.


@njit(cache=True, parallel=True, error_model="numpy", fastmath={"nsz"})
def sum_density(kernel, s, rows, box, density):
    """rho_i = sum m_j W_ij, i itself included (Eq. 25): alpha_p rho_p."""
    for i in prange(len(s.x)):
        rho = s.mass[i] * kernels.cubic_spline(0.0, kernel.h, kernel.sigma)
        for k in range(rows.count[i]):
            j = rows.index[i, k]
            r2 = separation(s, box, i, j)[3]
            rho += s.mass[j] * kernels.cubic_spline(np.sqrt(r2), kernel.h, kernel.sigma)
        density[i] = rho


@njit(cache=True, parallel=True, error_model="numpy", fastmath={"nsz"})
def rates(kernel, s, rows, box, conduction_p, heating):
    """Right-hand sides of all particles: heating (N,) [W/kg]."""
    for i in prange(len(s.x)):
        heat = 0.0
        for k in range(rows.count[i]):
            j = rows.index[i, k]
            dx, dy, dz, r2 = separation(s, box, i, j)
            gradient = kernels.cubic_spline_gradient(np.sqrt(r2), kernel.h, kernel.sigma)
            heat += conduction.pair(conduction_p, s, i, j, r2, gradient)
        heating[i] = heat
