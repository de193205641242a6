"""Swirling sheets, drops and films in closed form.

A sheet that leaves an annulus of mean radius r_0 and width h_0 at u along its axis and alpha u around it, z from the
mouth. Without tension its particles fly straight.
"""

from __future__ import annotations

import math

import numpy as np


def ballistic_radius(z, r_0: float, alpha: float):
    """r [m] = sqrt(r_0^2 + (alpha z)^2)."""
    return np.sqrt(r_0**2 + (alpha * np.asarray(z)) ** 2)


def taylor_culick(sigma: float, density: float, thickness: float) -> float:
    """Speed [m/s] of the rim of a film: sqrt(2 sigma/(rho h)). Taylor 1959, Proc. R. Soc. A 253, 313; Culick 1960."""
    return math.sqrt(2.0 * sigma / (density * thickness))


def diameter_of(volume, dimensions: int):
    """Diameter [m] of a sphere, or of a disc in two dimensions, of a volume [m^d]."""
    return (6.0 / math.pi * volume) ** (1.0 / 3.0) if dimensions == 3 else (4.0 / math.pi * volume) ** 0.5


def han_length(density, sigma, width, half_angle, gas_density, speed, ratio=12.0, factor=3.0) -> float:
    """Break-up length [m] B sqrt(rho sigma ln(eta_b/eta_0) h cos(theta))/(rho_g U), B = 3, ln = 12.

    Han, Parrish, Farrell & Reitz 1997, Atomization Sprays 7, 663; angle [rad], U [m/s] of sheet to gas.
    """
    return factor * math.sqrt(density * sigma * ratio * width * math.cos(half_angle)) / (gas_density * speed)


def meridian(ends, r_0: float, h_0: float, speed: float, alpha: float, density: float, sigma: float, steps=4000):
    """Radius [m] and half angle [rad] (n,) at distances `ends` (n,) [m] along the axis of a sheet with tension:

    d psi/ds = (cos psi/r)(rho h v_t^2 - 2 sigma)/(rho h v_m^2 - 2 sigma), psi(0) = 0, with r v_t, v_m^2 + v_t^2 and
    r h v_m constant (swirl-sheet.md, section 5; after Taylor 1959). Runge & Kutta's fourth order in s.
    """

    def slope(y):
        r, _, psi = y
        turning = alpha * speed * r_0 / r
        along = math.sqrt(speed**2 * (1.0 + alpha**2) - turning**2)
        heavy = density * h_0 * r_0 * speed / (r * along)  # rho h
        bend = (heavy * turning**2 - 2.0 * sigma) / (heavy * along**2 - 2.0 * sigma)
        return np.array([math.sin(psi), math.cos(psi), math.cos(psi) / r * bend])

    step = 2.0 * float(np.max(ends)) / steps
    path = [np.array([r_0, 0.0, 0.0])]
    while path[-1][1] < np.max(ends):
        y = path[-1]
        a = slope(y)
        b = slope(y + 0.5 * step * a)
        c = slope(y + 0.5 * step * b)
        path.append(y + step / 6.0 * (a + 2.0 * b + 2.0 * c + slope(y + step * c)))
    r, z, psi = np.array(path).T
    return np.interp(ends, z, r), np.interp(ends, z, psi)
