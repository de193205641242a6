"""Particles through one window: sub-steps no longer than the effects allow, a force that the exchange holds constant.

A sub-step is symplectic: density, stress and rates from where particles are, then velocities, then places.
"""

from __future__ import annotations

import math

import numpy as np

from sdph import effects
from sdph.effects import OFF, REGISTRY
from sdph.effects.around import wall_contact, walls
from sdph.effects.grains import friction, grain_shifting, granular_temperature
from sdph.engine import state as particles
from sdph.engine.clock import count_of_parts
from sdph.engine.kept import GROWING, Unfit
from sdph.engine.rows import Neighbours
from sdph.engine.state import INFLOW
from sdph.engine.walls.sides import Boundary
from sdph.methods.grains import account
from sdph.methods.grains import contacts as shearing
from sdph.methods.grains import equations as rates
from sdph.methods.grains.account import Account
from sdph.methods.grains.bounds import Guard

# Of h/(c + v); our choice. By von Neumann a lattice with summed density bears 1.86 h/c in these steps, under p = rho
# c^2/2 1.15 (tests/methods/grains/test_rates.py). Monaghan 1992 takes 0.25; the bed's heat to the grains is then 0.07 %
# different.
ACOUSTIC = 0.5
SAME_DENSITY = 1e-6  # of a density: what is summed twice differs by round-off at most; our choice
REACH = 2.0  # support of the kernels in smoothing lengths


