"""Catches a liquid that goes unstable, within the steps of one window.

Weakly compressible means slow: sound is chosen ten times as fast as the liquid (liquids.md, shared core), so that a
particle as fast as sound is past all that the case foresaw.
"""

from __future__ import annotations

import math
import sys
from typing import NamedTuple

import numpy as np
from numba import prange

from sdph import effects
from sdph.engine import ashore
from sdph.engine import state as particles
from sdph.engine.guard import DENSE, FAR, RUNAWAY, TINY, Watch
from sdph.engine.kept import Unfit
from sdph.engine.state import GAS, INFLOW, LIQUID, WALL
from sdph.laws.compiled import parallel
from sdph.methods.liquids.totals import squared_speed

FORCE = 0.25  # of sqrt(h/|a|), liquids.md, shared core


class Born(NamedTuple):
    """Particles that a liquid and its walls began with, their mass, the largest one, and that of liquid, streams that
    wait among it [kg], and the ends of their densities [kg/m3]."""

    particles: int
    mass: float
    heaviest: float
    heaviest_liquid: float
    thinnest: float
    densest: float


def born(state, world) -> Born:
    """`Born` of a State of the start, of which each process of a world has a part."""
    liquid = world.most(float(state.mass[particles.wet(state) | (state.kind == INFLOW)].max(initial=0.0)))
    thinnest, densest = float(state.density.min(initial=np.inf)), float(state.density.max(initial=0.0))
    whole, heaviest = world.sum(float(state.mass.sum())), world.most(float(state.mass.max(initial=0.0)))
    return Born(world.sum(len(state.x)), whole, heaviest, liquid, world.least(thinnest), world.most(densest))


class LiquidGuard(Watch):
    """Looks at all particles after every window, and at once when the fastest outruns sound."""

    def admit_liquid(self, state: dict, born: Born, kinds, number_of_last: int) -> None:
        """`admit` of a liquid and its walls that began so; `kinds` that there are, and the number of the particle that
        was made last."""
        fast = RUNAWAY * self.case.fastest_sound
        condenses = self.case.parameters.get("bubble")  # vapour of all others may become one particle's
        bounds = dict.fromkeys("uvw", (-fast, fast)) | {
            "mass": (TINY, born.mass if condenses else born.heaviest),
            "ident": (0, number_of_last),
        }
        self.admit(
            state,
            effects.arrays(self.case),
            bounds | {"density": (born.thinnest / DENSE, born.densest * DENSE)},
        )
        if not np.isin(state["kind"], kinds).all():
            raise Unfit("a particle is of no phase and of no wall")

    def admit_stepper(self, own, kept: dict) -> None:
        """Unfit where what was kept of a LiquidStepper cannot be of this case; `own` is a fresh one."""
        state, built = kept["state"], kept["neighbours"]["built"]
        gas, inflow = (GAS,) if self.case.gas_phase else (), (INFLOW,) if own.p["inflow"] else ()
        made = kept["openings"]["source"]["next_ident"] if own.p["inflow"] else own.born.particles
        self.admit_liquid(state, own.born, (WALL, LIQUID, *gas, *inflow), made - 1)
        count = len(state["x"])
        if [len(axis) for axis in built] != [count] * self.case.dimensions:
            raise Unfit("rows of neighbours are of other particles")
        for name in own.ROWS:
            one = isinstance(fresh := getattr(own, name), np.ndarray)  # else several
            for array, like in zip([kept[name]], [fresh]) if one else zip(kept[name], fresh):
                if len(array) != (count if len(like) else 0):
                    raise Unfit(f"{name} has {len(array)} values for {count} particles")
        far, wild = FAR * self.case.domain.furthest, FAR * self.case.fastest_sound**2 / own.kernel.h
        for name, values, most in (
            ("acceleration", kept["acceleration"], wild),
            *(("a place at the last rows", axis, far) for axis in built),
        ):
            if np.abs(values).max(initial=0.0) > most:
                raise Unfit(f"{name} is beyond {most:.3g}")

    def look(self, stepper) -> None:
        """NaN, speed, density, acceleration."""
        s, own = stepper.state, self.case
        self.time, sound = stepper.time, own.fastest_sound
        if not beyond(s, stepper.active, stepper.acceleration, sound * sound):
            return
        with ashore.ashore(stepper):
            self._name(stepper, sound)

    def _name(self, stepper, sound: float) -> None:
        """Unstable, by the particle that is worst."""
        own = self.case
        lower = (
            f"run.step_factor (now {own.run.step_factor:g}; the step was ruled by {stepper.limit or 'sound'}); where "
            "the liquid is meant "
            f"to be so fast, raise liquid.sound_speed_m_s (now {own.liquid.sound_speed:g}) to ten times its speed"
        )
        wet = particles.take(stepper.state, stepper.active)
        speed = np.sqrt((particles.velocities(wet) ** 2).sum(axis=1))
        self.hold("speed", speed, (0.0, sound, "m/s"), wet, lower)
        self.hold("density", wet.density, (sys.float_info.min, sys.float_info.max, "kg/m3"), wet, lower)
        size = np.sqrt((stepper.acceleration[stepper.active] ** 2).sum(axis=1))
        self.hold("acceleration", size, (0.0, sys.float_info.max, "m/s2"), wet, lower)


@parallel
def beyond(s, active, acceleration, most):
    """Number of particles that `look` is to name: speed squared is above `most` [m2/s2], or density or acceleration is
    no number that a step can go on with."""
    found = 0.0
    for n in prange(len(active)):
        i = active[n]
        force = acceleration[i, 0] ** 2 + acceleration[i, 1] ** 2 + acceleration[i, 2] ** 2
        fine = squared_speed(s, i) <= most and 0.0 < s.density[i] < math.inf and force < math.inf  # false of nan
        found += 0.0 if fine else 1.0
    return found


def limits(case, parameters, state, speed: float, acceleration: float) -> dict[str, float]:
    """Longest steps [s] by cause: sound of the fastest particle [m/s], force on the most pushed [m/s2], each effect,
    infinite where it does not limit."""
    h = case.smoothing_length
    own = {"sound": case.liquid.courant * h / (case.fastest_sound + speed)}
    if acceleration:
        own["force"] = FORCE * math.sqrt(h / acceleration)
    return own | effects.limits(parameters, case, state)
