"""Checks that probes, nozzles, regions and boundaries lie in the domain; each raises a CaseError."""

from __future__ import annotations

import math

from sdph.case import bodies, probed
from sdph.engine.geometry import SIDES
from sdph.laws.constants import ROUND_OFF
from sdph.schema import CaseError

# of a spacing: nearer to a side nothing tells inside from outside (contact holds grains a quarter away), and meshes of
# snappyHexMesh, written with six digits, end there; our choice
NEAR = 1e-3


def probe(case, where: str, own) -> None:
    """A probe lies in the domain, and in a body where there is nothing else, and what it follows is there."""
    if case.matters == ("solid",):
        bodies.check_probe(case, where, own)
    inside(case, where, own.at, own.at)
    probed.check(case, where, own)


def mouth(case, where: str, nozzle) -> None:
    """The middle of a nozzle's mouth lies in the domain, and so does what lies half a spacing ahead of it."""
    if len(nozzle.centre) != case.dimensions or len(nozzle.direction) != case.dimensions:
        return  # the effect says so
    inside(case, f"{where}.centre_m = {list(nozzle.centre)}", nozzle.centre, nozzle.centre)
    length = max(math.hypot(*nozzle.direction), math.ulp(0.0))
    ahead = [c + 0.5 * case.resolution.spacing * a / length for c, a in zip(nozzle.centre, nozzle.direction)]
    inside(case, f"{where}.direction = {list(nozzle.direction)} at centre_m = {list(nozzle.centre)}", ahead, ahead)


def inside(case, key: str, lower, upper) -> None:
    """CaseError where a region from `lower` to `upper`, given by `key`, reaches out of the domain."""
    slack = max(ROUND_OFF * max(case.domain.size), NEAR * case.resolution.spacing)
    low, high = case.domain.corner, case.domain.upper
    if any(a < c - slack or b > d + slack for a, b, c, d in zip(lower, upper, low, high)):
        begins = f" from domain.lower_m = {list(low)}" if any(low) else ""
        raise CaseError(
            f"{key} reaches out of the domain, domain.size_m = {list(case.domain.size)}{begins}; move it or enlarge "
            "the domain (left out, it is the box around a mesh of your own in the folder gas)"
        )


def side(case, where: str, boundary) -> None:
    """A boundary lies on a side that the domain has, and its span, [low, high] on each axis along it, on that side."""
    if boundary.side and SIDES[boundary.side][0] >= case.dimensions:
        there = list(SIDES)[: 2 * case.dimensions]
        raise CaseError(
            f"{where}.side = {boundary.side!r}; a case of {case.dimensions} dimensions has {', '.join(there)}"
        )
    slides = boundary.kind == "wall" and boundary.velocity and any(boundary.velocity)
    if slides and (boundary.side is None or boundary.velocity[SIDES[boundary.side][0]] != 0.0):
        given = f"{where}.velocity_m_s = {list(boundary.velocity)}"
        raise CaseError(f"{given}; a wall slides along its side: name the side, and give 0 at right angles to it")
    stuck = boundary.kind in ("wall", "slip_wall") and {"walls", "outflow"}.issubset(case.effects)
    if boundary.catches and not stuck:
        raise CaseError(
            f"{where}.catches is of a wall, and of the effects walls and outflow: add these, or leave it out"
        )
    if boundary.span is None:
        return
    if boundary.side is None:
        raise CaseError(f"{where}.span_m is given without a side; add it, or remove the span")
    ends = list(zip(case.domain.corner, case.domain.upper))
    del ends[SIDES[boundary.side][0]]
    for (low, high), (first, last) in zip(_pairs(where, boundary.span, len(ends)), ends):
        if low < first - ROUND_OFF * (last - first) or high > last + ROUND_OFF * (last - first):
            raise CaseError(
                f"{where}.span_m goes from {low:g} to {high:g} m; the box goes from {first:g} to {last:g} m there"
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
