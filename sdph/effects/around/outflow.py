"""Grains that leave the domain through its open sides are taken out and counted."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from sdph.effects.effect import Effect, Judgement
from sdph.engine import state as particles
from sdph.engine.geometry import PAIRS
from sdph.engine.state import GRAIN
from sdph.schema import CaseError, record


@record
class Outflow:
    """Has no input of its own: grains leave through every pressure_outlet, and where no `walls` hold them."""


class OutflowP(NamedTuple):
    """1 where walls hold grains back at the other sides, else 0."""

    walls: int


def kernel(case) -> OutflowP:
    return OutflowP(int("walls" in case.effects))


def leaving(case, state) -> np.ndarray:
    """Mask of the grains that are out of the domain through an open side."""
    gone = np.zeros(len(state.x), bool)
    if not len(gone):
        return gone
    places = particles.axes(state)
    for axis, (sides, length, period) in enumerate(zip(PAIRS, case.domain.size, case.domain.period)):
        if period:  # who is beyond it for a moment is on its way round
            continue
        for side, out in zip(sides, (places[axis] < 0.0, places[axis] > length)):
            if out.any():
                gone |= out & _open(case, side, axis, places)
    return gone & (state.kind == GRAIN)


def refuse_to_leave(case, state, gone, time: float) -> None:
    """CaseError where grains left, mask (N,), at `time` [s] in a case without this effect: there is no gas outside."""
    first = int(np.flatnonzero(gone)[0])
    place = ", ".join(f"{axis[first]:.4g}" for axis in particles.axes(state))
    raise CaseError(
        f"{int(gone.sum())} particles have left the domain through an open side at t = {time:.6g} s, the first is "
        f"{state.ident[first]} at ({place}) m; "
        f"add outflow to effects = {list(case.effects)}, or enlarge domain.size_m = {list(case.domain.size)}"
    )


def _open(case, side: str, axis: int, places) -> np.ndarray:
    if "walls" not in case.effects:
        return np.ones(len(places[0]), bool)
    tangential = [place for a, place in enumerate(places) if a != axis]
    found = np.zeros(len(places[0]), bool)
    for boundary in case.boundaries.values():
        if boundary.side == side and boundary.kind == "pressure_outlet":
            spans = _spans(boundary.span, len(tangential))
            found |= np.logical_and.reduce([(t >= low) & (t <= high) for t, (low, high) in zip(tangential, spans)])
    return found


def _spans(span, count: int):
    if span is None:
        return ((-np.inf, np.inf),) * count
    return span if isinstance(span[0], tuple) else (span,)


def call(scales) -> Judgement:
    """Way of the grains within the run over their way to the nearest open side: past 1 they are out of the gas."""
    over_gap = scales.to_outlets.over_gap
    return Judgement(
        "way of the grains / gap to an open side", over_gap, 1.0, "geometry", 1.0 if over_gap >= 1.0 else 0.0
    )


EFFECT = Effect(
    name="outflow",
    summary="grains that leave through open sides",
    parameters=Outflow,
    kernel=kernel,
    moves=True,
    call=call,
)
