"""Water and air at rest: rho g (H - y) in the water, nothing moves, nothing mixes."""

from __future__ import annotations

import numpy as np

from sdph.engine.state import GAS, LIQUID
from sdph.study.compare import check

SPEED, PRESSURE = 1e-3, 0.01  # of sqrt(g H), of rho g H in L2: liquids.md, hydrostatics
AIR = 5e-3  # of sqrt(g H): our choice; air at 1/1000 of the density feels every pascal


def metrics(run) -> dict:
    """Values for `sdph cost`: (value, reference, scale)."""
    speed, _, pressure, *_ = exact(run)
    return {
        "pressure of the water": (pressure["value"], 0.0, 1.0),
        "fastest water over sqrt(g H)": (speed["value"], 0.0, 1.0),
    }


def exact(run) -> list[dict]:
    case, h = run.case, run.history
    _, points, _ = run.fields(run.summary["time_s"])
    surface, g = case.pools["water"].upper[1], -case.domain.gravity[1]
    water, air = points["kind"] == LIQUID, points["kind"] == GAS
    y, speed = points.points[:, 1], np.sqrt(g * surface)
    above = case.gas_phase.density * g * (case.domain.size[1] - surface) + case.liquid.background_pressure
    expected = above + case.liquid.density * g * (surface - y[water])
    error = np.sqrt(np.mean((points["pressure"][water] - expected) ** 2)) / (case.liquid.density * g * surface)
    return [
        check("fastest water over sqrt(g H) in the end", h["liquid_fastest_m_s"][-1] / speed, 0.0, SPEED),
        check("fastest air over sqrt(g H) in the end", h["gas_fastest_m_s"][-1] / speed, 0.0, AIR),
        check("pressure of the water, L2 over rho g H", error, 0.0, PRESSURE),
        check("rise of the water's centre over H, largest", np.ptp(h["liquid_centre_y_m"]) / surface, 0.0, 1e-3),
        check(
            "lowest air over highest water, spacings",
            (y[air].min() - y[water].max()) / case.resolution.spacing,
            1.0,
            0.2,
        ),
    ]
