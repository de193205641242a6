"""Rate of a nozzle against time: rows of time and rate, linear between them, the first before and the last after them.

The speed stays, so that the grains come in thicker and thinner: a layer has the mass that passes while it does. What
came in is the integral of the rate, to within half a layer. Between two rows of rate 0 nothing comes.
"""

from __future__ import annotations

import numpy as np

from sdph.schema import CaseError, refuse_implausible


def largest(nozzle) -> float | None:
    """Largest rate [kg/s], per metre of depth in two dimensions; None where a nozzle has a volume fraction instead."""
    return max(rate for _, rate in nozzle.rates) if nozzle.rates else nozzle.rate


def passed(rates, time) -> np.ndarray:
    """Mass [kg] that has passed at times (n,) [s] since the first row, below 0 before it; rows [time s, rate kg/s]."""
    knots, values = np.array(rates).T
    before = np.concatenate([[0.0], np.cumsum(0.5 * (values[1:] + values[:-1]) * np.diff(knots))])
    slopes = np.concatenate([np.diff(values) / np.diff(knots), [0.0]])
    row = np.clip(np.searchsorted(knots, time, side="right") - 1, 0, len(knots) - 1)
    since = np.asarray(time) - knots[row]
    slope = np.where(since < 0.0, 0.0, slopes[row])  # before the first row the rate is that of it
    return before[row] + since * (values[row] + 0.5 * slope * since)


def thickness(nozzle, speed, pitch: float, layer) -> np.ndarray:
    """Mass (n,) of particles over that at the largest rate, of streams (n,) of `speed` [m/s], of their layers (n,)."""
    if not nozzle.rates:
        return np.ones(len(layer))
    begin, length = nozzle.start + layer * pitch / speed, pitch / speed
    return (passed(nozzle.rates, begin + length) - passed(nozzle.rates, begin)) / (length * largest(nozzle))


def check(case, where: str, nozzle) -> None:
    """CaseError where rows are none, do not rise, do not reach from the nozzle's start to its end, or give nothing."""
    if not nozzle.rates:
        return
    if case.grains is None or nozzle.shape == "table":
        raise CaseError(f"{where}.rates are of a nozzle of grains that come in one by one; leave them out")
    for row in nozzle.rates:
        flat = isinstance(row, tuple) and not any(isinstance(value, tuple) for value in row)
        if not flat or len(row) != 2 or row[1] < 0.0:
            raise CaseError(f"{where}.rates holds {row}; a row is [time s, rate kg/s], the rate 0 or more")
        refuse_implausible(row[1], "kg_s", f"{where}.rates: the rate")
    times, values = np.array(nozzle.rates).T
    if len(times) < 2 or not (np.diff(times) > 0.0).all():
        raise CaseError(f"{where}.rates has the times {times.tolist()}; give two at least, each after the one before")
    last = case.run.end_time if nozzle.end is None else min(nozzle.end, case.run.end_time)
    if times[0] > nozzle.start or times[-1] < last:
        given = f"{where}.rates go from {times[0]:g} to {times[-1]:g} s"
        raise CaseError(f"{given}, and the nozzle gives from {nozzle.start:g} to {last:g} s; add rows")
    if not values.any():
        raise CaseError(f"{where}.rates is 0 in all rows, so that nothing comes in; leave the nozzle out")
