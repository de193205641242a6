"""Smoothing kernels W(r, h) of support 2h, and what they sum to on a lattice.

The pair functions take the normalisation `sigma` [1/m^dims], computed once by `normalisation`, so that inside
the loop they cost their polynomial only. q = r/h throughout.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from sdph.laws.compiled import law
from sdph.laws.constants import TINY

SUPPORT = 2.0  # -, radius of both kernels' support over h


@law
def cubic_spline(r, h, sigma):
    """W [1/m^dims] = sigma {1 - 3/2 q^2 + 3/4 q^3 (q < 1); (2-q)^3/4 (q < 2); 0}. r, h [m].

    M4 spline: Monaghan & Lattanzio 1985, Astron. Astrophys. 149, 135.
    """
    q = r / h
    near, far = 1.0 - q * q * (1.5 - 0.75 * q), max(2.0 - q, 0.0)
    # chosen, not branched to: loops of pairs can be vectorised
    return sigma * (near if q < 1.0 else 0.25 * far * far * far)


@law
def cubic_spline_gradient(r, h, sigma):
    """(dW/dr)/r [1/m^(dims+2)] of the cubic spline: grad_i W = r_ij * this. Finite (-3 sigma/h^2) at r = 0."""
    q = r / h
    far = max(2.0 - q, 0.0)
    outer = -0.75 * far * far / (q + TINY)  # not taken at r = 0
    return sigma / (h * h) * (2.25 * q - 3.0 if q < 1.0 else outer)


@law
def cubic_spline_curvature(r, h, sigma):
    """d2W/dr2 [1/m^(dims+2)] of the cubic spline: sigma/h^2 {4.5 q - 3 (q < 1); 1.5 (2 - q) (q < 2); 0}."""
    q = r / h
    return sigma / (h * h) * (4.5 * q - 3.0 if q < 1.0 else 1.5 * max(2.0 - q, 0.0))


@law
def wendland_c2(r, h, sigma):
    """W [1/m^dims] = sigma (1 - q/2)^4 (1 + 2q) for q < 2. r, h [m].

    phi_{3,1} of Wendland 1995, Adv. Comput. Math. 4, 389; as SPH kernel: Dehnen & Aly 2012, MNRAS 425, 1068, table 1.
    """
    q = r / h
    if q < 2.0:
        return sigma * (1.0 - 0.5 * q) ** 4 * (1.0 + 2.0 * q)
    return 0.0


@law
def wendland_c2_gradient(r, h, sigma):
    """(dW/dr)/r [1/m^(dims+2)] of Wendland C2: -5 sigma/h^2 (1 - q/2)^3. Finite at r = 0."""
    q = r / h
    if q < 2.0:
        return -5.0 * sigma / (h * h) * (1.0 - 0.5 * q) ** 3
    return 0.0


class Kernel(NamedTuple):
    """A kernel: its value and gradient laws, and sigma h^dims for 1, 2 and 3 dimensions."""

    value: Callable[[float, float, float], float]
    gradient: Callable[[float, float, float], float]
    factors: tuple[float, float, float]


KERNELS = {
    "cubic_spline": Kernel(cubic_spline, cubic_spline_gradient, (2.0 / 3.0, 10.0 / (7.0 * math.pi), 1.0 / math.pi)),
    "wendland_c2": Kernel(wendland_c2, wendland_c2_gradient, (0.75, 7.0 / (4.0 * math.pi), 21.0 / (16.0 * math.pi))),
}


def normalisation(kernel: str, dims: int, h: float) -> float:
    """sigma [1/m^dims] with which the kernel named `kernel` integrates to one over its support."""
    return KERNELS[kernel].factors[dims - 1] / h**dims


def _lattice_radii(dims: int, ratio: float) -> np.ndarray:
    """Distances (N,) of the points of a square or cubic lattice, spacing 1, within the support of h = ratio."""
    reach = math.ceil(SUPPORT * ratio)
    points = np.stack(np.meshgrid(*dims * [np.arange(-reach, reach + 1.0)]), axis=-1)
    return np.linalg.norm(points.reshape(-1, dims), axis=1)


def lattice_factor(kernel: str, dims: int, ratio: float) -> float:
    """Sum of W dx^dims [-] over the square or cubic lattice with h/dx = `ratio`: what summed densities are too large
    by."""
    sigma = normalisation(kernel, dims, ratio)
    return math.fsum(KERNELS[kernel].value(r, ratio, sigma) for r in _lattice_radii(dims, ratio))
