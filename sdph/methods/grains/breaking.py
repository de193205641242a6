"""Drops of a case that are the likeliest to break: those with the largest Weber number."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from sdph.methods.grains import ways


class Breaking(NamedTuple):
    """Slip [m/s] and diameter [m] of drops; whether that is the slip of drops that fly across gas that is let in."""

    slip: float
    diameter: float
    across: bool = False


def likeliest(s) -> Breaking:
    """Drops with the largest Weber number, of the grains and of what nozzles give: by the slip of the case, and by that
    in the gas that is let in. `s`: scales."""
    found = [Breaking(s.slip, s.grains.diameter)]
    streams = [
        np.array(b.strongest) * ways.strength(s.case, b, s.patches) for b in s.case.boundaries.values() if b.lets_in
    ]
    for patch in s.patches:
        diameter = patch.largest or s.grains.diameter
        found.append(Breaking(s.slip, diameter))
        met = (math.hypot(*(np.array(patch.velocity) - stream)) for stream in streams)
        found += [Breaking(slip, diameter, True) for slip in met if slip > s.slip]
    return max(found, key=lambda one: one.slip**2 * one.diameter)
