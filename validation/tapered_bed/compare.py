"""A bed between walls that lean outwards: inside it the pressure falls as its weight there asks for."""

from __future__ import annotations

import math

import numpy as np

from sdph.study import beds
from sdph.study.compare import check

FLOOR, LEAN = 0.1, 0.125  # width below [m]; each wall leans by so much a metre
INSIDE = 0.15  # of the gradient, a line through some ten rows while bubbles pass: our choice


def exact(run) -> list[dict]:
    """Pressure gradient, expansion, and grains in their place."""
    gradient = float(beds.late(run, "gradient_Pa_m").mean())
    weight = float(beds.late(run, "alpha_p_inside").mean()) * beds.buoyant(run.case)
    volume = beds.mass(run) / (beds.AT_ONSET * run.case.grains.density)
    return [
        check("pressure gradient inside the bed [Pa/m], its weight there", gradient, weight, INSIDE, True),
        *beds.expanded(run, 2.0 * centre(volume)),
        beds.kept(run),
        beds.inside(run, distance),
    ]


def centre(volume: float) -> float:
    """Height [m] of the centre of what fills the vessel up to a volume [m2]: w = FLOOR + 2 LEAN z."""
    height = (math.sqrt(FLOOR**2 + 4.0 * LEAN * volume) - FLOOR) / (2.0 * LEAN)
    return (0.5 * FLOOR * height**2 + 2.0 * LEAN * height**3 / 3.0) / volume


def distance(points) -> np.ndarray:
    """(N,) [m] from the leaning walls and the floor, positive inside."""
    off = np.abs(points[:, 0] - FLOOR)  # the middle stands half the width above from the left
    return np.minimum((0.5 * FLOOR + LEAN * points[:, 1] - off) / math.hypot(1.0, LEAN), points[:, 1])
