"""Particles through one window: sub-steps no longer than the effects allow, a force that the exchange holds constant.

A sub-step is symplectic: density, stress and rates from where particles are, then velocities, then places.
"""

from __future__ import annotations

import math

import numpy as np

from sdph import effects
from sdph.effects import OFF, REGISTRY
from sdph.effects.around import walls
from sdph.effects.grains import friction, grain_shifting, granular_temperature
from sdph.effects.grains.granular_viscosity import Viscous
from sdph.engine import state as particles
from sdph.engine.clock import count_of_parts
from sdph.engine.kept import GROWING, Unfit
from sdph.engine.rows import Neighbours
from sdph.engine.state import INFLOW
from sdph.engine.walls.sides import Boundary
from sdph.methods.grains import contacts as shearing
from sdph.methods.grains import equations as rates
from sdph.methods.grains.bounds import Guard
from sdph.methods.grains.equations import Stress

# Of h/(c + v); our choice. By von Neumann a lattice with summed density bears 1.86 h/c in these steps, under p = rho
# c^2/2 1.15 (tests/methods/grains/test_rates.py). Monaghan 1992 takes 0.25; the bed's heat to the grains is then 0.07 %
# different.
ACOUSTIC = 0.5
SAME_DENSITY = 1e-6  # of a density: what is summed twice differs by round-off at most; our choice
REACH = 2.0  # support of the kernels in smoothing lengths


