"""Grains that conduct: at rest through a window, or asked for by who tells of one of them."""

from __future__ import annotations

import numpy as np

from sdph.engine import state as particles
from sdph.methods.grains import equations as rates


class Conducting:
    """The part of the grains' stepper that knows conduction alone."""

    def conduct(self, dt: float) -> None:
        """Grains at rest through a window of `dt` [s]: conduction, and heat from the gas spread evenly."""
        left = dt
        while left > 0.0:
            step = left / self._parts(left)
            self._warm(step * self._conducted() + step / dt * self.state.warmth / self.state.mass)
            self.steps += 1
            self.guard.sub_step(self)
            left = 0.0 if step >= left else left - step
        self.tell()

    def _conducted(self) -> np.ndarray:
        """Heat (N,) [W/kg] that the particles get from their neighbours now."""
        heating = np.zeros(len(self.state.x))
        rates.conduct(*self._of_conduction(), heating)
        return heating

    def _of_conduction(self) -> tuple:
        p, own = self.parameters["conduction"], self.scratch.packed
        rates.pack(p, self.state, own)
        return self.kernel, self.state, self.rows, self.neighbours.box, self.scratch.pull, p, own

    def conduction_rate(self, i: int) -> float:
        """Heat [W] that particle i gets from its neighbours now."""
        return rates.heat_to(*self._of_conduction(), int(i))

    def _warm(self, heat) -> None:
        """Put heat per mass (N,) [J/kg] into the temperature, where there is one."""
        if not len(self.state.temperature):
            return
        self.state.temperature[:] += heat / particles.by_material(
            self.state.grain_capacity, self.case.grains.heat_capacity
        )
        self.domain.refresh(self.state.temperature)
