"""Slices across an axis, or rings about one, into which a profile parts the cells of the gas."""

from __future__ import annotations

import math
import re

import numpy as np

from sdph.schema import CaseError

RINGS = "r"
FILE = re.compile(r"[\w-]+")
DIGITS = 12  # of edges [m]: no round-off in tables
MOST_SLICES = 10_000  # slices; our choice


def check(case, where: str, own) -> None:
    """CaseError where a profile is not of a case that has cells, or its keys do not fit."""
    if not FILE.fullmatch(where.partition(".")[2]):
        raise CaseError(f"{where} names a file; give a name of letters, digits, _ and - alone")
    if not case.grains:
        raise CaseError(
            f"{where} is of grains in a gas; of a liquid or solids take sdph.load(RUN).line() or leave it out"
        )
    if own.along not in ("x", "y", "z")[: case.dimensions] and not _rings(case, where, own):
        raise CaseError(f'{where}.along = "z"; this case has the axes x and y')
    _check_places(case, where, own)
    if (count := len(edges(case, own)) - 1) > MOST_SLICES:
        raise CaseError(
            f"{where}.slice_m = {own.slice:g} makes {count} slices; give at most {MOST_SLICES}: thicker ones"
        )


def _check_places(case, where: str, own) -> None:
    """CaseError where places are not of the case's dimensions, or make no box."""
    for name in ("lower", "upper", "centre"):
        place = getattr(own, name)
        if place is not None and len(place) != case.dimensions:
            raise CaseError(f"{where}.{name}_m = {list(place)}; it must have {case.dimensions} components")
    if own.lower and own.upper and any(a >= b for a, b in zip(own.lower, own.upper)):
        given = f"upper_m = {list(own.upper)} is not above lower_m = {list(own.lower)}"
        raise CaseError(f"{where}: {given} along every axis; widen the box")


def _rings(case, where: str, own) -> bool:
    """True of rings; CaseError where they lack what they need."""
    if own.along != RINGS:
        return False
    if case.dimensions < 3:
        raise CaseError(f'{where}.along = "r" is of three dimensions; in two give x or y')
    if own.centre is None:
        raise CaseError(f"{where}.centre_m is missing; rings are about an axis through it: give a place on that")
    return True


def edges(case, own) -> np.ndarray:
    """Edges (n + 1,) [m] of the slices of a profile: all of one thickness, that which is asked for or nearly."""
    low, high = _reach(case, own)
    thickness = own.slice or case.resolution.cell
    return np.linspace(low, high, max(1, round((high - low) / thickness)) + 1).round(DIGITS)


def _reach(case, own) -> tuple[float, float]:
    """From where to where [m] a profile goes."""
    corner, upper = own.lower or case.domain.corner, own.upper or case.domain.upper
    if own.along != RINGS:
        axis = "xyz".index(own.along)
        return corner[axis], upper[axis]
    across = [axis for axis in range(3) if "xyz"[axis] != own.axis]
    return 0.0, math.hypot(*(max(upper[a] - own.centre[a], own.centre[a] - corner[a]) for a in across))


def places(own, points: np.ndarray) -> np.ndarray:
    """(N,) [m] of points (N, 3) [m] on the way that a profile goes: a coordinate, or the distance from an axis."""
    if own.along != RINGS:
        return points[:, "xyz".index(own.along)]
    across = ["xyz".index(axis) for axis in "xyz" if axis != own.axis]
    return np.linalg.norm(points[:, across] - np.array(own.centre)[across], axis=1)


def within(case, own, points: np.ndarray) -> np.ndarray:
    """(N,) bool: which of points (N, 3) [m] are in the box of a profile."""
    d = case.dimensions
    low, high = own.lower or (-math.inf,) * d, own.upper or (math.inf,) * d
    return ((points[:, :d] >= low) & (points[:, :d] <= high)).all(axis=1)
