"""Water at rest against rho g (H - y), Tait's compressibility left out (0.3 % of the depth at c = 10 sqrt(g H))."""

from __future__ import annotations

import numpy as np

from sdph.study.compare import check

PRESSURE, SPEED = 0.01, 1e-3  # of rho g H in L2; of sqrt(g H): liquids.md


def pressure_error(run, liquid) -> float:
    """L2 over rho g H."""
    case, pool = run.case, run.case.pools["water"]
    g = -case.domain.gravity[1]
    expected = case.liquid.density * g * (pool.upper[1] - liquid.points[:, 1])
    return np.sqrt(np.mean((liquid["pressure"] - expected) ** 2)) / (
        case.liquid.density * g * (pool.upper[1] - pool.lower[1])
    )


def metrics(run) -> dict:
    """Values for `sdph cost`: (value, reference, scale)."""
    _, liquid, _ = run.fields(run.summary["time_s"])
    weight = -liquid["mass"].sum() * run.case.domain.gravity[1]
    return {
        "pressure": (pressure_error(run, liquid), 0.0, 1.0),
        "weight": (-run.history["wall_force_y_N"][-1] / weight, 1.0, 1.0),
    }


def exact(run) -> list[dict]:
    case, pool = run.case, run.case.pools["water"]
    _, liquid, _ = run.fields(run.summary["time_s"])
    depth = pool.upper[1] - pool.lower[1]
    g = -case.domain.gravity[1]
    fastest = np.linalg.norm(liquid["velocity"], axis=1).max() / np.sqrt(g * depth)
    weight = liquid["mass"].sum() * g
    return [
        check("pressure, L2 over rho g H", pressure_error(run, liquid), 0.0, PRESSURE),
        check("fastest particle over sqrt(g H)", fastest, 0.0, SPEED),
        check("force on the bottom over the weight", -run.history["mean_force_y_N"][-1] / weight, 1.0, 1e-3),
        check("the same from the walls' pressure", -run.history["wall_force_y_N"][-1] / weight, 1.0, 1e-3),
    ]
