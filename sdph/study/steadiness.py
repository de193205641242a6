"""Steadiness of a run: its curves over the third and over the fourth quarter of its time.

Each quarter is cut into batches, whose means are all but independent of each other if they are longer than the flow
remembers: the scatter of these is the doubt about the mean of the quarter (batch means; Law 2014, Simulation Modeling
and Analysis, section 9.5.3). A curve is steady if its two means are no further apart than that doubt allows.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import scipy

from sdph.exchange.equations import LEAST_SPAN

BATCHES = 5  # of a quarter: fewer do not tell scatter, more are too short for what flows remember; our choice
# Student's t, in standard errors: 95 % of the means of a quarter lie nearer to the true one, of two to each other
ALONE, APART = (scipy.special.stdtrit(known, 0.975) for known in (BATCHES - 1, 2 * (BATCHES - 1)))
# of the mean, or of the range of a temperature: what changes less is steady whatever its scatter; our choice
ALIKE = 0.005


def rows(columns: Mapping[str, np.ndarray]) -> list[dict[str, Any]]:
    """A row for each column that is a number all through the second half of `time_s` (R,) and changes there: its
    `mean` over the last quarter and the doubt about it, the same one quarter before, and whether it is `steady`; none
    where a batch has no row."""
    time, found = columns["time_s"], []
    if not len(time):
        return found
    steps = np.diff(time, prepend=time[0])  # a row is the mean of what it follows, or its end
    edges = np.linspace(0.5 * (time[0] + time[-1]), time[-1], 2 * BATCHES + 1)
    ends = np.searchsorted(time, edges, side="right")
    if (np.diff(ends) < 1).any():
        return found
    for name, values in columns.items():
        own = values[ends[0] :]
        if name == "time_s" or values.dtype.kind != "f" or not np.isfinite(own).all():
            continue
        if np.ptp(own) <= 1e-12 * np.abs(own).max():
            continue
        sums = np.add.reduceat(values * steps, ends[:-1]) / np.add.reduceat(steps, ends[:-1])
        found.append(_row(name, sums[:BATCHES], sums[BATCHES:], _alike(name, values, sums[BATCHES:].mean())))
    return found


def _alike(name: str, values: np.ndarray, mean: float) -> float:
    """Change that counts as none: `ALIKE` of the last `mean`, or, of temperatures, of what the column went through
    since the start, LEAST_SPAN at least."""
    if not name.endswith("_K"):
        return ALIKE * abs(mean)
    return ALIKE * max(float(np.ptp(values[np.isfinite(values)])), LEAST_SPAN)


def _row(name: str, before: np.ndarray, last: np.ndarray, alike: float) -> dict[str, Any]:
    change, scatter = last.mean() - before.mean(), [own.std(ddof=1) / math.sqrt(BATCHES) for own in (last, before)]
    own = {"mean": last.mean(), "doubt": ALONE * scatter[0], "a_quarter_before": before.mean(), "change": change}
    steady = abs(change) <= max(APART * math.hypot(*scatter), alike)
    return {"column": name} | {key: float(value) for key, value in own.items()} | {"steady": bool(steady)}
