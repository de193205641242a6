"""Drops in two dimensions: the period of a small oscillation after Lamb, and sigma/R of pressure in drops at rest."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from sdph.engine import state as particles
from sdph.laws import liquids
from sdph.study.compare import check

from . import free

RADIUS, RADII, REACH = 10, (10, 14, 20), 4.1  # l0
AMPLITUDES = (0.1, 0.3)  # of R, by which it would swing undamped: small ones ring like solids (swirl-sheet.md, 5)
PERIOD, SLOPE = 0.05, 0.2  # issue 21
SWINGS, RESTING = 1.5, 2.0  # periods that are looked at; drops rest for so many before their pressure is told


def checks(folder: Path, *_, radii=RADII) -> list[dict]:
    slope, own = laplace(radii)
    return [
        *(
            check(f"drop, R = {RADIUS} l0, amplitude {a:g} R: period over Lamb's", period(RADIUS, a), 1.0, PERIOD)
            for a in AMPLITUDES
        ),
        check(f"drops, R = {', '.join(map(str, radii))} l0: slope of the pressure in 1/R / sigma", slope, 1.0, SLOPE),
        *(check(f"drop, R = {n} l0: pressure over sigma/R, reported", p, 1.0, math.inf) for n, p in zip(radii, own)),
    ]


def drop(radius: int):
    """A stepper of a drop of `radius` spacings about (0, 0) of the domain's middle [m], and that middle."""
    R = radius * free.SPACING
    pool = {"shape": "disc", "centre_m": [2.0 * R] * 2, "radius_m": R}
    return free.body(pool, [4.0 * R] * 2, REACH), 2.0 * R


def lamb(radius: int) -> float:
    """Period [s] of the gravest mode of a disc of liquid without surroundings."""
    return 2.0 * math.pi / liquids.disc_frequency(2, radius * free.SPACING, free.SIGMA, free.DENSITY)


def period(radius: int, amplitude: float) -> float:
    """Period over Lamb's: twice the time between zeros of the difference of the moments of inertia."""
    stepper, middle = drop(radius)
    s, omega = stepper.state, 2.0 * math.pi / lamb(radius)
    s.u[:], s.v[:] = amplitude * omega * (s.x - middle), -amplitude * omega * (s.y - middle)

    def see(stepper):
        s = stepper.state
        return (float(((s.x - s.x.mean()) ** 2).sum() - ((s.y - s.y.mean()) ** 2).sum()),)

    time, moment = free.go(stepper, SWINGS * lamb(radius), see).T
    turned = np.flatnonzero((moment[1:-1] > 0.0) != (moment[2:] > 0.0)) + 1
    zeros = [time[k] - moment[k] * (time[k + 1] - time[k]) / (moment[k + 1] - moment[k]) for k in turned]
    return 2.0 * (zeros[1] - zeros[0]) / lamb(radius)


def laplace(radii) -> tuple[float, list[float]]:
    """Slope of the pressure in drops at rest against 1/R, over sigma, and each over sigma/R."""
    pressures = []
    for radius in radii:
        stepper, middle = drop(radius)

        def see(stepper, middle=middle, radius=radius):
            away = np.hypot(*(particles.positions(stepper.state)[:, :2] - middle).T)
            return (float(stepper.gauge[away < 0.5 * radius * free.SPACING].mean()),)

        time, pressure = free.go(stepper, RESTING * lamb(min(radii)), see).T
        pressures.append(float(pressure[time > 0.5 * time[-1]].mean()))
    curvature = 1.0 / (np.array(radii) * free.SPACING)
    slope = np.polyfit(curvature, pressures, 1)[0] / free.SIGMA
    return float(slope), [p / (free.SIGMA * k) for p, k in zip(pressures, curvature)]
