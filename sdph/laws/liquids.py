"""Exact flows of an incompressible liquid, for starts and checks. Plain Python, not compiled."""

from __future__ import annotations

import math

import numpy as np
import scipy

from sdph.laws.constants import TINY

TERMS = 99  # odd terms of the series up to this one: 1e-5 of the pressure in the centre


def square_patch_pressure(points, side: float, omega: float, density: float) -> np.ndarray:
    """p (N,) [Pa] of a square of liquid that begins to turn like a solid, free surface all round; points from its
    corner.

    Colicchio 2004; Le Touze et al. 2013, Int. J. Numer. Methods Fluids 73, 660, Eq. 22:
    p = rho sum_mn -32 w^2/(m n pi^2 [(n pi/L)^2 + (m pi/L)^2]) sin(m pi x/L) sin(n pi y/L), m, n odd.
    """
    odd = np.arange(1, TERMS + 1, 2)
    sine = [np.sin(np.pi / side * np.outer(points[:, a], odd)) for a in (0, 1)]
    m, n = odd[:, None], odd[None, :]
    factor = -32.0 * omega**2 / (m * n * math.pi**2 * ((n * math.pi / side) ** 2 + (m * math.pi / side) ** 2))
    return density * np.einsum("pm,mn,pn->p", sine[0], factor, sine[1], optimize=True)


def taylor_green(points, length: float, speed: float, density: float) -> tuple[np.ndarray, np.ndarray]:
    """(velocity (N, 2) [m/s], pressure (N,) [Pa]) of vortices of amplitude `speed` in a periodic square."""
    k = 2.0 * math.pi / length
    x, y = k * points[:, 0], k * points[:, 1]
    velocity = speed * np.stack([-np.cos(x) * np.sin(y), np.sin(x) * np.cos(y)], axis=1)
    return velocity, -0.25 * density * speed**2 * (np.cos(2.0 * x) + np.cos(2.0 * y))


def taylor_green_decay(time: float, length: float, viscosity: float) -> float:
    """Velocity over its start: exp(-2 nu k^2 t), viscosity nu [m2/s]."""
    return math.exp(-2.0 * viscosity * (2.0 * math.pi / length) ** 2 * time)


def poiseuille(y, time: float, height: float, force: float, viscosity: float, terms: int = 50) -> np.ndarray:
    """u (N,) [m/s] between plates at y = 0 and `height`, driven by `force` [m/s2] from rest; viscosity nu [m2/s].

    Morris, Fox & Zhu 1997, J. Comput. Phys. 136, 214, Eq. 29.
    """
    y = np.asarray(y, float)
    u = force / (2.0 * viscosity) * y * (height - y)
    for n in range(terms):
        k = (2 * n + 1) * math.pi / height
        u -= 4.0 * force / (viscosity * height * k**3) * np.sin(k * y) * math.exp(-viscosity * k**2 * time)
    return u


def quadrupole(points, radius: float, speed: float) -> np.ndarray:
    """(N, 2) velocity [m/s] of a disc about the origin that begins to become an ellipse, and of what is around it.

    Potential flow of r^2 cos 2 theta inside and r^-2 cos 2 theta outside; `speed` is the radial one at the rim on the
    x axis. Lamb 1932, Hydrodynamics, section 275.
    """
    r2 = np.maximum((points**2).sum(axis=1), TINY)
    inside = r2 <= radius**2
    double = np.where(inside, 0.0, 2.0 * np.arctan2(points[:, 1], points[:, 0]))
    fall = np.where(inside, 0.0, (radius**2 / r2) ** 1.5)
    radial, turning = fall * np.cos(double), fall * np.sin(double)
    direction = points / np.sqrt(r2)[:, None]
    outside = np.stack(
        [radial * direction[:, 0] - turning * direction[:, 1], radial * direction[:, 1] + turning * direction[:, 0]],
        axis=1,
    )
    return speed * np.where(inside[:, None], points / radius * np.array([1.0, -1.0]), outside)


def disc_frequency(order: int, radius: float, tension: float, density: float, around: float = 0.0) -> float:
    """omega [rad/s] of a disc of liquid in another one: sqrt(n (n^2 - 1) sigma/((rho + rho_around) R^3)). Lamb 1932,
    section 273."""
    return math.sqrt(order * (order**2 - 1) * tension / ((density + around) * radius**3))


def wave(points, length: float, amplitude: float) -> np.ndarray:
    """(N, 2) potential flow of a standing wave of `length` [m] on the level y = 0 between two liquids, of which each is
    deep; `amplitude` is the vertical one at x = 0, y = 0 and gives the unit. Lamb 1932, section 231."""
    k, above = 2.0 * math.pi / length, points[:, 1] > 0.0
    fall = amplitude * np.exp(-k * np.abs(points[:, 1]))
    across = np.where(above, fall, -fall) * np.sin(k * points[:, 0])
    return np.stack([across, fall * np.cos(k * points[:, 0])], axis=1)


def capillary_wave(time, length: float, tension: float, density: float, around: float, viscosity: float) -> np.ndarray:
    """Height (T,) over that at the start, from rest, of a small wave of `length` [m] between two liquids of one
    kinematic viscosity [m2/s]; density and around [kg/m3]. Prosperetti 1981, Phys. Fluids 24, 1217, Eq. 24.

    erfc(z sqrt t) exp(z^2 t) = w(i z sqrt t), the function of Faddeeva, which does not overflow.
    """
    time, k = np.asarray(time, float), 2.0 * math.pi / length
    square, decay = tension * k**3 / (density + around), viscosity * k * k  # of the frequency [1/s2]; nu k2 [1/s]
    beta = density * around / (density + around) ** 2
    steady = (1.0 - 4.0 * beta) * decay**2
    roots = np.roots(
        [1.0, -4.0 * beta * decay**0.5, 2.0 * (1.0 - 6.0 * beta) * decay, 4.0 * (1.0 - 3.0 * beta) * decay**1.5,
         steady + square]
    )  # fmt: skip
    height = 4.0 * steady / (8.0 * steady + square) * scipy.special.erfc(np.sqrt(decay * time)) + 0.0j
    for n, z in enumerate(roots):
        share = square * z / (np.prod(np.delete(roots, n) - z) * (z * z - decay))
        height += share * np.exp(-decay * time) * scipy.special.wofz(1j * z * np.sqrt(time))
    return height.real


def box_slosh(length: float, depth: float, gravity: float) -> float:
    """omega [rad/s] of the first antisymmetric mode in a box: sqrt(g k tanh(k h)), k = pi/L. NASA SP-106."""
    k = math.pi / length
    return math.sqrt(gravity * k * math.tanh(k * depth))
