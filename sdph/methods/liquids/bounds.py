"""Catches a liquid that goes unstable, within the steps of one window.

Weakly compressible means slow: sound is chosen ten times as fast as the liquid (liquids.md, shared core), so that a
particle as fast as sound is past all that the case foresaw.
"""

from __future__ import annotations

import sys

import numpy as np

from sdph import effects
from sdph.engine import state as particles
from sdph.engine.guard import DENSE, RUNAWAY, TINY, Watch
from sdph.engine.kept import Unfit


class LiquidGuard(Watch):
    """Looks at all particles after every window, and at once when the fastest outruns sound."""

    def admit_liquid(self, state: dict, fresh, kinds) -> None:
        """`admit` of a liquid and its walls that began as the State `fresh`; `kinds` that there are."""
        fast = RUNAWAY * self.case.fastest_sound
        bounds = dict.fromkeys("uvw", (-fast, fast)) | {"mass": (TINY, fresh.mass.max()), "ident": (0, len(fresh.x) - 1)}
        self.admit(state, effects.arrays(self.case), bounds | {"density": (fresh.density.min() / DENSE, fresh.density.max() * DENSE)})
        if not np.isin(state["kind"], kinds).all():
            raise Unfit("a particle is of no phase and of no wall")

    def look(self, stepper) -> None:
        """NaN, speed, density, acceleration."""
        s, own = stepper.state, self.case
        self.time = stepper.time
        lower = (
            f"run.step_factor (now {own.run.step_factor:g}; the step was ruled by {stepper.limit or 'sound'}); where the liquid is meant "
            f"to be so fast, raise liquid.sound_speed_m_s (now {own.liquid.sound_speed:g}) to ten times its speed"
        )
        wet = particles.take(s, stepper.active)
        speed, sound = np.sqrt((particles.velocities(wet) ** 2).sum(axis=1)), own.fastest_sound
        self.hold("speed", speed, (0.0, sound, "m/s"), wet, lower)
        self.hold("density", wet.density, (sys.float_info.min, sys.float_info.max, "kg/m3"), wet, lower)
        size = np.sqrt((stepper.acceleration[stepper.active] ** 2).sum(axis=1))
        self.hold("acceleration", size, (0.0, sys.float_info.max, "m/s2"), wet, lower)
