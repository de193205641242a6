"""Catches moving particles that go unstable: none is far faster than what drives them."""

from __future__ import annotations

import math

import numpy as np

from sdph.engine import arrays, linear
from sdph.engine import state as particles
from sdph.engine.guard import RUNAWAY, TINY, Unstable, Watch
from sdph.engine.kept import Unfit
from sdph.engine.state import INFLOW, LIQUID, WALL
from sdph.methods.mps import alone


class MpsGuard(Watch):
    """Looks at all particles after every window."""

    @property
    def fast(self) -> float:
        """Speed [m/s] that no particle reaches: RUNAWAY times nozzles, pools, a fall through the domain and what
        tension gives one particle, taken together; infinite where there is none of these."""
        case = self.case
        driven = [n.speed * math.hypot(1.0, n.swirl) for n in case.nozzles.values()]
        driven += [math.hypot(pool.speed, *(pool.velocity or ())) for pool in case.pools.values()]
        driven.append(math.sqrt(2.0 * math.hypot(*case.domain.gravity) * max(case.domain.size)))
        if own := case.parameters.get("free_energy_tension"):
            driven.append(math.sqrt(2.0 * own.coefficient / (case.liquid.density * case.resolution.spacing)))
        return RUNAWAY * sum(driven) or math.inf  # nothing drives it: round-off alone moves it

    def admit_mps(self, state: dict) -> None:
        """`admit` of moving particles."""
        case = self.case
        most = 2.0 * case.liquid.density * case.resolution.spacing**case.dimensions
        names = ("pressure", "nozzle", "entering") if "inflow" in case.effects else ("pressure",)
        self.admit(state, names, dict.fromkeys("uvw", (-self.fast, self.fast)) | {"mass": (TINY, most)})
        if not set(state["kind"].tolist()) <= {LIQUID, INFLOW, WALL}:
            raise Unfit("its particles are not those of a liquid")

    def look(self, stepper) -> None:
        """NaN, speed."""
        self.time = stepper.time
        if not alone.runaways(stepper.state, self.fast):
            return
        s = particles.brought(stepper.state)
        lower = f"run.step_factor (now {self.case.run.step_factor:g}; the step was ruled by {stepper.limit})"
        self.hold("speed", particles.lengths(particles.velocities(s)), (0.0, self.fast, "m/s"), s, lower)

    def unsolved(self, stepper, error, *terms) -> None:
        """Stop a run whose pressure has not come to its tolerance, or whose equations hold what is no number among the
        `terms` (N,) of its particles."""
        own = self.case.method
        mend = f"raise method.iterations (now {own.iterations}) or method.tolerance (now {own.tolerance:g})"
        if isinstance(error, linear.Undefined):
            mend = (
                f"{self._undefined(stepper, terms)}; more iterations do not help: look at the walls and pools there, "
                f"or lower run.step_factor (now {self.case.run.step_factor:g})"
            )
        raise Unstable(f"the pressure was not found at t = {stepper.time:.6g} s: {error}; {mend}", self.last)

    def _undefined(self, stepper, terms) -> str:
        """Name the particles whose equations, pressure, place or velocity are no numbers."""
        s = particles.brought(stepper.state)
        values = *map(arrays.brought, terms), s.pressure, *particles.positions(s).T, *particles.velocities(s).T
        bad = np.flatnonzero(~np.isfinite(values).all(axis=0))
        if not len(bad):
            return "every equation holds numbers, but their sums do not"
        at = ", ".join(f"{a:.4g}" for a in particles.positions(s)[bad[0]][: self.case.dimensions])
        first = f"the first is particle {s.ident[bad[0]]} at ({at}) m"
        return f"equations of {len(bad)} particles hold what is no number, {first}"
