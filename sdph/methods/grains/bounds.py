"""Bounds of grains and their gas, past which a run has gone unstable."""

from __future__ import annotations

import math

import numpy as np
from numba import prange

from sdph.effects.gas import turbulent_dispersion
from sdph.engine import arrays, ashore
from sdph.engine import state as particles
from sdph.engine.guard import DENSE, FAR, RUNAWAY, TINY, Watch, outside
from sdph.engine.kept import Unfit
from sdph.laws.compiled import inner
from sdph.laws.constants import ADIABATIC, GAS_CONSTANT
from sdph.methods.grains.scales import scales_of

# times what drives the grains: sound that is faster shrinks the sub-steps until a run gets nowhere; our choice
COLLAPSE = 1e3
LATENT = 0.25  # of the hottest: how far below the coldest evaporation may cool; our choice


class Guard(Watch):
    """Looks at the grains after every sub-step, at its length too, and at the gas after every window."""

    def __init__(self, case):
        super().__init__(case)
        scales = scales_of(case)
        drop = math.sqrt(2.0 * (scales.gravity + math.hypot(*scales.field)) * max(case.domain.size))
        pressures = [b.pressure for b in case.boundaries.values() if b.pressure is not None]
        blown = math.sqrt(2.0 * (max(pressures, default=0.0) - min(pressures, default=0.0)) / case.gas.density)
        agitated = math.sqrt(case.grains.granular_temperature) + scales.sound
        driven = scales.jet + scales.eddies + scales.rush + scales.thrown + drop + blown + agitated
        self.reach = case.run.fastest / RUNAWAY if case.run.fastest else driven
        given = case.temperatures
        stored = min(grains.heat_capacity for grains in case.kinds)
        slack = scales.span + LATENT * max(given) + self.reach**2 / stored
        self.coldest, self.hottest = max(0.0, min(given) - slack), max(given) + slack
        self.sound = math.sqrt(ADIABATIC * GAS_CONSTANT / case.gas.molar_mass * max(given))
        self.cause, self.length = "largest", case.coupling.window_largest  # until the first window begins

    def rule(self, dt: float, cause: str) -> None:
        """The window that comes is of `dt` [s], ruled by `cause`."""
        self.cause, self.length = cause, dt

    def admit_grains(self, state: dict, names, heaviest: float) -> None:
        """`admit` of grains, none of more than `heaviest` [kg]."""
        speed, positive, zero_on = (-RUNAWAY * self.reach, RUNAWAY * self.reach), (TINY, math.inf), (0.0, math.inf)
        size = FAR * max(grains.diameter for grains in self.case.kinds)
        bounds = dict.fromkeys("uvw", speed) | dict.fromkeys(("diameter", "born_diameter"), (TINY, size))
        bounds |= dict.fromkeys(("diameter_variance", "born_variance"), (0.0, size**2))
        bounds |= dict.fromkeys(("lost_still", "lost_moving", "lost_kinetic"), zero_on) | {"born_mass": positive}
        bounds |= {
            "mass": (TINY, heaviest * (1.0 + 1e-9)),  # layers by `rates` are heavier by round-off, 2e-13 measured
            "density": (0.0, DENSE * max(grains.density for grains in self.case.kinds)),
            "evaporating": (0.0, 1.0),
        }
        bounds |= {"temperature": (self.coldest, self.hottest), "theta": (0.0, (COLLAPSE * self.reach) ** 2)}
        bounds |= {"sealed": (0.0, 1.0), "throwing": zero_on, "bubble_void": (0.0, size**3)}
        bounds |= {"deformation": (-math.inf, 1.0), "weber": zero_on, "wall_age": zero_on, "entered": zero_on}
        bounds |= {"material": (0, len(self.case.kinds) - 1)} | {
            name: (min(own), max(own))
            for name, own in zip(particles.OF_MATERIAL[1:], zip(*(grains.of_particles for grains in self.case.kinds)))
        }
        bounds |= dict.fromkeys(turbulent_dispersion.AXES, (-math.inf, math.inf))
        bounds |= {"nozzle": (0, len(self.case.nozzles)), "entering": (0, 1)}
        kinds = [particles.GRAIN, particles.INFLOW]
        self.admit(state, names, bounds)
        if not np.isin(state["kind"], kinds).all():
            raise Unfit("a particle is neither a grain nor of a nozzle")

    def admit_gas(self, fields: dict) -> None:
        """Unfit where gas that comes from a checkpoint is faster, hotter or colder than this case allows.

        No pressure is too high: what sets a gas of low Mach number off at once goes as one over the window.
        """
        for name, values, bounds in self._of_gas(fields):
            worst = outside(values, *bounds[:2])
            if worst is not None:
                low, high, unit = bounds
                raise Unfit(
                    f"gas {name} of cell {worst} is {values[worst]:.3g} {unit}; this case allows {low:.3g} to "
                    f"{high:.3g}"
                )

    def sub_step(self, stepper) -> None:
        """Look, after a sub-step, for NaN, speed, temperature of the particles."""
        s, most = stepper.own, RUNAWAY * self.reach
        sound = stepper.scratch.sound[: len(s.x)]
        if not beyond(s, sound, most, COLLAPSE * self.reach, self.coldest, self.hottest):
            return
        with ashore.ashore(stepper):
            self._name(stepper, arrays.brought(sound), most)

    def _name(self, stepper, sound, most: float) -> None:
        """Unstable, by the particle that is worst."""
        s = stepper.own
        ruled = f"the sub-step was ruled by {stepper.limit or 'the window'}"
        lower = f"run.step_factor (now {self.case.run.step_factor:g}; {ruled}), then {self._shorter()}"
        fast = f"{lower}; if shorter steps come as fast, they are that fast: give run.fastest_m_s"
        speed = np.sqrt(s.u**2 + s.v**2 + (s.w**2 if len(s.w) else 0.0))
        self.hold("speed", speed, (0.0, most, "m/s"), s, fast)
        if len(s.temperature):
            self.hold("temperature", s.temperature, (self.coldest, self.hottest, "K"), s, lower)
        self.hold("density", s.density, (0.0, math.inf, "kg/m3"), s, lower)
        collapse = f"what packs the grains: the sub-step has fallen to {stepper.length:.2g} s"
        self.hold("speed of sound", sound, (0.0, COLLAPSE * self.reach, "m/s"), s, collapse)

    def gas(self, fields: dict, centres) -> str | None:
        """Name what is out of bounds in the gas after a window, NaN, speed or temperature; None where nothing is."""
        for name, values, bound in self._of_gas(fields):
            worst = outside(values, *bound[:2])
            if worst is not None:
                return self._told(f"gas {name}", f"cell {worst}", centres[worst], values[worst], bound)
        return None

    def _of_gas(self, fields: dict):
        """(name, values (C,), bounds) of what is looked at."""
        bounds = {"velocity": (0.0, RUNAWAY * self.sound, "m/s"), "temperature": (self.coldest, self.hottest, "K")}
        for name, bound in bounds.items():
            yield name, fields[name] if fields[name].ndim == 1 else particles.lengths(fields[name]), bound

    def _shorter(self) -> str:
        return f"coupling.window_largest_s below {self.length:.3g} (the window was ruled by {self.cause})"


@inner
def beyond(s, sound, fastest, loudest, coldest, hottest):
    """Number of the particles that are faster or louder [m/s], colder or hotter [K] than that, or of which something is
    no number."""
    found = 0.0
    for i in prange(len(s.x)):
        w = s.w[i] if len(s.w) else 0.0
        fine = s.u[i] * s.u[i] + s.v[i] * s.v[i] + w * w <= fastest * fastest
        fine &= 0.0 <= sound[i] <= loudest
        fine &= 0.0 <= s.density[i] < math.inf
        if len(s.temperature):
            fine &= coldest <= s.temperature[i] <= hottest
        found += 0.0 if fine else 1.0
    return found
