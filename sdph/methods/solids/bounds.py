"""Catches solids that go unstable, within the steps of one window: no particle outruns sound in its own body."""

from __future__ import annotations

import sys

import numpy as np

from sdph.engine import state as particles
from sdph.engine.guard import RUNAWAY, TINY, Unstable, Watch
from sdph.engine.kept import Unfit
from sdph.engine.state import SOLID
from sdph.methods.solids import start


class SolidGuard(Watch):
    """Looks at all particles after every window."""

    def admit_solid(self, state: dict, fresh) -> None:
        """`admit` of bodies that began as the State `fresh`: the same particles in the same order."""
        fast = RUNAWAY * start.sound(self.case)
        bounds = dict.fromkeys("uvw", (-fast, fast)) | {"mass": (TINY, fresh.mass.max())}
        self.admit(state, (), bounds)
        if not np.array_equal(state["ident"], fresh.ident) or (state["kind"] != SOLID).any():
            raise Unfit("its particles are not those of the bodies of this case")

    def look(self, stepper) -> None:
        """NaN, speed, acceleration."""
        s = stepper.state
        self.time = stepper.time
        lower = (
            f"run.step_factor (now {self.case.run.step_factor:g}; the step was ruled by {stepper.limit or 'waves'}), "
            "or the load: an element may have been turned inside out"
        )
        speed, sound = particles.lengths(particles.velocities(s)), start.sound(self.case)
        self.hold("speed", speed, (0.0, sound, "m/s"), s, lower)
        size = particles.lengths(stepper.acceleration)
        self.hold("acceleration", size, (0.0, sys.float_info.max, "m/s2"), s, lower)
        if stepper.cavity:
            self._look_for_tears(stepper)

    def refuse_inverted(self, stepper, inverted) -> None:
        """Unstable where particles, by a mask (N,), are turned inside out, as no strain is told there."""
        if not inverted.any():
            return
        i = int(inverted.argmax())
        which, place = f"bodies.{list(self.case.bodies)[stepper.body[i]]}", particles.positions(stepper.state)[i]
        ratio = float(np.linalg.det(stepper.gradient[i].reshape(3, 3)))
        remedy = "it is turned inside out: lower run.step_factor or the load, or let it fail (solid.failure)"
        self.stop("volume over the undeformed one", which, place, ratio, (0.0, np.inf, "-"), remedy)

    def _look_for_tears(self, stepper) -> None:
        """Unstable where a ring that is inflated has torn: what fills it would have run out."""
        name = self.case.parameters["inflation"].body
        if not stepper.free[stepper.body == list(self.case.bodies).index(name)].any():
            return
        ratio = stepper.cavity.diameter_ratio(stepper.state, stepper.reference)
        raise Unstable(
            f"bodies.{name} tore at t = {self.time:.6g} s, at D/D0 = {ratio:.4g}: "
            "inflation knows no tear; end the run before (run.end_time_s), or fill the ring with a liquid that has a "
            "bubble of vapour (effects bubble and time_scaling)",
            self.last,
        )
