"""A layer of grains, periodic along a rough slope, without agitation: it rests below the angle at which Schaeffer's
grains slide along a plane, and slides above it as a block does, at g (sin(slope) - mu cos(slope)).

mu = sin(phi) where grains slide along a plane: phi of Mohr's circle is the case's. With phi for the angle of the plane
it would be tan(phi), which grains bear that have not slid yet.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from sdph.study.compare import check

from . import alone

PHI = math.radians(28.5)  # default of a case: 25.5 degrees along a plane
ANGLES, SPACINGS = (20.0, 30.0, 45.0), (5e-3, 2.5e-3)  # deg, m
DEPTH, LENGTH = 0.1, 10.0  # m, spacings
EFFECTS = ("gravity", "walls", "friction")
SETTLED = 0.3  # s on level ground, 3 sqrt(DEPTH/g): the lattice is packed; our choice
RESTED = 1.5  # s on a slope: what rings elastically has died away; our choice
SLID = (0.1, 0.2)  # s on a slope before its acceleration is measured, and while it is; our choice
BAR, STILL = 0.05, 1e-3  # of the acceleration; of sqrt(g DEPTH), fastest grain


def checks(folder: Path, *_, angles=ANGLES, spacings=SPACINGS) -> list[dict]:
    rows = []
    for dx in spacings:
        for angle in angles:
            run, name = tilted(angle, dx), f"slope of {angle:g} deg, {1e3 * dx:g} mm"
            due = acceleration(angle)
            if due <= 0.0:
                run.go(RESTED)
                fastest, most = (
                    float(np.hypot(run.state.u, run.state.v).max()),
                    STILL * math.sqrt(alone.GRAVITY * DEPTH),
                )
                rows.append(check(f"{name}: fastest grain [m/s]", fastest, 0.0, most))
            else:
                rows.append(check(f"{name}: acceleration [m/s2]", accelerated(run), due, BAR, True))
    return rows


def acceleration(angle: float) -> float:
    """Acceleration of a block that slides down a slope of `angle` [deg], m/s2; below 0 where it rests."""
    slope = math.radians(angle)
    return alone.GRAVITY * (math.sin(slope) - math.sin(PHI) * math.cos(slope))


def tilted(angle: float, spacing: float):
    """A layer that has settled on level ground, when the ground is tilted by `angle` [deg]."""
    length, settled = LENGTH * spacing, {"friction": {"angle_deg": math.degrees(PHI)}, "domain": {"periodic": ["x"]}}
    case = alone.case((length, DEPTH + 4.0 * spacing), ((0.0, 0.0), (length, DEPTH)), spacing, EFFECTS, **settled)
    run, slope = alone.Alone(case), math.radians(angle)
    run.go(SETTLED)
    run.gravity = alone.GRAVITY * np.array([math.sin(slope), -math.cos(slope), 0.0])
    return run


def accelerated(run) -> float:
    """Gain of the mean velocity over its time [m/s2]."""
    run.go(SLID[0])
    before = speed(run)
    run.go(SLID[1])
    return (speed(run) - before) / SLID[1]


def speed(run) -> float:
    """Mean velocity along the slope [m/s]."""
    return float(run.state.mass @ run.state.u / run.state.mass.sum())
