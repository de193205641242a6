"""The first sloshing period of a box that is let go, and its loads."""

from __future__ import annotations

import numpy as np

from sdph.compare import check
from sdph.laws import liquids
from sdph.periods import ringing

PERIOD = 0.01  # at half a length of 25 spacings: issue


def exact(run) -> list[dict]:
    case, pool, h = run.case, run.case.pools["water"], run.history
    length, depth, g = case.domain.size[0], pool.upper[1] - pool.lower[1], -case.domain.gravity[1]
    expected = liquids.box_slosh(length, depth, g)
    free = h["time_s"] > case.parameters["frame"].end
    omega, _ = ringing(h["time_s"][free], h["centre_x_m"][free], expected)
    force, _ = ringing(h["time_s"][free], h["mean_force_x_N"][free], expected)
    weight = h["mass_kg"][0] * g
    scatter = np.sqrt(np.mean((h["mean_force_x_N"] - h["wall_force_x_N"])[free] ** 2)) / weight
    return [
        check("period of the centre of mass over the linear", expected / omega, 1.0, PERIOD),
        check("period of the force over the linear", expected / force, 1.0, PERIOD),
        check("mean downward force over the weight", -h["mean_force_y_N"][free].mean() / weight, 1.0, 1e-3),
        check("force by momentum less force by walls, rms over the weight", scatter, 0.0, 0.01),
    ]
