"""The bore against the balances of mass and momentum over it, which leave no choice for its speed and depth."""

from __future__ import annotations

import numpy as np

from sdph.study.compare import check

FROM = 0.25  # of the run: the roller has formed; our choice
SPEED, FORCE = 0.05, 0.03  # our choice: the jump is not steady, eddies go on behind it


def bore(speed: float, depth: float, gravity: float) -> tuple[float, float]:
    """Speed upstream [m/s] and depth behind [m] of a bore that a stream of `speed` and `depth` makes against still
    water: (U + s) h_1 = s h_2 and (U + s)^2 = g h_2 (h_1 + h_2)/(2 h_1) (Stoker 1957, Water Waves, section 10.7)."""
    squared = speed**2 / (gravity * depth)  # of Froude's number; r = h_2/h_1: r^3 - r^2 - (1 + 2 F^2) r + 1 = 0
    ratio = float(np.roots([1.0, -1.0, -1.0 - 2.0 * squared, 1.0]).real.max())
    return speed / (ratio - 1.0), ratio * depth


def measured(run) -> dict[str, tuple[float, float]]:
    """Value and reference by name: the bore's speed [m/s], by how fast it takes the stream's momentum; force on the end
    of the channel [N/m]; power lost [W/m]."""
    case, nozzle, h = run.case, run.case.nozzles["mouth"], run.history
    density, gravity, depth, speed = case.liquid.density, -case.domain.gravity[1], nozzle.width, nozzle.speed
    upstream, behind = bore(speed, depth, gravity)
    on = h["time_s"] >= FROM * run.summary["time_s"]
    taken = -np.polyfit(h["time_s"][on], h["momentum_x_kg_m_s"][on], 1)[0] / (density * speed * depth)
    ledger = {name: np.nan_to_num(run.ledger[name]) for name in ("time_s", "dissipated_J")}
    late = ledger["time_s"] >= FROM * run.summary["time_s"]
    lost = np.polyfit(ledger["time_s"][late], np.cumsum(ledger["dissipated_J"])[late], 1)[0]
    by_jump = density * gravity * (behind - depth) ** 3 / (4.0 * depth * behind) * (speed + upstream) * depth
    return {
        "speed of the bore [m/s]": (float(taken), upstream),
        "force on the end of the channel [N/m]": (
            float(h["mean_force_x_N"][on].mean()),
            0.5 * density * gravity * behind**2,
        ),
        "power lost, with eddies that have not yet decayed [W/m]": (float(lost), by_jump),
    }


def metrics(run) -> dict:
    """Values for `sdph cost`: (value, reference, scale)."""
    return {name: (value, wanted, wanted) for name, (value, wanted) in measured(run).items()}


def exact(run) -> list[dict]:
    nozzle, summary = run.case.nozzles["mouth"], run.summary
    rate = run.case.liquid.density * nozzle.width * nozzle.speed
    layer = rate / nozzle.speed * run.case.resolution.spacing
    speed, force, _ = [(name, *values) for name, values in measured(run).items()]
    return [
        check(*speed, SPEED, True),
        check(*force, FORCE, True),
        check("mass through the nozzle [kg/m]", summary["injected_kg"], rate * summary["time_s"], 0.5001 * layer),
    ]
