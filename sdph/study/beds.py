"""Checks of fluidised beds in vessels of any shape, for validation/<scene>/compare.py."""

from __future__ import annotations

import math

import numpy as np

from sdph.study.compare import check

LATE = 0.4  # share of a run after which means are taken: the bed has thrown its first bubbles by then; our choice
AT_ONSET = 0.60  # volume fraction at minimum fluidisation: the onset of contacts, friction.onset
OUT = 0.05  # of a spacing: how far a particle may stand beyond a wall while it is turned back; our choice
CARRIED = 0.05  # of the weight: bubbles make the pressure swing by a sixth, and a mean is of some thirty; our choice
EXPANDED = (1.0, 1.6)  # height over that of the bed at minimum fluidisation: group B, Geldart 1973


def late(run, column: str) -> np.ndarray:
    """Values of a metric once the bed bubbles."""
    return run.metrics[column][run.metrics["time_s"] > LATE * run.case.run.end_time]


def carried(run, expected: float, bar: float = CARRIED) -> dict:
    """Pressure drop [Pa] that the gas carries the bed with, mean in time, against what it has to be."""
    return check(
        "pressure drop [Pa], weight of the bed", float(late(run, "pressure_drop_Pa").mean()), expected, bar, True
    )


def buoyant(case) -> float:
    """Weight of a volume of grains in gas [N/m3]."""
    return (case.grains.density - case.gas.density) * math.hypot(*case.domain.gravity)


def mass(run) -> float:
    """Grains at the start [kg], in two dimensions by the metre."""
    return float(np.asarray(run.fields(0.0)[1]["mass"], float).sum())


def kept(run) -> dict:
    """Mass that has left through the outlet; that lost is in the balances of every run."""
    return _below("grains that left [kg]", run.summary["left_kg"], 0.0)


def expanded(run, packed: float) -> list[dict]:
    """Twice the height of the centre of the bed against that where it lies at minimum fluidisation, `packed` [m]."""
    share = float(late(run, "bed_height_m").mean()) / packed
    name = "height of the bed over that at minimum fluidisation"
    least, most = EXPANDED
    row = {
        "name": f"{name}, at least",
        "value": share,
        "reference": least,
        "tolerance": 0.0,
        "ok": bool(share >= least),
    }
    return [row, _below(f"{name}, at most", share, most)]


def inside(run, distance) -> dict:
    """Farthest that a particle stands beyond the walls at any output [m]; `distance` (N, 3) -> (N,) [m] is positive
    inside."""
    places = [np.asarray(run.fields(time)[1].points, float) for time in run.metrics["time_s"]]
    worst = np.max([-distance(own).min() for own in places])  # nan where one is
    return _below("farthest that a particle stands beyond a wall [m]", worst, OUT * run.case.resolution.spacing)


def _below(name: str, value: float, most: float) -> dict:
    return {"name": name, "value": float(value), "reference": most, "tolerance": 0.0, "ok": bool(value <= most)}
