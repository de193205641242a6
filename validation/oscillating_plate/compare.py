"""A plate held at one end that swings: its period against thin theory, and what is left of its energy."""

from __future__ import annotations

import numpy as np

from sdph.laws import solids
from sdph.study.compare import check

# of thin theory: a plate of L/H = 10 swings 2 to 8 % slower, by shear, rotary inertia and the give of its clamp
LEAST, MOST = 1.02, 1.08


def period(run) -> float:
    """T [s], twice the mean time between passages of the plate's middle through its first height."""
    time, height = run.history["time_s"], run.history["plate_centre_y_m"]
    off = height - height[0]
    through = np.flatnonzero(off[1:-1] * off[2:] < 0.0) + 1
    passed = time[through] - off[through] * (time[through + 1] - time[through]) / (off[through + 1] - off[through])
    return 2.0 * float(np.diff(np.concatenate([[0.0], passed])).mean())


def thin(run) -> float:
    """T [s] of thin theory."""
    own, body = run.case.solid, run.case.bodies["plate"]
    length, thickness = body.upper[0] - body.held_upper[0], body.upper[1] - body.lower[1]
    return solids.cantilever_period(length, thickness, own.youngs_modulus, own.poisson_ratio, own.density)


def metrics(run) -> dict:
    """Values for `sdph cost`: (value, reference, scale)."""
    return {"period": (period(run), thin(run), thin(run))}


def exact(run) -> list[dict]:
    middle, half = 0.5 * (LEAST + MOST), 0.5 * (MOST - LEAST)
    return [check("period over thin theory's", period(run) / thin(run), middle, half)]
