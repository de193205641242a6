"""Exact shock tube of gas with dust that follows it at once. Plain Python, not compiled."""

from __future__ import annotations

import math
from typing import NamedTuple


class Shock(NamedTuple):
    """Between the waves: pressure [Pa], velocity [m/s], gas densities left and right of the contact [kg/m3]; the
    speed of the right shock [m/s]."""

    pressure: float
    velocity: float
    density_left: float
    density_right: float
    shock_speed: float


def _wave_velocity(p_star: float, rho: float, p: float, gamma: float) -> float:
    """Change of velocity [m/s] across a shock or rarefaction from (rho, p) to p_star. Toro 2009, Eqs. (4.6), (4.7)."""
    if p_star > p:
        return (p_star - p) * math.sqrt(2.0 / rho / ((gamma + 1.0) * p_star + (gamma - 1.0) * p))
    sound = math.sqrt(gamma * p / rho)
    return 2.0 * sound / (gamma - 1.0) * ((p_star / p) ** (0.5 * (gamma - 1.0) / gamma) - 1.0)


def dusty_shock_tube(left: tuple[float, float], right: tuple[float, float], gamma: float, loading: float) -> Shock:
    """Gas at rest, (density, pressure) left > right, with dust of `loading` = rho_d/rho_g that follows it at once and
    takes no heat: an exact Riemann problem of density rho_g (1 + loading), rarefaction left, shock right.

    Toro 2009, Riemann Solvers and Numerical Methods for Fluid Dynamics, ch. 4.
    """
    (rho_l, p_l), (rho_r, p_r) = left, right
    mass = 1.0 + loading

    def jump(p):
        return _wave_velocity(p, rho_l * mass, p_l, gamma) + _wave_velocity(p, rho_r * mass, p_r, gamma)

    from scipy.optimize import brentq  # takes longer to import than most of what calls this file

    p = brentq(jump, p_r, p_l, xtol=1e-15, rtol=1e-15)
    ratio, mu2 = p / p_r, (gamma - 1.0) / (gamma + 1.0)
    sound = math.sqrt(gamma * p_r / (rho_r * mass))
    speed = sound * math.sqrt(0.5 * ((gamma + 1.0) * ratio + gamma - 1.0) / gamma)
    velocity = _wave_velocity(p, rho_r * mass, p_r, gamma)
    return Shock(p, velocity, rho_l * (p / p_l) ** (1.0 / gamma), rho_r * (ratio + mu2) / (mu2 * ratio + 1.0), speed)
