"""Particles through one window: sub-steps no longer than the effects allow, a force that the exchange holds constant.

A sub-step is symplectic: density, stress and rates from where particles are, then velocities, then places.
"""

from __future__ import annotations

import math

import numpy as np

from sdph.effects import OFF, REGISTRY
from sdph.effects.around import walls
from sdph.effects.grains import friction, grain_shifting, granular_temperature
from sdph.effects.grains.granular_viscosity import Viscous
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
DIFFUSIVE = 0.125  # of h^2/nu, Morris, Fox & Zhu 1997
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
        self.pull = np.empty(self.rows.index.shape)
        if self.boundary:
            self.wall_rows = self.boundary.rows(built)
            if self.source:
                self.source.open(self.state, self.mouths, self.wall_rows)
            self.boundary.part(self.rows, self.wall_rows, built)

    def _sum(self, density) -> None:
        rates.sum_density(self.kernel, self.state, self.rows, self.neighbours.box, *self._walls(), density, self.pull)

    def conduct(self, dt: float, heat) -> None:
        """Grains at rest through `dt` [s]: conduction, and `heat` (N,) [J] from the gas spread evenly."""
        steps = self._parts(dt, self._limit_of("conduction"), "conduction")
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
            self._warm(heating * dt / steps + heat / self.state.mass / steps)
            self.guard.sub_step(self)
        self.steps += steps

    def move(self, dt: float, heat, body, damping) -> None:
        """Grains through `dt` [s]: heat (N,) [J] from the gas, body (N, 3) [m/s2] from outside, damping (N,) [1/s] of
        theta, all held over the window, by `ident` because particles are sorted anew on the way."""
        held = Held(self.state, heat / dt, body, damping)
        left = dt
        while left > 0.0:
            step = self._sub_step(left)
            self._advance(step, held.now(self.state.ident))
            self.guard.sub_step(self)
            left = 0.0 if step >= left else left - step
            self.prepare()

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
        limits = {
            "sound": ACOUSTIC * self.kernel.h / fastest if fastest else math.inf,
            "conduction": self._limit_of("conduction"),
        }
        if len(s.theta) and s.theta.max(initial=0.0) > 0.0:  # viscosity and conductivity are at most h sqrt(theta)
            limits["agitation"] = DIFFUSIVE * self.kernel.h / math.sqrt(s.theta.max())
        self.limit = min(limits, key=limits.get)
        self.length = self.case.run.step_factor * limits[self.limit]
        return left / self._parts(left, limits[self.limit], self.limit)

    def _parts(self, left: float, limit: float, cause: str) -> int:
        """Number of equal sub-steps in which `left` [s] is taken, none longer than `limit` [s] times
        run.step_factor."""
        return count_of_parts(
            left,
            self.case.run.step_factor * limit,
            self.shortest,
            f"the sub-step's limit {cause!r} (times run.step_factor)",
        )

    def _advance(self, dt: float, held) -> None:
        """One sub-step: stress, walls, rates, then theta, heat, velocity, place."""
        heat, body, damping = held
        s, p, count = self.state, self.parameters, len(self.state.x)
        sheared = self._shear(dt)
        wall_pressure, wall_velocity = self._extrapolate(self.stress.pressure, body)
        acceleration, agitation, heating = np.empty((count, 3)), np.empty(count), np.empty(count)
        rates.rates(
            self.kernel, s, self.rows, self.neighbours.box, self.pull, self.stress, self.viscous, p["friction"],
            *sheared[:3], p["artificial_viscosity"], p["granular_temperature"], p["conduction"], *self._walls(),
            wall_pressure, wall_velocity, acceleration, agitation, heating,
        )  # fmt: skip
        if self.source:
            self._hold_back(acceleration, agitation, heating, body)
        if p["granular_temperature"]:
            self._agitate(dt, agitation, damping, sheared)
        if len(s.temperature):
            self._warm((heating + heat / s.mass) * dt)
            # conduction adds up to nothing, but for what comes from upstream
            self.mechanical_heat += float((s.mass * heating).sum() * dt)
        self._drift(dt, acceleration + body)
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

    def _extrapolate(self, pressure, body):
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
            body,
            weight,
            wall_pressure,
            wall_velocity,
        )
        return wall_pressure, wall_velocity

    def _agitate(self, dt: float, agitation, damping, sheared) -> None:
        theta, held = np.empty(len(agitation)), np.empty(len(agitation))
        granular_temperature.advance_all(
            self.parameters["granular_temperature"],
            self.state,
            agitation,
            damping,
            sheared.shear_squared,
            sheared.divergence,
            dt,
            theta,
            held,
        )
        moving = self.state.kind != INFLOW
        self.state.theta[moving], held[~moving] = theta[moving], 0.0
        self.bounds_work += float(1.5 * (self.state.mass * held).sum())

    def _hold_back(self, acceleration, agitation, heating, body) -> None:
        """Particles upstream of a nozzle feel nothing."""
        waiting = self.state.kind == INFLOW
        acceleration[waiting] = -body[waiting]
        agitation[waiting] = heating[waiting] = 0.0

    def _warm(self, heat) -> None:
        """Heat per mass (N,) [J/kg] into the temperature."""
        self.state.temperature[:] += heat / self.case.grains.heat_capacity

    def _drift(self, dt: float, acceleration) -> None:
        s = self.state
        for a, (place, velocity) in enumerate(zip((s.x, s.y, s.z), (s.u, s.v, s.w))):
            if len(place):
                velocity += acceleration[:, a] * dt
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

    def _limit_of(self, name: str) -> float:
        return (
            REGISTRY[name].dt_limit(self.parameters[name], self.case, self.state) if self.parameters[name] else math.inf
        )


class Held:
    """Values of particles that hold over a window, handed out in whatever order the particles stand."""

    def __init__(self, state, *values):
        self.ident, self.values = state.ident.copy(), values
        self.place = np.empty(int(state.ident.max(initial=0)) + 1, np.int64)  # of each ident
        self.place[self.ident] = np.arange(len(self.ident))
        self.order, self.given = state.ident, values  # as handed out last, and in which order

    def now(self, ident):
        if ident is not self.order:  # sorting makes a new array
            rows = self.place[ident]
            self.order, self.given = ident, tuple(value[rows] for value in self.values)
        return self.given
