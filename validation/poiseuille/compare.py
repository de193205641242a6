"""Velocity between two plates against the series of Morris, Fox & Zhu 1997, on the way and in the end."""

from __future__ import annotations

import numpy as np

from sdph.laws import liquids
from sdph.study.compare import check

SHARE = 0.005  # of the largest velocity: liquids.md
TIMES = (0.5, 1.0, 2.0, 10.0)  # s


def errors(run) -> dict[float, float]:
    """Time [s] -> L2 of the velocity over the largest."""
    case = run.case
    nu, height = case.liquid.viscosity / case.liquid.density, case.domain.size[1]
    found = {}
    for time in run.outputs(TIMES):
        _, liquid, _ = run.fields(time)
        u = liquids.poiseuille(liquid.points[:, 1], time, height, case.domain.gravity[0], nu)
        found[time] = np.sqrt(np.mean((liquid["velocity"][:, 0] - u) ** 2)) / u.max()
    return found


def metrics(run) -> dict:
    """Values for `sdph cost`: (value, reference, scale)."""
    return {f"velocity at {time:g} s": (float(error), 0.0, 1.0) for time, error in errors(run).items()}


def exact(run) -> list[dict]:
    return [
        check(f"velocity at {time:g} s, L2 over the largest", error, 0.0, SHARE) for time, error in errors(run).items()
    ]
