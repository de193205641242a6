"""Exact solutions of solids: rings under pressure, a plate that swings, a wall that holds water back. Plain Python."""

from __future__ import annotations

import math

import numpy as np

ROUNDS = 50  # of an iteration whose error falls by far more than ten each time
CANTILEVER = 1.875104068711961  # k L of the first mode of a beam held at one end: cos(kL) cosh(kL) = -1


def lame_ring(r, pressure: float, inner: float, outer: float, youngs: float, poisson: float):
    """(hoop stress [Pa], radial displacement [m]) at r [m] of a ring under pressure [Pa] inside, plane strain.

    p ri^2/(ro^2 - ri^2) (1 + ro^2/r^2); (1 + nu)/E p ri^2/(ro^2 - ri^2) [(1 - 2 nu) r + ro^2/r]. Lame 1852;
    Timoshenko & Goodier 1951, section 28.
    """
    share = pressure * inner**2 / (outer**2 - inner**2)
    along = (1.0 - 2.0 * poisson) * r + outer**2 / r
    return share * (1.0 + outer**2 / r**2), (1.0 + poisson) / youngs * share * along


def ring_period(
    radius: float, thickness: float, youngs: float, poisson: float, density: float, inside: float = 0.0
) -> float:
    """T [s] of a thin ring that breathes, plane strain, with a mass by area [kg/m2] inside that moves along:
    w^2 = E/(1 - nu^2) H/(R^2 (rho H + m)). Lengths [m], E [Pa], rho [kg/m3]; Love 1927, section 306."""
    heavy = density * thickness + inside
    return 2.0 * math.pi * radius * math.sqrt(heavy * (1.0 - poisson**2) / (youngs * thickness))


def ring_pressure(radius: float, thickness: float, youngs: float, poisson: float) -> float:
    """Largest pressure [Pa] that a thin elastic ring bears, plane strain: p = E/(1 - nu^2) H/(2 e R).

    Hooke's law of the logarithmic strain, Kirchhoff's stress tau = E/(1 - nu^2) ln L at L times its radius R: p =
    tau/L^2 H/R is largest at L = sqrt(e). Lengths [m], E [Pa]; a thick one, R its middle, bears up to 11 % more.
    """
    return youngs / (1.0 - poisson**2) * thickness / (2.0 * math.e * radius)


def ring_swing(rise: float, period: float) -> float:
    """Share [-] of a load by which what swings with a period T [s] goes on to swing after a rise 3 s^2 - 2 s^3 in
    a time t_r [s]: 12 sqrt(4 + w^2)/w^3, w = 2 pi t_r/T, above 1 where it swings by all.

    Envelope of |integral of 6 s (1 - s) exp(i w s) over s from 0 to 1|, the residual of a swing without damping.
    """
    w = 2.0 * math.pi * rise / period
    return 12.0 * math.hypot(2.0, w) / w**3 if w else math.inf


def cantilever(along):
    """Deflection [-] of the first mode of a thin plate at x/L, 1 at the free end. Landau & Lifshitz, Theory of
    Elasticity, section 25."""
    k = CANTILEVER
    ratio = (math.cos(k) + math.cosh(k)) / (math.sin(k) + math.sinh(k))

    def shape(x):
        return np.cosh(k * x) - np.cos(k * x) - ratio * (np.sinh(k * x) - np.sin(k * x))

    return shape(along) / shape(1.0)


def cantilever_period(length: float, thickness: float, youngs: float, poisson: float, density: float) -> float:
    """T [s] of that mode: w^2 = E H^2 k^4/(12 rho (1 - nu^2)), k L = 1.8751. Lengths [m], E [Pa], rho [kg/m3]."""
    k = CANTILEVER / length
    return 2.0 * math.pi / math.sqrt(youngs * thickness**2 * k**4 / (12.0 * density * (1.0 - poisson**2)))


def dam_deflection(
    depth: float, height: float, thickness: float, youngs: float, poisson: float, weight: float
) -> float:
    """Deflection [m] at the top of a wall held at its foot, of a height [m], behind it a liquid of a depth [m].

    w = q d^4/(30 D) + q d^3/(24 D) (L - d) + q d^2/(6 k G H), load q = rho g d at the foot and 0 at the surface, weight
    rho g [N/m3], D = E H^3/(12 (1 - nu^2)), k = 5/6: Timoshenko, Strength of Materials I, sections 40 and 46.
    """
    bending = youngs * thickness**3 / (12.0 * (1.0 - poisson**2))
    shear, load = youngs / (2.0 * (1.0 + poisson)), weight * depth
    by_shear = load * depth**2 / (5.0 * shear * thickness)
    return load * depth**4 / (30.0 * bending) + load * depth**3 / (24.0 * bending) * (height - depth) + by_shear


def dammed_depth(filled: float, width: float, thickness: float, youngs: float, poisson: float, weight: float) -> float:
    """Depth [m] of a liquid behind that wall that stood `filled` [m] deep over a width [m] before it gave way.

    The wall makes room for q d^4/(72 D) d: integral of its deflection over the depth, by bending. Found by iteration.
    """
    bending, depth = youngs * thickness**3 / (12.0 * (1.0 - poisson**2)), filled
    for _ in range(ROUNDS):
        depth = filled - weight * depth**6 / (72.0 * bending * width)
    return depth
