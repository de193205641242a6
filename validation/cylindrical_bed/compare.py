"""A bubbling bed in a round vessel: the gas carries its weight, nothing leaves, nothing stands in the wall."""

from __future__ import annotations

import math

import numpy as np

from sdph.study import beds

RADIUS, CENTRE, AROUND = 0.05, (0.05, 0.05), 24  # m; cells around the O-grid, whose chords are the wall
FLOOR = 0.5 * AROUND * RADIUS**2 * math.sin(2.0 * math.pi / AROUND)  # m2


def exact(run) -> list[dict]:
    """Pressure drop, expansion, and grains in their place."""
    mass = beds.mass(run)
    weight = mass / run.case.grains.density * beds.buoyant(run.case) / FLOOR
    packed = mass / (beds.AT_ONSET * run.case.grains.density * FLOOR)
    return [beds.carried(run, weight), *beds.expanded(run, packed), beds.kept(run), beds.inside(run, distance)]


def distance(points) -> np.ndarray:
    """(N,) [m] from the wall and the floor, positive inside."""
    return np.minimum(RADIUS - np.hypot(*(points[:, :2] - CENTRE).T), points[:, 2])