class Stepper:
    """State of the particles, and how it goes forward."""

    # see sdph.engine.kept
    KEPT = ("state", "neighbours", "steps", "contacts", "limit", "mechanical_heat", "bounds_work")
    FORMS = {"state": GROWING}

    def __init__(self, case, parameters, state, source=None, shortest=0.0):
        self.case, self.parameters, self.state, self.source = case, parameters, state, source
        self.kernel, self.guard = rates.kernel_of(case), Guard(case)
        self.neighbours = Neighbours(REACH * case.smoothing_length, case.domain.period, case.resolution.neighbour_skin)
        self.boundary = Boundary(case) if parameters["walls"] else None
        self.mouths = source.mouths(self.boundary.dummies) if source and self.boundary else None  # nozzle of each dummy
        self.viscous = Viscous(float(case.dimensions)) if parameters["granular_viscosity"] else OFF
        algebraic = parameters["granular_temperature"] and parameters["granular_temperature"].model == 1
        self.shears = bool(parameters["friction"] or algebraic)
        self.steps, self.contacts, self.limit = 0, 0, ""
        self.shortest = shortest  # sub-step [s] below which the run gets nowhere
        # of the last sub-step, and what that was limited to [s]
        self.stress, self.length = Stress(*[np.empty(0)] * len(Stress._fields)), 0.0
        self.mechanical_heat = 0.0  # what motion has given to the temperature of the grains [J]
        self.bounds_work = 0.0  # what the bounds of theta have added [J]

    def revive(self) -> None:
        """After a checkpoint was put back."""
        if not self.neighbours.built:  # particles came or went: the next step begins with new rows
            return
        self.neighbours.relist(self.state.kind)
        self._look_around()
        density = np.empty(len(self.state.x))
        self._sum(density)
        if not np.allclose(density, self.state.density, rtol=SAME_DENSITY, atol=0.0):
            raise Unfit("the density of the particles is not that of where they are")

    def admit(self, kept: dict) -> None:
        """Unfit where the particles cannot be of this case, or their rows were not made near to where they are."""
        state, built = kept["state"], kept["neighbours"]["built"]
        names = {name for effect in self.case.effects for name in REGISTRY[effect].arrays}
        born = [streams.mass for streams in self.source.streams] if self.source else []
        self.guard.admit_grains(state, names, max(self.state.mass.max(initial=0.0), *born, 0.0))
        here = [state[axis] for axis in "xyz"[: self.case.dimensions]]
        if built and [len(axis) for axis in built] != [len(axis) for axis in here]:
            raise Unfit("rows of neighbours are of other particles")
        apart = sum((a - b) ** 2 for a, b in zip(here, built)) if built else np.zeros(0)
        if not apart.max(initial=0.0) < (self.neighbours.skin * self.neighbours.reach) ** 2:
            raise Unfit("rows of neighbours were made for other places of the particles")

    def replace(self, state) -> None:
        """Other particles than before: some are gone, some are new."""
        self.state, self.neighbours.built = state, ()

    def prepare(self) -> None:
        """Neighbours and density of where the particles are now."""
        before = self.neighbours.built
        self.state, _ = self.neighbours.update(self.state)
        if before is not self.neighbours.built:
            self._look_around()
        self._sum(self.state.density)

    def _look_around(self) -> None:
        """What belongs to neighbour rows just made."""
        self.rows, built = self.neighbours.rows, self.neighbours.built
        self.pull = np.empty(len(self.rows.entries))
        if self.boundary:
            self.wall_rows = self.boundary.rows(built)
            if self.source:
                self.source.open(self.state, self.mouths, self.wall_rows)
            self.boundary.part(self.rows, self.wall_rows, built)

    def _sum(self, density) -> None:
        rates.sum_density(self.kernel, self.state, self.rows, self.neighbours.box, *self._walls(), density, self.pull)

    def force(self, warmth, push, damping) -> None:
        """Take what holds over the next window: heat (N,) [J] from the gas, push (N, 3) [m/s2] from outside, damping
        (N,) [1/s] of theta."""
        self.state = particles.forced(self.state, warmth, push, damping)

    def conduct(self, dt: float) -> None:
        """Grains at rest through a window of `dt` [s]: conduction, and heat from the gas spread evenly."""
        steps = self._parts(dt)
        heating = np.zeros(len(self.state.x))
        for _ in range(steps):
            rates.conduct(
                self.kernel,
                self.state,
                self.rows,
                self.neighbours.box,
                self.pull,
                self.parameters["conduction"],
                heating,
            )
            self._warm(heating * dt / steps + self.state.warmth / self.state.mass / steps)
            self.guard.sub_step(self)
        self.state = particles.released(self.state)
        self.steps += steps

    def move(self, dt: float) -> None:
        """Grains that move through a window of `dt` [s]."""
        left = dt
        while left > 0.0:
            step = self._sub_step(left)
            self._advance(step, dt)
            self.guard.sub_step(self)
            left = 0.0 if step >= left else left - step
            self.prepare()
        self.state = particles.released(self.state)

    def conduction_rates(self) -> np.ndarray:
        """Heat [W] that each particle gets from its neighbours now."""
        heating = np.zeros(len(self.state.x))
        if self.parameters["conduction"]:
            rates.conduct(
                self.kernel,
                self.state,
                self.rows,
                self.neighbours.box,
                self.pull,
                self.parameters["conduction"],
                heating,
            )
        return heating * self.state.mass

    def _sub_step(self, left: float) -> float:
        """The next sub-step [s]: what is left of the window, in equal parts."""
        s = self.state
        self.stress = self._stress()
        speed = np.sqrt(s.u**2 + s.v**2 + (s.w**2 if len(s.w) else 0.0))
        fastest = float((self.stress.sound + speed).max(initial=0.0))
        return left / self._parts(left, fastest)

    def _parts(self, left: float, fastest: float = 0.0) -> int:
        """Number of equal sub-steps for `left` [s], none longer than the shortest limit times run.step_factor."""
        found = limits(self.case, self.parameters, self.state, fastest)
        self.limit = min(found, key=found.get, default="")
        self.length = self.case.run.step_factor * found.get(self.limit, math.inf)
        return count_of_parts(
            left, self.length, self.shortest, f"the sub-step's limit {self.limit!r} (times run.step_factor)"
        )

    def _advance(self, dt: float, window: float) -> None:
        """One sub-step of `dt` of a `window` [s]: stress, walls, rates, then theta, heat, velocity, place."""
        s, p, count = self.state, self.parameters, len(self.state.x)
        sheared = self._shear(dt)
        wall_pressure, wall_velocity = self._extrapolate(self.stress.pressure)
        acceleration, agitation, heating = np.empty((count, 3)), np.empty(count), np.empty(count)
        rates.rates(
            self.kernel, s, self.rows, self.neighbours.box, self.pull, self.stress, self.viscous, p["friction"],
            *sheared[:3], p["artificial_viscosity"], p["granular_temperature"], p["conduction"], *self._walls(),
            wall_pressure, wall_velocity, acceleration, agitation, heating,
        )  # fmt: skip
        if self.source:
            self._hold_back(acceleration, agitation, heating)
        if p["granular_temperature"]:
            self._agitate(dt, agitation, sheared)
        if len(s.temperature):
            self._warm((heating + s.warmth / window / s.mass) * dt)
            self.mechanical_heat += float(
                (s.mass * heating).sum() * dt
            )  # conduction adds up to nothing, but for what comes from upstream
        self._drift(dt, acceleration)
        self.steps += 1

    def _stress(self) -> Stress:
        s, p = self.state, self.parameters
        stress = Stress(*(np.empty(len(s.x)) for _ in Stress._fields))
        rates.constitutive(
            s, self.case.grains.density, p["granular_pressure"], p["friction"],
            p["granular_viscosity"], p["granular_temperature"], *stress,
        )  # fmt: skip
        return stress

    def _shear(self, dt: float) -> shearing.Shearing:
        """Strain, and contacts strained over `dt` [s]."""
        s, p = self.state, self.parameters
        if not self.shears:
            return shearing.nothing(len(s.x))
        out, held = shearing.empty(len(s.x), bool(p["friction"])), (getattr(s, name) for name in friction.ARRAYS)
        shearing.shear(
            self.kernel,
            s,
            self.rows,
            self.neighbours.box,
            self.pull,
            self.stress,
            *self._walls(),
            p["friction"],
            dt,
            *held,
            *out,
        )
        return out

    def _extrapolate(self, pressure):
        if not self.boundary:
            return OFF, OFF
        count = len(self.boundary.dummies.x)
        weight, wall_pressure, wall_velocity = np.empty(count), np.empty(count), np.empty((count, 3))
        walls.extrapolate(
            self.kernel,
            self.neighbours.box,
            self.boundary.dummies,
            self.wall_rows,
            self.state,
            pressure,
            weight,
            wall_pressure,
            wall_velocity,
        )
        return wall_pressure, wall_velocity

    def _agitate(self, dt: float, agitation, sheared) -> None:
        theta, held = np.empty(len(agitation)), np.empty(len(agitation))
        granular_temperature.advance_all(
            self.parameters["granular_temperature"],
            self.state,
            agitation,
            self.state.damping,
            sheared.shear_squared,
            sheared.divergence,
            dt,
            theta,
            held,
        )
        moving = self.state.kind != INFLOW
        self.state.theta[moving], held[~moving] = theta[moving], 0.0
        self.bounds_work += float(1.5 * (self.state.mass * held).sum())

    def _hold_back(self, acceleration, agitation, heating) -> None:
        """Particles upstream of a nozzle feel nothing."""
        waiting = self.state.kind == INFLOW
        for a, push in enumerate(particles.pushes(self.state)):
            acceleration[waiting, a] = -push[waiting]
        agitation[waiting] = heating[waiting] = 0.0

    def _warm(self, heat) -> None:
        """Heat per mass (N,) [J/kg] into the temperature."""
        self.state.temperature[:] += heat / self.case.grains.heat_capacity

    def _drift(self, dt: float, acceleration) -> None:
        s = self.state
        for a, (place, velocity, push) in enumerate(zip(particles.axes(s), (s.u, s.v, s.w), particles.pushes(s))):
            velocity += (acceleration[:, a] + push) * dt
            place += velocity * dt
        if self.parameters["grain_shifting"]:
            self._shift(dt)
        if self.source:
            self.source.release(s)
        if self.boundary:
            self.contacts += walls.contact(
                self.parameters["walls"], self.neighbours.box, self.boundary.dummies, self.wall_rows, s
            )

    def _shift(self, dt: float) -> None:
        s = self.state
        moved = np.empty((len(s.x), 3))
        grain_shifting.shift(self.parameters["grain_shifting"], s, self.rows, self.neighbours.box, dt, moved)
        moved[s.kind == INFLOW] = 0.0
        for a, place in enumerate((s.x, s.y, s.z)):
            if len(place):
                place += moved[:, a]

    def _walls(self):
        """Parameters, dummies and rows of the walls for kernels."""
        return (self.parameters["walls"], self.boundary.dummies, self.wall_rows) if self.boundary else (OFF, OFF, OFF)


def limits(case, parameters, state, fastest: float) -> dict[str, float]:
    """Longest sub-steps [s] by cause: what each effect bears, and sound, `fastest` [m/s] being that of c + v."""
    sound = {"sound": ACOUSTIC * case.smoothing_length / fastest} if fastest else {}
    return sound | effects.limits(parameters, case, state)
