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
    span = boundary.span or (0.0, case.domain.size[along])
    return along, *(span[0] if isinstance(span[0], tuple) else span)


def over_mean(case, boundary, places) -> np.ndarray:
    """Velocity over its mean (n,) at places (n,) [m] along the side of a boundary that has a parabola."""
    _, low, high = extent(case, boundary)
    share = (places - low) / (high - low)
    return 6.0 * share * (1.0 - share)


def check(case, own_mesh: bool = False) -> None:
    """CaseError where a profile is asked for that is not known, as on a mesh of one's own."""
    for name, own in case.boundaries.items():
        known = own.kind == "velocity_inlet" and own.side is not None and case.dimensions == 2 and not own_mesh
        if own.profile != "uniform" and not known:
            raise CaseError(
                f"boundaries.{name}.profile = {own.profile!r}; it is known for a velocity_inlet on a named side of a "
                "box in two dimensions, whose mesh is made from the case; leave it out (a velocity of any form is a "
                "file 0/U in the folder gas)"
            )
