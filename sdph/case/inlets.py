"""Velocity of an inlet's gas against time: rows of time and velocity, linear between them, the first before and the
last after them.

Windows end at the rows (`sdph.exchange.window.Window`), and in each of them gas comes in at the mean velocity of the
window, so that what came in is the integral of the rows, to round-off, whatever the windows are.
"""

from __future__ import annotations

import dataclasses
import math

import numpy as np

from sdph.schema import CaseError, refuse_implausible


def at(boundary, time: float) -> np.ndarray:
    """Velocity (d,) [m/s] of the gas of an inlet at a time [s]."""
    if boundary.velocities is None:
        return np.array(boundary.velocity)
    rows = np.array(boundary.velocities)
    return np.array([np.interp(time, rows[:, 0], values) for values in rows.T[1:]])


def mean(boundary, begin: float, end: float) -> np.ndarray:
    """Mean velocity (d,) [m/s] of the gas of an inlet from `begin` to `end` [s]; that at `begin` where both are one."""
    if boundary.velocities is None or end == begin:
        return at(boundary, begin)
    within = [row[0] for row in boundary.velocities if begin < row[0] < end]
    times = np.array([begin, *within, end])
    values = np.array([at(boundary, time) for time in times])
    return 0.5 * (values[1:] + values[:-1]).T @ (np.diff(times) / (end - begin))


def times(case) -> list[float]:
    """Times [s] of the rows of all inlets."""
    return sorted({row[0] for boundary in case.boundaries.values() for row in boundary.velocities or ()})


def quickened(case, begin: float, end: float) -> float:
    """Largest speed [m/s] at `end` of gas of the inlets that comes in faster then than at `begin` [s]; 0 of none."""
    found = [
        (math.hypot(*at(own, begin)), math.hypot(*at(own, end))) for own in case.boundaries.values() if own.velocities
    ]
    return max((after for before, after in found if after > before), default=0.0)


def held(case, time: float):
    """The case with the velocities of its inlets at a time [s] for good."""
    own = {
        name: dataclasses.replace(boundary, velocity=tuple(at(boundary, time).tolist()), velocities=None)
        for name, boundary in case.boundaries.items()
        if boundary.velocities
    }
    return dataclasses.replace(case, boundaries=case.boundaries | own)


def check(case) -> None:
    """CaseError where rows are of no inlet, beside another velocity, too few, of other components, or do not rise."""
    for name, own in case.boundaries.items():
        if own.velocities is not None:
            _check_one(case, f"boundaries.{name}", own)


def _check_one(case, where: str, own) -> None:
    _refuse_idle(where, own)
    form = f"[time s, {', '.join('uvw'[: case.dimensions])} m/s]"
    for row in own.velocities:
        _check_row(f"{where}.velocities", row, 1 + case.dimensions, form)
    given = [row[0] for row in own.velocities]
    if len(given) < 2 or not (np.diff(given) > 0.0).all():
        raise CaseError(f"{where}.velocities has the times {given}; give two at least, each after the one before")


def _refuse_idle(where: str, own) -> None:
    """CaseError of rows that are of no inlet, or beside what is no table."""
    if own.kind != "velocity_inlet":
        raise CaseError(f"{where}.velocities are of a velocity_inlet; kind = {own.kind!r}: leave them out")
    if own.velocity is not None:
        raise CaseError(f"{where}: give either velocity_m_s or velocities")
    if own.profile != "uniform":
        raise CaseError(f"{where}.velocities are the same all over the inlet; leave profile = {own.profile!r} out")


def _check_row(key: str, row, length: int, form: str) -> None:
    """CaseError of a row that has not this length, or a number of no plausible size."""
    flat = isinstance(row, tuple) and not any(isinstance(value, tuple) for value in row)
    if not flat or len(row) != length or row[0] < 0.0:
        given = list(row) if isinstance(row, tuple) else row
        raise CaseError(f"{key} holds {given}; a row is {form}, the time 0 or more")
    refuse_implausible(row[0], "s", f"{key}: the time")
    for value in row[1:]:
        refuse_implausible(value, "m_s", f"{key}: the velocity")
