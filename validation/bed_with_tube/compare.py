"""A bed around a tube: the gas carries its weight and the lift of the tube in it, and no grain is in the tube."""

from __future__ import annotations

import math

import numpy as np

from sdph.study import beds

WIDTH, RADIUS, CENTRE = 0.2, 0.02, (0.1, 0.1)  # m
TUBE = math.pi * RADIUS**2  # m2


def exact(run) -> list[dict]:
    """Pressure drop as of a fluid of the bed's weight, which lifts the tube; expansion, and grains in their place."""
    volume = beds.mass(run) / run.case.grains.density
    inside = float(beds.late(run, "alpha_p_inside").mean())
    packed = (volume / beds.AT_ONSET + TUBE) / WIDTH
    return [
        beds.carried(run, (volume + inside * TUBE) * beds.buoyant(run.case) / WIDTH),
        *beds.expanded(run, packed),
        beds.kept(run),
        beds.inside(run, distance),
    ]


def distance(points) -> np.ndarray:
    """(N,) [m] from the walls, the floor and the tube, positive outside of it."""
    x, y = points[:, 0], points[:, 1]
    return np.minimum.reduce([x, WIDTH - x, y, np.hypot(x - CENTRE[0], y - CENTRE[1]) - RADIUS])
