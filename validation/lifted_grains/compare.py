"""Beads in a developed channel against their equation of motion in the exact parabola, with Schiller and Naumann's drag
and Saffman and Mei's lift written out here."""

from __future__ import annotations

import math

import numpy as np
from scipy.integrate import solve_ivp

from sdph.study.compare import check

BEGIN = 0.4  # s; by then the parabola is there, and the beads have forgotten their start; our choice
WAY = 0.01  # of the way across; our choice. The slip follows from the weight alone, the shear is that of the cells
PARABOLA = 0.01  # of the mean velocity, in cells whose parabola is exact but for their count; our choice
ALIKE = 1e-5  # left over right: the gas's equations are solved to a tolerance; our choice


def speed(case, x):
    """Gas [m/s] at x [m] between the plates: 6 U s (1 - s). Bird, Stewart & Lightfoot 2002, Eq. 2B.3-2."""
    share = x / case.domain.size[0]
    return 6.0 * case.boundaries["inlet"].velocity[1] * share * (1.0 - share)


def shear(case, x):
    """Its slope [1/s]."""
    width = case.domain.size[0]
    return 6.0 * case.boundaries["inlet"].velocity[1] * (1.0 - 2.0 * x / width) / width


def acceleration(case, x, u, v):
    """(x, y) [m/s2] of a bead at x [m] with velocity (u, v) [m/s]: weight, C_D = 24/Re (1 + 0.15 Re^0.687) (Schiller &
    Naumann 1933), and 1.615 mu d s sqrt(Re_G) (Saffman 1965) times Mei's factor (1992), Re < 40, across the slip."""
    d, rho, gas, mu = case.grains.diameter, case.grains.density, case.gas.density, case.gas.viscosity
    du, dv, rate = -u, speed(case, x) - v, shear(case, x)
    slip = math.hypot(du, dv)
    reynolds, of_shear = gas * d * slip / mu, gas * d * d * abs(rate) / mu
    mass = rho * math.pi / 6.0 * d**3
    drag = 3.0 * math.pi * mu * d * (1.0 + 0.15 * reynolds**0.687) / mass
    part = 0.3314 * math.sqrt(0.5 * of_shear / reynolds)
    factor = (1.0 - part) * math.exp(-reynolds / 10.0) + part
    lift = 1.615 * mu * d * math.sqrt(of_shear) * factor / mass * math.copysign(1.0, rate)
    buoyant = case.domain.gravity[1] * (1.0 - gas / rho)
    return drag * du + lift * dv, drag * dv - lift * du + buoyant


def exact(run) -> list[dict]:
    """Ways of all beads from BEGIN on, and the gas then."""
    case = run.case
    (begin, first, gas), (end, last, _) = run.fields(BEGIN), run.fields(case.run.end_time)
    order = np.argsort(first["ident"]), np.argsort(last["ident"])
    before, after = (np.asarray(c.points)[o, 0] for c, o in zip((first, last), order))
    velocity = np.asarray(first["velocity"])[order[0]]
    expected = np.array([_way(case, x, *uv[:2], end - begin) for x, uv in zip(before, velocity)])
    inside = np.where(before < 0.5 * case.domain.size[0], 1.0, -1.0)
    way, asked = inside * (after - before), inside * expected
    middles = np.asarray(gas.cell_centers().points)
    beside = abs(middles[:, 1] - 0.5 * case.domain.size[1]) < case.resolution.cell
    off = abs(np.asarray(gas.cell_data["velocity"])[beside, 1] - speed(case, middles[beside, 0])).max()
    return [
        check("way towards the middle, mean of the beads [mm]", 1e3 * way.mean(), 1e3 * asked.mean(), WAY, True),
        check("way of a bead, worst over the mean", abs(way - asked).max() / asked.mean(), 0.0, 2.0 * WAY),
        check("left and right alike", way[inside > 0].mean() / way[inside < 0].mean(), 1.0, ALIKE),
        check("gas half way up, worst over the mean", off / case.boundaries["inlet"].velocity[1], 0.0, PARABOLA),
    ]


def _way(case, x, u, v, time) -> float:
    """Way across [m] of a bead in `time` [s]."""
    path = solve_ivp(lambda t, s: (s[1], *acceleration(case, *s)), (0.0, time), (x, u, v), rtol=1e-9, atol=1e-12)
    return path.y[0, -1] - x
