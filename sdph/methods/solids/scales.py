"""Orders of magnitude of a case with solids, from the case alone: what its effects judge themselves by."""

from __future__ import annotations

import dataclasses
import math
from functools import cached_property

from sdph import effects
from sdph.engine import state as particles
from sdph.methods.solids import start

SLENDER = 3.0  # lengths over widths from which on a body bends rather than shears; our choice


class SolidScales:
    """Scales of a case, SI."""

    jet = 0.0  # no gas drives it

    def __init__(self, case):
        self.case, self.solid, self.end = case, case.solid, case.run.end_time
        self.made = start.Made(case)
        self.state = self.made.state
        self.gravity = math.hypot(*case.domain.gravity)
        self.sound = start.sound(case)

    @cached_property
    def thrown(self) -> float:
        """Fastest particle at the start [m/s]."""
        return float(particles.lengths(particles.velocities(self.state)).max())

    @cached_property
    def width(self) -> float:
        """Narrowest extent [m] of a body at the start; of a ring its thickness."""
        return min(_width(body) for body in self.case.bodies.values())

    @cached_property
    def slender(self) -> float:
        """Narrowest extent [m] of a body that is SLENDER times as long, and so bends; inf without any. Rings, which as
        a rule bear a pressure by the stress around them, do not count."""
        bodies = [body for body in self.case.bodies.values() if body.shape != "ring"]
        return min((_width(body) for body in bodies if _length(body) >= SLENDER * _width(body)), default=math.inf)


def _length(body) -> float:
    """Longest extent [m] of a body that is no ring."""
    if body.shape == "box":
        return max(b - a for a, b in zip(body.lower, body.upper))
    return max(2.0 * body.radius, body.length or 0.0)


def _width(body) -> float:
    if body.shape == "box":
        return min(b - a for a, b in zip(body.lower, body.upper))
    return body.radius - body.inner_radius if body.shape == "ring" else min(2.0 * body.radius, body.length or math.inf)


def scales_of(case) -> SolidScales:
    """Scales of a case as if every effect that can judge itself and needs no input had its section."""
    return SolidScales(dataclasses.replace(case, parameters=effects.without_input("solid") | case.parameters))
