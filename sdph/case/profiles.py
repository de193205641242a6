"""Velocity of gas along an inlet over its mean: 6 s (1 - s) of a parabola, s from 0 to 1 across the inlet.

It is that of a developed laminar flow between two plates: Bird, Stewart & Lightfoot 2002, Eq. 2B.3-2. Both gas solvers
take it at the middles of faces: over N equal ones its mean is 1 + 1/(2 N^2).
"""

from __future__ import annotations

import numpy as np

from sdph.engine.geometry import SIDES
from sdph.schema import CaseError


def extent(case, boundary) -> tuple[int, float, float]:
    """Axis along the side of a plane case, and from where to where [m] the boundary goes on it."""
    along = 1 - SIDES[boundary.side][0]
    return along, *(boundary.span or (0.0, case.domain.size[along]))


def over_mean(case, boundary, places) -> np.ndarray:
    """Velocity over its mean (n,) at places (n,) [m] along the side of a boundary that has a parabola."""
    _, low, high = extent(case, boundary)
    share = (places - low) / (high - low)
    return 6.0 * share * (1.0 - share)


def check(case, where: str, boundary) -> None:
    """CaseError where a profile is asked for that is not known."""
    if boundary.profile == "uniform":
        return
    if boundary.kind != "velocity_inlet" or boundary.side is None or case.dimensions != 2 or any(case.domain.corner):
        raise CaseError(
            f"{where}.profile = {boundary.profile!r}; it is known for a velocity_inlet on a named side of a box in two "
            'dimensions; leave it out, or give "U" in a file of your own in gas/0'
        )
