"""Two sizes of glass beads that part in a fluidised bed: which rises, how far, and that nothing is lost.

Goldschmidt, Link, Mellema & Kuipers 2003, Powder Technol. 138, 135, blew such beds between both U_mf and saw the small
beads rise and the large ones stay below. Their numbers are not at hand; what is checked is the direction, and that
nothing is lost.
"""

from __future__ import annotations

import numpy as np

from sdph.study.compare import check

BEGIN = 0.25  # of the run, and from LATE of it on: means over bubbles; our choice
LATE = 0.75


def paper(run) -> list[dict]:
    """Flotsam and jetsam, the mixing index, and the share of each material that is still there."""
    table, history = run.metrics, run.history
    times = table["time_s"] / run.case.run.end_time
    late, early = times >= LATE, (times > 0.0) & (times <= BEGIN)
    parted, start = table["segregation"], times == 0.0
    chance = abs(_ratio(table, start) - 1.0), abs(float(parted[start].mean()))  # of a random start
    kept = [history[f"material_{name}_kg"] for name in run.case.materials]
    checks = [
        _above("small beads over large: mean height late in the run, ratio", _ratio(table, late), 1.0 + chance[0]),
        _above("they part: segregation late less that early", parted[late].mean() - parted[early].mean(), chance[1]),
        _below("jetsam in the upper half, over its share of the bed, late", table["mixing_index"][late].mean(), 1.0),
    ]
    checks += [
        check(f"mass of {name}, end over start", own[-1] / own[0], 1.0, 1e-12)
        for name, own in zip(run.case.materials, kept)
    ]
    return checks


def _ratio(table, rows) -> float:
    """Mean height of the small beads over that of the large ones, over rows (T,) of the metrics."""
    return float(np.mean(table["height_small_m"][rows]) / np.mean(table["height_large_m"][rows]))


def _above(name: str, value: float, bound: float) -> dict:
    """A check that a value is above a bound."""
    row = check(name, value, bound, 0.0)
    return row | {"ok": bool(value > bound)}


def _below(name: str, value: float, bound: float) -> dict:
    """A check that a value is below a bound."""
    row = check(name, value, bound, 0.0)
    return row | {"ok": bool(value < bound)}