class Stepper:
    """State of the particles, and how it goes forward."""

    KEPT, FORMS = ("state", "neighbours", "steps", "contacts", "limit"), {"state": GROWING}  # see sdph.engine.kept
    # what a sub-step takes from neighbours and theirs, fresh, of `state`: all else of a particle is its own affair
    HALO = (*"xyzuvw", "mass", "density", "temperature", "diameter", "theta", *friction.ARRAYS)

    def __init__(self, case, parameters, state, source=None, shortest=0.0):
        self.case, self.parameters, self.state, self.source = case, parameters, state, source
        self.kernel, self.guard = rates.kernel_of(case), Guard(case)
        self.neighbours = Neighbours(REACH * case.smoothing_length, case.domain.period, case.resolution.neighbour_skin)
        self.boundary = Boundary(case) if parameters["walls"] else None
        self.mouths = source.mouths(self.boundary.dummies) if source and self.boundary else None  # nozzle of each dummy
        algebraic = parameters["granular_temperature"] and parameters["granular_temperature"].model == 1
        self.shears = bool(parameters["friction"] or parameters["granular_viscosity"] or algebraic)
        self.gravity = np.array(parameters["gravity"] or (0.0, 0.0, 0.0))
        self.steps, self.contacts, self.limit = 0, 0, ""
        self.shortest = shortest  # sub-step [s] below which the run gets nowhere
        self.length = self.step = 0.0  # [s] that the last sub-step was limited to, and was
        self.held: dict[str, float] = {}  # what limiters hold (sdph.effects.held)
        self.wall, self.scratch, self.account = OFF, rates.scratch(0, 0, False), Account()
        # pressure [Pa] of the walls before it is held, and what the last sub-step shifted (N, 3) [m]
        self.unheld, self.shifted = np.zeros(0), np.zeros((0, 3))

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
        born = self.source.heaviest if self.source else 0.0
        self.guard.admit_grains(state, names, max(self.state.mass.max(initial=0.0), born))
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
        """Make what belongs to neighbour rows just made."""
        self.rows, built, count = self.neighbours.rows, self.neighbours.built, len(self.state.x)
        self.scratch = rates.scratch(
            count, len(self.rows.entries), bool(self.parameters["friction"]), self.case.dimensions == 3
        )
        self.of_walls = np.zeros((count, 7))
        if self.boundary:
            rows = self.boundary.rows(built)
            if self.source:
                self.source.open(self.state, self.mouths, rows)
            self.boundary.part(self.rows, rows, built)
            self.wall, self.facing = self.boundary.seen(rows)
            self.unheld = np.full(len(self.wall.x), np.nan)

    def _sum(self, density) -> None:
        rates.sum_density(
            self.kernel, self.state, self.rows, self.neighbours.box, *self._walls(), density, self.scratch.pull
        )

    def force(self, warmth, push, damping) -> None:
        """Take what holds over the next window: heat (N,) [J] from the gas, push (N, 3) [m/s2] from outside, damping
        (N,) [1/s] of theta; begin its account."""
        self.state = particles.followed(particles.forced(self.state, warmth, push, damping))
        self.account, self.rows_before = Account(), len(self.state.x)

    def release(self) -> tuple[np.ndarray, np.ndarray]:
        """End the window: way (N, 3) [m] of the particles in it, and what their theta lost to the gas (N,) [J], in the
        rows that they had when it began; 0 for those that were taken out since."""
        s = self.state
        damped = s.damped if len(s.damped) else np.zeros(len(s.x))
        moved = np.column_stack((particles.vectors(s.way_x, s.way_y, s.way_z), damped))
        before = np.zeros((self.rows_before, moved.shape[1]))
        before[s.row] = moved
        self.state = particles.released(s)
        return before[:, :3], before[:, 3]

    def conduct(self, dt: float) -> None:
        """Grains at rest through a window of `dt` [s]: conduction, and heat from the gas spread evenly."""
        steps = self._parts(dt)
        for _ in range(steps):
            self._warm(self._conducted() * dt / steps + self.state.warmth / self.state.mass / steps)
            self.guard.sub_step(self)
        self.steps += steps
        self.tell()

    def tell(self) -> None:
        """See what limiters hold now, before rows are made anew."""
        self.held = effects.held(self.parameters, self.case, self)

    def move(self, dt: float) -> None:
        """Grains that move through a window of `dt` [s]."""
        left = dt
        while left > 0.0:
            step = self._sub_step(left)
            self._advance(step, dt)
            self.guard.sub_step(self)
            left = 0.0 if step >= left else left - step
            if left == 0.0:
                self.tell()
            self.prepare()

    def _conducted(self) -> np.ndarray:
        """Heat (N,) [W/kg] that the particles get from their neighbours now."""
        heating = np.zeros(len(self.state.x))
        rates.conduct(
            self.kernel, self.state, self.rows, self.neighbours.box, self.scratch.pull, self.parameters["conduction"],
            heating,
        )  # fmt: skip
        return heating

    def conduction_rates(self) -> np.ndarray:
        """Heat (N,) [W] that each particle gets from its neighbours now."""
        return self._conducted() * self.state.mass

    def _sub_step(self, left: float) -> float:
        """The next sub-step [s]: what is left of the window, in equal parts."""
        s = self.state
        self._constitute()
        speed = np.sqrt(s.u**2 + s.v**2 + (s.w**2 if len(s.w) else 0.0))
        fastest = float((self.scratch.sound + speed).max(initial=0.0))
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
        s, p, count, self.step = self.state, self.parameters, len(self.state.x), dt
        if self.shears:
            self._shear(dt)
        if self.boundary:
            self._extrapolate()
        acceleration, agitation, heating = np.empty((count, 3)), np.empty(count), np.empty(count)
        rates.rates(
            self.kernel, s, self.rows, self.neighbours.box, self.scratch, p["granular_viscosity"],
            p["friction"], p["artificial_viscosity"], p["granular_temperature"], p["conduction"], *self._walls(),
            acceleration, self.of_walls, agitation, heating,
        )  # fmt: skip
        account.kick(
            s, acceleration, self.of_walls, agitation + heating, self.gravity, dt, self.account.impulses,
            self.account.works,
        )  # fmt: skip
        if self.source:
            waiting = s.kind == INFLOW
            agitation[waiting] = heating[waiting] = 0.0
        self.account.add(agitation=(s.mass @ agitation) * dt, mechanical_heat=(s.mass @ heating) * dt)
        collided = self._agitate(dt, agitation)
        self._warm(collided + (heating + s.warmth / window / s.mass) * dt)
        self._drift(dt)
        self.steps += 1

    def _constitute(self) -> None:
        s, p = self.state, self.parameters
        rates.constitutive(
            s, self.case.grains.density, p["granular_pressure"], p["friction"],
            p["granular_viscosity"], p["granular_temperature"], *self.scratch.stress,
        )  # fmt: skip

    def _shear(self, dt: float) -> None:
        """Shear of the grains; where there is friction contacts are strained over `dt` [s]."""
        s, rubs = self.state, self.parameters["friction"]
        contact = np.empty((len(friction.ARRAYS), len(s.x) if rubs else 0))
        shearing.shear(
            self.kernel, s, self.rows, self.neighbours.box, self.scratch, *self._walls(), rubs,
            self.parameters["granular_viscosity"], dt, contact, *self.scratch.shearing,
        )  # fmt: skip
        for name, values in zip(friction.ARRAYS, contact):
            own = getattr(s, name)
            own[:] = values[: len(own)]

    def _extrapolate(self) -> None:
        """Pressure and velocity of the walls, from the grains in front of them."""
        own = self.wall
        walls.extrapolate(
            self.kernel, self.neighbours.box, own, self.facing, self.state, self.scratch.pressure, own.pressure,
            self.unheld, own.velocity,
        )  # fmt: skip

    def _agitate(self, dt: float, agitation) -> np.ndarray:
        """theta after `dt` [s]; heat (N,) [J/kg] that its collisions give the grains. Where the case has theta stand,
        what would raise it goes out by its bounds."""
        s, count = self.state, len(agitation)
        if not self.parameters["granular_temperature"]:
            self.account.add(bounds_work=-(s.mass @ agitation) * dt)
            return np.zeros(count)
        theta, held, collided, damped = (np.empty(count) for _ in range(4))
        granular_temperature.advance_all(
            self.parameters["granular_temperature"], s, agitation, s.damping, *self.scratch.strain[:2],
            dt, theta, held, collided, damped,
        )  # fmt: skip
        waiting = s.kind == INFLOW
        held[waiting] = collided[waiting] = damped[waiting] = 0.0
        np.copyto(s.theta, theta, where=~waiting)
        s.damped[:] += 1.5 * s.mass * damped
        sums = {"bounds_work": held, "collision_heat": collided, "damping_heat": damped}
        self.account.add(**{name: 1.5 * (s.mass @ values) for name, values in sums.items()})
        return 1.5 * collided

    def _warm(self, heat) -> None:
        """Put heat per mass (N,) [J/kg] into the temperature, where there is one."""
        if not len(self.state.temperature):
            return
        self.state.temperature[:] += heat / self.case.grains.heat_capacity

    def _drift(self, dt: float) -> None:
        s = self.state
        for place, velocity in zip(particles.axes(s), (s.u, s.v, s.w)):
            place += velocity * dt
        if self.parameters["grain_shifting"]:
            self._shift(dt)
        if self.source:
            self.source.release(s)
        if self.boundary:
            own = self.account
            self.contacts += wall_contact.contact(
                *self._walls(), self.neighbours.box, s, self.gravity, own.impulses[account.WALLS],
                own.works[account.BY_WALLS :], own.back_put,
            )  # fmt: skip

    def _shift(self, dt: float) -> None:
        s = self.state
        moved = np.empty((len(s.x), 3))
        grain_shifting.shift(self.parameters["grain_shifting"], s, self.rows, self.neighbours.box, dt, moved)
        moved[s.kind == INFLOW] = 0.0
        self.shifted = moved
        for a, place in enumerate((s.x, s.y, s.z)):
            if len(place):
                place += moved[:, a]

    def _walls(self):
        """Walls for kernels: parameters and dummies."""
        return self.parameters["walls"], self.wall


def limits(case, parameters, state, fastest: float) -> dict[str, float]:
    """Longest sub-steps [s] by cause: what each effect bears, and sound, `fastest` [m/s] being that of c + v."""
    sound = {"sound": ACOUSTIC * case.smoothing_length / fastest} if fastest else {}
    return sound | effects.limits(parameters, case, state)
