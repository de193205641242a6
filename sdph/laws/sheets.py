"""Swirling sheets, drops and films in closed form.

A sheet that leaves an annulus of mean radius r_0 and width h_0 at u along its axis and alpha u around it, z from the
mouth. Without tension its particles fly straight.
"""

from __future__ import annotations

import math

import numpy as np
import scipy

from sdph.laws.compiled import law

TORN = 12.0  # ln(eta_b/eta_0) at which a sheet breaks: Dombrowski & Johns 1963; Senecal et al. 1999
BISECTIONS = 12  # of an interval of 1/6: 4e-5 of it, and at a maximum 1e-8 of the growth
STEPS = 4000  # of an integral along a sheet


def ballistic_radius(z, r_0: float, alpha: float):
    """r [m] = sqrt(r_0^2 + (alpha z)^2)."""
    return np.sqrt(r_0**2 + (alpha * np.asarray(z)) ** 2)


def thickness(z, r_0: float, h_0: float, alpha: float):
    """h [m] of the sheet, normal to it, at z [m], by straight flight: h_0 r_0/(r sqrt(1 + (alpha^2 z/r)^2))."""
    r = ballistic_radius(z, r_0, alpha)
    return h_0 * r_0 / (r * np.sqrt(1.0 + (alpha**2 * np.asarray(z) / r) ** 2))


def distance_of_thickness(h: float, r_0: float, h_0: float, alpha: float) -> float:
    """z [m] at which the sheet has thinned to h [m]: `thickness` turned round; inf of one that never thins so far."""
    if h >= h_0:
        return 0.0
    return r_0 * math.sqrt((h_0 / h) ** 2 - 1.0) / (alpha * math.sqrt(1.0 + alpha**2)) if alpha else math.inf


@law
def wave_growth(number, half, speed, density, gas_density, sigma):
    """omega [1/s] of sinuous waves, k = number [1/m], on a sheet of half thickness h [m] that slips at U through gas:
    sqrt((rho_g U^2 k^2 - sigma k^3)/(rho tanh(k h))), 0 where they do not grow.

    Squire 1953, Br. J. Appl. Phys. 4, 167; Dombrowski & Johns 1963, Chem. Eng. Sci. 18, 203, without viscosity, and
    the gas light: rho_g/rho << tanh(k h).
    """
    drive = (gas_density * speed * speed - sigma * number) * number * number
    return math.sqrt(drive / (density * math.tanh(number * half))) if drive > 0.0 else 0.0


@law
def fastest_wave(half, speed, gas_density, sigma):
    """k [1/m] of the wave that grows fastest: from rho_g U^2/(2 sigma) of a thin sheet to 2/3 rho_g U^2/sigma of a
    thick one, as We = rho_g U^2 h/sigma goes from 0 to infinity."""
    unit = gas_density * speed * speed / sigma
    weber, low, high = unit * half, 0.5, 2.0 / 3.0
    for _ in range(BISECTIONS):
        share = 0.5 * (low + high)
        t = math.tanh(share * weber)
        rises = (2.0 - 3.0 * share) * t > share * (1.0 - share) * weber * (1.0 - t * t)
        low, high = (share, high) if rises else (low, share)
    return 0.5 * (low + high) * unit


def suction_length(r_0, h_0, speed, alpha, density, gas_density, sigma) -> float:
    """z [m] at which the sheet breaks by suction of gas at rest: the integral of the fastest growth along the path, as
    the sheet thins, is TORN there (swirl-sheet.md, section 6, b; LISA: Senecal et al. 1999, Int. J. Multiph. Flow 25,
    1073)."""
    slip = speed * math.hypot(1.0, alpha)

    def growth(half):
        k = fastest_wave(half, slip, gas_density, sigma)
        return wave_growth(k, half, slip, density, gas_density, sigma)

    z = np.linspace(0.0, TORN * speed / growth(0.5 * h_0), STEPS + 1)  # it grows ever faster
    rate = np.array([growth(0.5 * h) for h in thickness(z, r_0, h_0, alpha)]) / speed
    total = np.concatenate(([0.0], np.cumsum(0.5 * (rate[1:] + rate[:-1]) * np.diff(z))))
    return float(np.interp(TORN, total, z))


def taylor_culick(sigma: float, density: float, thickness: float) -> float:
    """Speed [m/s] of the rim of a film: sqrt(2 sigma/(rho h)). Taylor 1959, Proc. R. Soc. A 253, 313; Culick 1960."""
    return math.sqrt(2.0 * sigma / (density * thickness))


def rayleigh_plateau(k):
    """Growth [sqrt(sigma/(rho a^3))] of a wave k [1/a] on a thread of radius a: sqrt(k (1 - k^2) I_1(k)/I_0(k)).

    Rayleigh 1878, Proc. London Math. Soc. 10, 4; k below 1.
    """
    return math.sqrt(k * (1.0 - k * k) * scipy.special.iv(1, k) / scipy.special.iv(0, k))


def discharge_coefficient(core):
    """Flow over that of the whole mouth at sqrt(2 dp/rho) [-] of an inviscid pressure-swirl nozzle at its most:
    sqrt((1 - X)^3/(1 + X)), X = core [-] the air core's share of the mouth's area, 0 to 1.

    Abramovich 1944; Taylor 1948, Proc. 7th Int. Congr. Appl. Mech. 2, 280.
    """
    return np.sqrt((1.0 - core) ** 3 / (1.0 + core))


def geometric_characteristic(core):
    """A [-] of the nozzle whose air core has the share X of its mouth: sqrt(2) X/(1 - X)^1.5. Abramovich 1944."""
    return math.sqrt(2.0) * core / (1.0 - core) ** 1.5


def inviscid_half_angle(core):
    """Half angle [rad] of its cone: cos^2 = (1 - X)/(1 + X). Rizk & Lefebvre 1985, J. Propul. Power 1, 193."""
    return np.arccos(np.sqrt((1.0 - core) / (1.0 + core)))


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
