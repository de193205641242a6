"""Smoothing kernels as the loops over liquids take them: two types, told apart by length when a loop is compiled.

Branch-free forms of the laws in `sdph.laws.kernels`, so that the loop over neighbours can be vectorised.
"""

from __future__ import annotations

from typing import NamedTuple

from sdph.laws import kernels
from sdph.laws.compiled import serial
from sdph.laws.constants import TINY


class Cubic(NamedTuple):
    """Cubic spline: h [m], 1/h, factor of W [1/m^d], factor of (dW/dr)/r [1/m^(d+2)]."""

    h: float
    inverse: float
    value: float
    slope: float


class Wendland(NamedTuple):
    """Wendland C2: the same and half of 1/h."""

    h: float
    inverse: float
    value: float
    slope: float
    half: float


NAMES = ("wendland_c2", "cubic_spline")


def smoothing(name: str, dimensions: int, h: float) -> Cubic | Wendland:
    """The kernel called `name` with smoothing length h [m]."""
    sigma = kernels.normalisation(name, dimensions, h)
    if name == "cubic_spline":
        return Cubic(h, 1.0 / h, 0.25 * sigma, -0.75 * sigma / h**2)
    return Wendland(h, 1.0 / h, sigma, -5.0 * sigma / h**2, 0.5 / h)


@serial
def value(kernel, r):
    """W [1/m^d]."""
    if len(kernel) == 5:
        a = max(0.0, 1.0 - kernel.half * r)
        return kernel.value * (a * a) * (a * a) * (1.0 + 4.0 * kernel.half * r)
    q = kernel.inverse * r
    a, b = max(0.0, 2.0 - q), max(0.0, 1.0 - q)
    return kernel.value * (a * a * a - 4.0 * b * b * b)


@serial
def slope(kernel, r):
    """(dW/dr)/r [1/m^(d+2)]: grad_i W = r_ij * this."""
    if len(kernel) == 5:
        a = max(0.0, 1.0 - kernel.half * r)
        return kernel.slope * a * a * a
    q = kernel.inverse * r
    a, b = max(0.0, 2.0 - q), max(0.0, 1.0 - q)
    return kernel.slope * (a * a - 4.0 * b * b) / (q + TINY)
