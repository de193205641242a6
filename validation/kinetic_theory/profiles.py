"""Steady flow of agitated grains between two walls as the closures have it: ODEs across the lower half, by scipy.

    du/dy = tau/mu,  dtheta/dy = q/k_theta,  dq/dy = gamma - tau du/dy,  dm/dy = alpha_p,  p_s(alpha_p, theta) = p

q is the heat that goes down in y [W/m2], m the volume of grains below y [m]. In the middle q = 0. tau is even in
Couette flow and rho_p g times the grains between y and the middle in Poiseuille flow.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_bvp

from sdph.laws import friction, granular

from . import boxes

POINTS = np.linspace(0.0, 1.0, 201)  # of the half, to begin with; solve_bvp adds what it needs
TIGHT = 1e-6  # relative, of solve_bvp
SHARES = np.linspace(1e-4, boxes.PACKING - 0.01, 4000)  # alpha_p of the table that p_s is inverted with


class Flow(NamedTuple):
    """Height of the gap, mean alpha_p, grain diameter [m]; speed of the upper wall less half of the lower's [m/s] and
    its specularity, or the pull of gravity along the walls [m/s2], which then grip without slip."""

    height: float
    share: float
    diameter: float
    wall: float = 0.0
    specularity: float = 0.0
    gravity: float = 0.0


class Profile(NamedTuple):
    """u [m/s], theta [m2/s2], alpha_p [-] at y (N,) [m]; p [Pa], tau on the wall [Pa]."""

    u: np.ndarray
    theta: np.ndarray
    share: np.ndarray
    pressure: float
    stress: float


def solved(flow: Flow, y) -> Profile:
    """The profile at y (N,) [m]."""
    half = 0.5 * flow.height
    rate = 2.0 * flow.wall / flow.height or _rate_of_gravity(flow)
    theta = boxes.steady_theta(flow.share, rate, flow.diameter)
    p = granular.lun_pressure(flow.share, theta, boxes.RESTITUTION, boxes.g0(flow.share), boxes.DENSITY)
    x, ones = POINTS * half, np.ones_like(POINTS)
    u = rate * (x - half) if flow.wall else rate * x
    begun = np.stack([u, theta * ones, 0.0 * x, flow.share * x])
    guess = [p, 0.3 * p] if flow.wall else [p]  # tau/p of uniform shear is about 0.3
    found = solve_bvp(
        lambda x, v, q: _slopes(flow, v, q), lambda a, b, q: _ends(flow, a, b, q), x, begun, guess, tol=TIGHT,
        max_nodes=100000,
    )  # fmt: skip
    if not found.success:
        raise ArithmeticError(f"the profile of {flow} was not found: {found.message}")
    y, above = np.minimum(y, flow.height - y), y > half
    values = found.sol(y)
    sign = np.where(above, -1.0, 1.0) if flow.wall else 1.0
    on_wall = found.p[1] if flow.wall else 0.5 * boxes.DENSITY * flow.gravity * flow.share * flow.height
    return Profile(sign * values[0], values[1], packed(found.p[0], values[1]), found.p[0], on_wall)


def _rate_of_gravity(flow: Flow) -> float:
    """Shear rate [1/s] that has half of the stress on the wall: the stress of steady shear grows by its square."""
    theta = boxes.steady_theta(flow.share, 1.0, flow.diameter)
    mu = granular.gidaspow_viscosity(
        flow.share, theta, boxes.RESTITUTION, boxes.g0(flow.share), boxes.DENSITY, flow.diameter
    )
    return math.sqrt(0.25 * boxes.DENSITY * flow.gravity * flow.share * flow.height / mu)


def packed(pressure, theta):
    """alpha_p at which agitated grains have a pressure [Pa]."""
    table = [granular.lun_pressure(a, 1.0, boxes.RESTITUTION, boxes.g0(a), 1.0) for a in SHARES]
    return np.interp(pressure / (boxes.DENSITY * theta), table, SHARES)


def _slopes(flow: Flow, values, unknown):
    """d/dy of u, theta, q, m (4, N)."""
    _, theta, q, below = values
    theta = np.abs(theta)  # on the way to the solution it may pass below 0
    share = packed(unknown[0], theta)
    tau = unknown[1] if flow.wall else boxes.DENSITY * flow.gravity * (0.5 * flow.share * flow.height - below)
    laws = np.array([_closures(flow, a, t) for a, t in zip(share, theta)]).T
    return np.stack([tau / laws[0], q / laws[1], laws[2] - tau**2 / laws[0], share])


def _closures(flow: Flow, share: float, theta: float) -> tuple[float, float, float]:
    """mu [Pa s], k_theta [kg/m/s], gamma [W/m3]."""
    own = (share, theta, boxes.RESTITUTION, boxes.g0(share), boxes.DENSITY, flow.diameter)
    return granular.gidaspow_viscosity(*own), granular.gidaspow_conductivity(*own), granular.lun_dissipation(*own)


def _ends(flow: Flow, wall, middle, unknown):
    """Residuals (5,) or (6,) at the wall and in the middle; slip along the wall heats the grains."""
    ends = [middle[2], wall[3], middle[3] - 0.5 * flow.share * flow.height]
    if not flow.wall:
        return np.array([*ends, wall[0], wall[2]])
    theta, slip = abs(wall[1]), wall[0] + flow.wall
    share = float(packed(unknown[0], theta))
    k = friction.johnson_jackson_wall(flow.specularity, share, theta, boxes.g0(share), boxes.DENSITY, boxes.PACKING)
    return np.array([*ends, middle[0], k * slip - unknown[1], wall[2] + unknown[1] * slip])
