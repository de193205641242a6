"""Checks of a case that several keys decide together; each raises a CaseError: what was given, and what is allowed."""

from __future__ import annotations

import math
from collections import Counter

from sdph.engine.geometry import SIDES
from sdph.schema import CaseError

SAME = 1e-9  # of a length: round-off
OF_BOX, OF_PLANE = ("rotation", "taylor_green"), ("taylor_green", "quadrupole")  # flows of a pool at the start


def columns_of_history(case) -> None:
    """No two columns of history.csv have one name."""
    columns = [f"{name}_{key}" for name in case.probes for key in ("temperature_K", "gas_temperature_K")]
    columns += [f"particle_{ident}_temperature_K" for ident in case.track]
    twice = [name for name, count in Counter(columns).items() if count > 1]
    if twice:
        raise CaseError(
            f"probes or track.particles give history.csv two columns {twice[0]}; "
            "rename a probe, or name a particle once"
        )


def flow(case, where: str, pool) -> None:
    """A pool has the shape and the case the dimensions that a flow at the start is known for."""
    if pool.flow in OF_BOX and pool.shape != "box":
        raise CaseError(f"{where}.flow = {pool.flow!r} is that of a box; shape = {pool.shape!r}")
    if pool.flow in OF_PLANE and case.dimensions != 2:
        raise CaseError(f"{where}.flow = {pool.flow!r} is known in two dimensions; dimensions = {case.dimensions}")


def probe(case, where: str, own) -> None:
    """A probe lies in the domain, and in a gas: a liquid has no temperature to follow."""
    if case.liquid:
        raise CaseError(f"[{where}] follows temperatures of grains and gas, and the case is of a liquid; leave it out")
    inside(case, where, own.at, own.at)


def mouth(case, where: str, nozzle) -> None:
    """The middle of a nozzle's mouth lies in the domain, and so does what lies half a spacing ahead of it."""
    if len(nozzle.centre) != case.dimensions or len(nozzle.direction) != case.dimensions:
        return  # the effect says so
    inside(case, f"{where}.centre_m = {list(nozzle.centre)}", nozzle.centre, nozzle.centre)
    length = max(math.hypot(*nozzle.direction), math.ulp(0.0))
    ahead = [c + 0.5 * case.resolution.spacing * a / length for c, a in zip(nozzle.centre, nozzle.direction)]
    inside(case, f"{where}.direction = {list(nozzle.direction)} at centre_m = {list(nozzle.centre)}", ahead, ahead)


def inside(case, key: str, lower, upper) -> None:
    """What a key places between two corners lies in the domain."""
    slack = SAME * max(case.domain.size)  # of centre plus radius
    if any(a < -slack or b > length + slack for a, b, length in zip(lower, upper, case.domain.size)):
        raise CaseError(f"{key} reaches out of the domain, domain.size_m = {list(case.domain.size)}; move it or enlarge the domain")


def side(case, where: str, boundary) -> None:
    """A boundary lies on a side that the domain has, and its span, [low, high] on each axis along it, on that side."""
    if boundary.side and SIDES[boundary.side][0] >= case.dimensions:
        there = list(SIDES)[: 2 * case.dimensions]
        raise CaseError(
            f"{where}.side = {boundary.side!r}; a case of {case.dimensions} dimensions has {', '.join(there)}"
        )
    if boundary.span is None:
        return
    if boundary.side is None:
        raise CaseError(f"{where}.span_m is given without a side; add it, or remove the span")
    lengths = [length for axis, length in enumerate(case.domain.size) if axis != SIDES[boundary.side][0]]
    for (low, high), length in zip(_pairs(where, boundary.span, len(lengths)), lengths):
        if low < -SAME * length or high > length * (1.0 + SAME):
            raise CaseError(
                f"{where}.span_m goes from {low:g} to {high:g} m; the box goes from 0 to {length:g} m there"
            )


def _pairs(where: str, span: tuple, count: int) -> tuple:
    """(low, high) on each of `count` axes."""
    pairs = span if any(isinstance(part, tuple) for part in span) else (span,)
    if len(pairs) != count or not all(map(_is_pair, pairs)):
        raise CaseError(
            f"{where}.span_m = {list(span)}; give [low, high] on each axis along its side, of which there are {count}"
        )
    return pairs


def _is_pair(part) -> bool:
    return (
        isinstance(part, tuple)
        and len(part) == 2
        and not any(isinstance(end, tuple) for end in part)
        and part[0] < part[1]
    )
