"""Orders of magnitude of a case with a liquid, from the case alone: what its effects judge themselves by."""

from __future__ import annotations

import dataclasses
import math
from functools import cached_property

import numpy as np

from sdph import effects
from sdph.effects.around import frame, tank
from sdph.engine import state as particles
from sdph.engine.state import LIQUID
from sdph.methods.liquids import start


class LiquidScales:
    """Scales of a case, SI. U is the most that the liquid can reach, not what it will."""

    jet = 0.0  # no gas drives it

    def __init__(self, case):
        self.case, self.liquid, self.end = case, case.liquid, case.run.end_time
        self.state = start.fill(case)
        self.wet = self.state.kind == LIQUID  # not the second phase
        self.gravity = math.hypot(*case.domain.gravity)
        self.periodic = np.array(self.liquid.periodic or [0.0] * case.dimensions) > 0.0
        self.viscosity = self.liquid.viscosity / self.liquid.density  # kinematic [m2/s]

    @cached_property
    def extents(self) -> np.ndarray:
        """(d,) of the liquid at the start [m]; of what nozzles let in, where there is none, that of the domain."""
        if not self.wet.any():
            return np.array(self.case.domain.size)
        return np.array([np.ptp(axis[self.wet]) for axis in particles.axes(self.state)]) + self.case.resolution.spacing

    @cached_property
    def length(self) -> float:
        """Narrowest extent [m], periodic axes left out where there are others."""
        return float(self.extents[~self.periodic if not self.periodic.all() else self.periodic].min())

    @cached_property
    def thrown(self) -> float:
        """Fastest liquid at the start, or out of a nozzle [m/s]."""
        let_in = max((nozzle.speed for nozzle in self.case.nozzles.values()), default=0.0)
        return float(particles.lengths(particles.velocities(self.state)[self.wet]).max(initial=let_in))

    @cached_property
    def shaken(self) -> float:
        """Largest acceleration [m/s2] by the frame: of its origin, of its rotation and its rate at the far end of the
        domain."""
        if "frame" not in self.case.effects:
            return 0.0
        move, arm = frame.felt(self.case), self.case.domain.arm
        found = [move(time) for time in np.linspace(0.0, self.end, frame.LOOKS)]
        return max(float(np.linalg.norm(a) + arm * (omega @ omega + np.linalg.norm(rate))) for a, omega, rate in found)

    @cached_property
    def pull(self) -> tuple[float, float]:
        """Gravity [m/s2] towards walls or free surfaces, and along periodic axes."""
        gravity = (
            np.array(self.case.domain.gravity) if "gravity" in self.case.effects else np.zeros(self.case.dimensions)
        )
        return float(np.linalg.norm(gravity[~self.periodic])), float(np.linalg.norm(gravity[self.periodic]))

    @cached_property
    def fall(self) -> float:
        """Way [m] along gravity from the highest liquid at the start down to the floor of its tank, or of the domain;
        0 without either."""
        gravity = np.where(self.periodic, 0.0, self.case.domain.gravity)
        if not self.wet.any() or not gravity.any():
            return 0.0
        down, domain = gravity / np.linalg.norm(gravity), self.case.domain
        if "tank" in self.case.effects:
            floor = tank.shape_of(self.case).furthest(down)
        else:
            floor = float(np.maximum(*(np.multiply(end, down) for end in (domain.corner, domain.upper))).sum())
        levels = np.stack([axis[self.wet] for axis in particles.axes(self.state)], axis=1) @ down
        return max(0.0, floor - float(levels.min()) + 0.5 * self.case.resolution.spacing)

    @cached_property
    def height(self) -> float:
        """Extent [m] along gravity, along the last axis where there is none."""
        gravity = np.where(self.periodic, 0.0, self.case.domain.gravity)
        if not gravity.any():
            return float(self.extents[-1])
        return float(np.abs(gravity) @ self.extents / np.linalg.norm(gravity))

    @cached_property
    def speed(self) -> float:
        """U [m/s]: thrown; fallen by its own height, or on to the floor as far as the run lets it; shaken across its
        length; driven along a channel until friction holds it."""
        across, along = self.pull
        fallen = math.sqrt(2.0 * across * self.height)
        fallen = max(fallen, min(across * self.end, math.sqrt(2.0 * across * self.fall)))
        driven = min(along * self.end, along * self.length**2 / (8.0 * self.viscosity) if self.viscosity else math.inf)
        swung = min(self.shaken * self.end, math.sqrt(2.0 * self.shaken * float(self.extents.max())))
        return max(self.thrown, fallen, driven, swung)

    def capillary(self, sigma: float) -> tuple[float, float]:
        """Weber and Bond numbers of a surface tension [N/m]."""
        rho, pull = self.liquid.density, self.pull[0] + self.shaken
        return rho * self.speed**2 * self.length / sigma, rho * pull * self.length**2 / sigma

    @cached_property
    def turns(self) -> float:
        """U t/L: how often the liquid has gone its own length."""
        return self.speed * self.end / self.length

    @cached_property
    def layer(self) -> float:
        """sqrt(nu t)/L: how far the momentum of a wall gets into the liquid."""
        return math.sqrt(self.viscosity * self.end) / self.length


def scales_of(case) -> LiquidScales:
    """Scales of a case as if every effect that can judge itself and needs no input had its section."""
    parameters = effects.without_input("liquid") | case.parameters
    return LiquidScales(dataclasses.replace(case, parameters=parameters))
