"""The front of the collapsing column against measurements: front.csv, from the sources that it names.

Times are shifted by a usual 0.175 (in units of sqrt(a/2g)): a gate opens in finite time and friction holds the front
back.
"""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np

from sdph.study.compare import check

OFFSET = 0.175  # of T = t sqrt(2 g/a), see front.csv
# Martin & Moyce 1952 are one source, the mean of its series that reach a time; a column of theirs was read off twice
SOURCES = (("mm_a1.125in", "mm_a2.25in", "mm_lethe"), ("koshizuka_oka_exp",))
TIMES = (1.25, 1.5, 2.0, 2.5, 3.0)  # of T
MARGIN = 0.02  # of Z: what the points were read off with
VARIANTS = {"dam_break": ((), ["exact"]), "free slip": (("tank.slip='free_slip'",), ["exact"])}


def measured() -> list[list[np.ndarray]]:
    """Series of each source, (P, 2) T and Z."""
    with open(Path(__file__).parent / "front.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    points = {name: [[float(r["T"]), float(r["Z"])] for r in rows if r["series"] == name] for name in sum(SOURCES, ())}
    return [[np.array(points[name]) for name in source] for source in SOURCES]


def by_source(at: float) -> list[float]:
    """Z at T = `at` of the sources that reach it."""
    told = [[np.interp(at, *rows.T) for rows in source if rows[0, 0] <= at <= rows[-1, 0]] for source in measured()]
    return [float(np.mean(values)) for values in told if values]


def fronts(run, column: str = "largest_x_m") -> dict[float, tuple[float, float, float]]:
    """T -> x/a of the run, middle of the sources, half of what they are apart."""
    case, pool = run.case, run.case.pools["column"]
    width, g = pool.upper[0] - pool.lower[0], -case.domain.gravity[1]
    pace = np.sqrt(2.0 * g / width)
    T = run.history["time_s"] * pace + OFFSET
    Z = (run.history[column] + 0.5 * case.resolution.spacing) / width
    found = {}
    moments = {(at - OFFSET) / pace: at for at in TIMES}
    for at in (moments[time] for time in run.reached(moments)):
        known = by_source(at)
        middle, spread = 0.5 * (min(known) + max(known)), 0.5 * (max(known) - min(known))
        found[at] = float(np.interp(at, T, Z)), middle, spread
    return found


def metrics(run, column: str = "largest_x_m") -> dict:
    """Values for `sdph cost`: (value, reference, scale)."""
    return {f"front at T = {at:g}": (value, middle, middle) for at, (value, middle, _) in fronts(run, column).items()}


def exact(run) -> list[dict]:
    return within_scatter(fronts(run))


def within_scatter(found: dict) -> list[dict]:
    """No further from the middle of the measured than half their spread; found: what `fronts` gives."""
    return [
        check(f"front x/a at T = {at:g}", value, middle, spread + MARGIN)
        for at, (value, middle, spread) in found.items()
    ]
