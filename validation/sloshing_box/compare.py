"""The first sloshing period of a box that is let go, and its loads; a tank that is shaken (`shaken.py`)."""

from __future__ import annotations

import numpy as np

from sdph.laws import liquids
from sdph.running.metrics.periods import ringing
from sdph.study.compare import check

from . import shaken

VARIANTS = {"sloshing_box": ((), ["exact"])} | {
    f"shaken, {spacing:g} mm": (shaken.overrides(spacing), ["measured"]) for spacing in shaken.SPACINGS
}
PERIOD = 0.01  # at half a length of 25 spacings: issue


def periods(run) -> tuple[float, float]:
    """Periods of the centre of mass and of the force, over that of linear theory."""
    case, pool, h = run.case, run.case.pools["water"], run.history
    length, depth, g = case.domain.size[0], pool.upper[1] - pool.lower[1], -case.domain.gravity[1]
    expected = liquids.box_slosh(length, depth, g)
    free = h["time_s"] > case.parameters["frame"].end
    omega, _ = ringing(h["time_s"][free], h["centre_x_m"][free], expected)
    force, _ = ringing(h["time_s"][free], h["mean_force_x_N"][free], expected)
    return expected / omega, expected / force


def metrics(run) -> dict:
    """Values for `sdph cost`: (value, reference, scale)."""
    return {
        name: (float(value), 1.0, 1.0)
        for name, value in zip(("period of the centre", "period of the force"), periods(run))
    }


def exact(run) -> list[dict]:
    h, (centre, force) = run.history, periods(run)
    free = h["time_s"] > run.case.parameters["frame"].end
    weight = -h["mass_kg"][0] * run.case.domain.gravity[1]
    scatter = np.sqrt(np.mean((h["mean_force_x_N"] - h["wall_force_x_N"])[free] ** 2)) / weight
    return [
        check("period of the centre of mass over the linear", centre, 1.0, PERIOD),
        check("period of the force over the linear", force, 1.0, PERIOD),
        check("mean downward force over the weight", -h["mean_force_y_N"][free].mean() / weight, 1.0, 1e-3),
        check("force by momentum less force by walls, rms over the weight", scatter, 0.0, 0.01),
    ]


def measured(run) -> list[dict]:
    return shaken.checks(run)
