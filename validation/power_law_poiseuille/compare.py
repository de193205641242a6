"""Velocity of a shear-thinning liquid between two plates, long after its start, against the closed form."""

from __future__ import annotations

import numpy as np

from sdph.laws import thinning
from sdph.study.compare import check

SHARE = 0.01  # of the largest velocity: issue 16


def errors(run) -> tuple[float, float]:
    """Largest error and L2 of the velocity at the end, over the largest velocity."""
    case = run.case
    _, liquid, _ = run.fields(run.summary["time_s"])
    pull = case.domain.gravity[0] * case.liquid.density
    own = case.domain.size[1], pull, case.liquid.viscosity, case.parameters["shear_thinning"].index
    u, middle = (thinning.between_plates(y, *own) for y in (liquid.points[:, 1], [0.5 * case.domain.size[1]]))
    off = np.abs(liquid["velocity"][:, 0] - u) / middle[0]
    return float(off.max()), float(np.sqrt(np.mean(off**2)))


def metrics(run) -> dict:
    """Values for `sdph cost`: (value, reference, scale)."""
    largest, mean = errors(run)
    return {"velocity, largest error": (largest, 0.0, 1.0), "velocity, L2": (mean, 0.0, 1.0)}


def exact(run) -> list[dict]:
    largest, mean = errors(run)
    return [
        check("velocity, largest error over the largest", largest, 0.0, SHARE),
        check("velocity, L2 over the largest", mean, 0.0, SHARE),
    ]
