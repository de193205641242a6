"""The free overfall against its depth at the brink (Rouse 1936) and the balances of what comes in and falls out."""

from __future__ import annotations

import numpy as np

from sdph.show import timeline
from sdph.study.compare import check

BRINK, DEPTH = (
    0.715,
    0.05,
)  # of the critical depth: Rouse 1936, Civ. Eng. 6, 257, smooth and level, wide; bar our choice
STEADY = 2.0 / 3.0  # of the run, from which on profiles count; our choice
ACROSS = 2.0  # spacings to each side of the brink that count; our choice


def brink(run) -> float:
    """Depth [m] at the brink: highest particle there and half a spacing, mean of the profiles of the last third."""
    case, dx, found = run.case, run.case.resolution.spacing, []
    edge, floor = case.parameters["tank"].upper[0], case.parameters["tank"].lower[1]
    for time in timeline.read(run.folder).time_values:
        if time < STEADY * run.summary["time_s"]:
            continue
        _, liquid, _ = run.fields(time)
        near = np.abs(liquid.points[:, 0] - edge) <= ACROSS * dx
        found.append(liquid.points[near, 1].max() + 0.5 * dx - floor)
    return float(np.mean(found))


def critical(case) -> float:
    """Critical depth [m] of the flow that the nozzle gives."""
    nozzle = case.nozzles["mouth"]
    return float(((nozzle.width * nozzle.speed) ** 2 / -case.domain.gravity[1]) ** (1.0 / 3.0))


def metrics(run) -> dict:
    """Values for `sdph cost`: (value, reference, scale)."""
    return {"depth at the brink": (brink(run) / critical(run.case), BRINK, BRINK)}


def exact(run) -> list[dict]:
    case, summary, h = run.case, run.summary, run.history
    late = h["time_s"] >= STEADY * summary["time_s"]
    held = h["mass_kg"][late]
    nozzle = case.nozzles["mouth"]
    through = case.liquid.density * nozzle.width * nozzle.speed * np.ptp(h["time_s"][late])
    return [
        check("depth at the brink over the critical depth", brink(run) / critical(case), BRINK, DEPTH, True),
        check("change of what is held over what comes in, last third", (held[-1] - held[0]) / through, 0.0, 0.02),
    ]
