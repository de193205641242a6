"""Particles through one window: sub-steps no longer than the effects allow, a force that the exchange holds constant.

A sub-step is symplectic: density, stress and rates from where particles are, then velocities, then places.
"""

from __future__ import annotations

import math

import numpy as np

from sdph import effects
from sdph.effects import OFF, finite
from sdph.effects.around import sizes, wall_contact
from sdph.effects.effect import NO_LIMIT, Live
from sdph.effects.grains import friction, grain_shifting
from sdph.engine import arrays, gathered, world
from sdph.engine import state as particles
from sdph.engine.clock import count_of_parts
from sdph.engine.kept import GROWING, Unfit
from sdph.engine.neighbours import Neighbours
from sdph.engine.state import INFLOW
from sdph.engine.walls.faces import Heated
from sdph.engine.walls.sides import Boundary
from sdph.laws.kernels import SUPPORT
from sdph.methods.grains import account, sound, sub_step
from sdph.methods.grains import equations as rates
from sdph.methods.grains.bounds import Guard
from sdph.methods.grains.conducting import Conducting
from sdph.methods.grains.windowed import Windowed

# rounds in which grains of a start are put where contact holds them: between walls that are near to each other there is
# no such place; our choice
STAND_OFF = 10
SAME_DENSITY = 1e-6  # of a density: what is summed twice differs by round-off at most; our choice


class Stepper(Conducting, Windowed):
    """State of the particles, and how it goes forward."""

    KEPT = ("state", "neighbours", "giving", "steps", "contacts", "limit")  # see sdph.engine.kept
    FORMS = {"state": GROWING}
    # arrays of a row a particle that a checkpoint holds beside the state (sdph.engine.gathered), and that others read
    ROWS = SEEN = ()
    # what a sub-step takes from neighbours and theirs, fresh, of `state`: all else of a particle is its own affair
    HALO = (*"xyzuvw", "mass", "density", "temperature", "diameter", "theta", *friction.ARRAYS)
    # and these, of several materials; for their drag on each other velocities once more, after the kick, with kind and
    # material
    OF_SEVERAL = ("grain_density", "grain_conductivity")
    MOVING = (*"xyzuvw", "temperature", "theta", "kind")  # what a sub-step changes of them, beside their density

    def __init__(self, case, parameters, state, source=None, shortest=0.0):
        self.case, self.parameters, self.state, self.source = case, parameters, state, source
        self.kernel, self.guard = rates.kernel_of(case), Guard(case)
        self.world, walled = world.here(), bool(parameters["walls"])
        # of others a process needs all that press the walls which its own see: those within two reaches
        self.neighbours = Neighbours(
            SUPPORT * self.kernel.h, case.domain.period[: case.dimensions], case.resolution.neighbour_skin, self.world,
            1.0 + walled,
        )  # fmt: skip
        self.domain, self.heaviest = self.neighbours.domain, self.world.most(float(state.mass.max(initial=0.0)))  # [kg]
        self.boundary = Boundary(case) if parameters["walls"] else None
        self.mouths = source.mouths(self.boundary.dummies) if source and self.boundary else None  # nozzle of each dummy
        self.giving = np.zeros(len(case.nozzles) + 1, bool)  # nozzles, from 1: open while the rows hold
        self.waves, self.terms = sound.waves_of(case), sub_step.terms_of(parameters)
        self.gravity = np.array(parameters["gravity"] or (0.0, 0.0, 0.0))
        self.steps, self.contacts, self.limit = 0, 0, ""
        self.steps_before = 0  # of the run before this part of it
        self.touched = 0  # contacts of own particles in the window
        self.shortest = shortest  # sub-step [s] below which the run gets nowhere
        self.length = self.step = 0.0  # [s] that the last sub-step was limited to, and was
        self.held: dict[str, float] = {}  # what limiters hold (sdph.effects.held)
        self.parts = self.boundary.shares(case, case.run.forces) if self.boundary else {}  # of walls, by name
        self.hot = Heated(case, self.boundary) if parameters["wall_heat"] else None  # walls with a temperature
        self.wall, self.scratch, self.account = OFF, rates.scratch(0, 0, False), self._opened()
        self.facing, self.heated, self.work = OFF, OFF, sub_step.work(0, False)  # rows of the dummies; of hot faces
        # pressure [Pa] of the walls before it is held, and what the last sub-step shifted (N, 3) [m]
        self.unheld, self.shifted = np.zeros(0), np.zeros((0, 3))
        self.landed = None  # see sdph.engine.ashore

    def look_anew(self) -> None:
        """Make rows of the places at the last build, and what belongs to them, where the particles are."""
        self.neighbours.relist(self.state.kind)
        self._look_around()
        self._sum(self.state.density)

    def revive(self) -> None:
        """Make anew what a checkpoint does not hold, once it was put back."""
        known, self.steps_before = bool(self.neighbours.built), self.steps
        if not self.domain.alone:
            gathered.take_part(self)
        elif known:
            self.neighbours.relist(self.state.kind)
        else:  # particles came or went: the next step begins with new rows
            return
        self._look_around()
        density = np.empty(len(self.state.x))
        self._sum(density)
        self.domain.refresh(density)
        if known and not np.allclose(density, self.state.density, rtol=SAME_DENSITY, atol=0.0):
            raise Unfit("the density of the particles is not that of where they are")

    def admit(self, kept: dict) -> None:
        """Unfit where the particles cannot be of this case, or their rows were not made near to where they are."""
        state, built = kept["state"], kept["neighbours"]["built"]
        names = effects.arrays(self.case)
        born = self.source.heaviest if self.source else 0.0
        self.guard.admit_grains(state, names, max(self.heaviest, born))
        here = [state[axis] for axis in "xyz"[: self.case.dimensions]]
        if built and [len(axis) for axis in built] != [len(axis) for axis in here]:
            raise Unfit("rows of neighbours are of other particles")
        apart = sum((a - b) ** 2 for a, b in zip(here, built)) if built else np.zeros(0)
        if not apart.max(initial=0.0) <= (self.neighbours.skin * self.neighbours.reach) ** 2:
            raise Unfit("rows of neighbours were made for other places of the particles")

    def replace(self, state) -> None:
        """Other particles than before: some are gone, some are new."""
        self.state, self.neighbours.built = state, ()

    @property
    def own(self):
        """The particles of this process: a view of `state`."""
        return self.domain.own(self.state)

    def _arrays(self, names=HALO) -> list[np.ndarray]:
        return [getattr(self.state, name) for name in names]

    def prepare(self, changed: tuple[str, ...] = (*HALO, "kind")) -> None:
        """Neighbours and density of where the particles are now; of others' what has `changed` at most."""
        before = self.neighbours.built
        self.state, _ = self.neighbours.update(self.state, *self._arrays(changed))
        if before is not self.neighbours.built:
            if self.source:
                self.giving = self.source.giving(self.state, self.world)
            self._look_around()
        self._sum(self.state.density)
        self.domain.refresh(self.state.density)

    def _look_around(self) -> None:
        """Make what belongs to neighbour rows just made."""
        self.rows, built, count = self.neighbours.rows, self.neighbours.built, len(self.state.x)
        rubs = bool(self.parameters["friction"])
        if not self._has_room(count):
            like, packed = self.state.x, len(self.terms.conduction) == 3
            deep = self.case.dimensions == 3
            self.scratch = rates.scratch(count, len(self.rows.entries), rubs, deep, packed, like)
            self.work = sub_step.work(count, rubs, bool(self.parameters["grain_drag"]), like)
        arrays.fill(self.work.of_walls, 0.0)  # loops write the rows of those that see a wall
        if self.boundary:
            rows = self.boundary.rows(built)
            if self.giving.any():
                self.source.open(self.giving[self.mouths], rows)
            self.boundary.part(self.rows, rows, built)
            self.wall, self.facing = self.boundary.seen(rows, built)
            if not self.domain.alone:
                self.wall.number[len(self.own.x) :] = 0  # dummies see copies, copies feel no wall
            self.unheld = arrays.empty(len(self.wall.x), self.wall.x)
            arrays.fill(self.unheld, math.nan)
        if self.hot:
            self.heated = self.hot.seen(built)

    def _has_room(self, count: int) -> bool:
        """True where work arrays are those of `count` particles in these rows, and lie beside them."""
        own = self.scratch
        there = arrays.here(own.pressure) == arrays.here(self.state.x)
        return there and (count, len(self.rows.entries)) == (len(own.pressure), len(own.pull))

    def _sum(self, density) -> None:
        rates.sum_density(*self._of_density(density))

    def _of_density(self, density) -> tuple:
        return self.kernel, self.state, self.rows, self.neighbours.box, *self._walls(), density, self.scratch.pull

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
            self.prepare(self.MOVING)

    def _sub_step(self, left: float) -> float:
        """The next sub-step [s]: what is left of the window, in equal parts."""
        pace, momentum, agitation = self.world.most(np.array(self._constitute())).tolist()
        known = {"granular_viscosity": momentum, "granular_temperature": agitation}
        return left / self._parts(left, pace, known)

    def _parts(self, left: float, pace: float = 0.0, known: dict | None = None) -> int:
        """Number of equal sub-steps for `left` [s], none longer than the shortest limit times run.step_factor."""
        found = finite(self.world.leasts(limits(self.case, self.parameters, self.own, pace, known or {})))
        self.limit = min(found, key=found.get, default="")
        self.length = self.case.run.step_factor * found.get(self.limit, math.inf)
        return count_of_parts(
            left, self.length, self.shortest, f"the sub-step's limit {self.limit!r} (times run.step_factor)"
        )

    def _constitute(self) -> tuple[float, float, float]:
        return rates.constitutive(*self._of_stress())

    def _of_stress(self) -> tuple:
        p = self.parameters
        return (
            self.state, self.waves, bounds_of(self.case), p["granular_pressure"], p["friction"],
            p["granular_viscosity"], p["granular_temperature"], *self.scratch.stress,
        )  # fmt: skip

    def _advance(self, dt: float, window: float) -> None:
        """One sub-step of `dt` of a `window` [s]: stress, walls, rates, then velocity, theta, heat, place."""
        self.step = dt
        if self.domain.alone:
            sub_step.advance(*self._given(dt, window))
        else:
            sub_step.advance_own(self.domain, self.own, self._given(dt, window))
        self._settle(dt)
        self.steps += 1

    def _given(self, dt: float, window: float) -> tuple:
        """Arguments of a sub-step of `dt` of a `window` [s]."""
        return (
            self.kernel, self.state, self.rows, self.neighbours.box, self.scratch, self.terms, *self._walls(),
            self.facing, self.unheld, self.heated, self.work, self.gravity, (dt, window),
            self.case.grains.heat_capacity, self.account,
        )  # fmt: skip

    def loops(self, dt: float) -> dict[str, tuple]:
        """Loops over particles of a sub-step of `dt` [s], by name, each with its arguments as they stand."""
        density = np.empty(len(self.state.x))
        return {
            "sum_density": (rates.sum_density, self._of_density(density)),
            "constitutive": (rates.constitutive, self._of_stress()),
            **sub_step.loops(*self._given(dt, dt)),
        }

    def _settle(self, dt: float) -> None:
        """Shift particles and stop them at walls, after they have gone for `dt` [s]."""
        s = self.own
        if self.parameters["grain_shifting"]:
            self._shift(dt)
        if self.source:
            self.source.release(s)
        if self.boundary:
            self.touched += self._stop(self.account)

    def _stop(self, own) -> int:
        """Stop particles at walls, which goes into the account `own`; how many."""
        return int(wall_contact.stop(
            *self._walls(), self.neighbours.box, self.own, self.gravity, own.impulses[account.WALLS],
            own.works[account.BY_WALLS :], own.back_put, own.felt,
        ))  # fmt: skip

    def stand_off(self) -> None:
        """Put the particles of a start, as fast as they are, where contact with walls holds them, before the gas knows
        of their places: beside round bodies some stand nearer."""
        for _ in range(STAND_OFF if self.boundary else 0):
            speeds = [own.copy() for own in (self.own.u, self.own.v, self.own.w)]
            touched = self._stop(self._opened())
            for own, given in zip((self.own.u, self.own.v, self.own.w), speeds):
                own[:] = given
            if not self.world.any(touched > 0):
                return
            self.neighbours.built = ()
            self.prepare()

    def _shift(self, dt: float) -> None:
        s = self.state
        self.domain.refresh(*particles.axes(s), s.u, s.v, s.w)
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


def bounds_of(case) -> tuple[float, ...]:
    """Density [kg/m3] and packing limit [-] of the grains as `equations.constitutive` takes them; of several materials
    the largest density and diameter [m] too."""
    of_one = case.grains.density, case.grains.packing_limit
    if not case.mixed:
        return of_one
    diameters = [grains.diameter for grains in case.kinds]
    diameters += [float(sizes.of_nozzle(case, nozzle).diameter.max()) for nozzle in case.nozzles.values()]
    return *of_one, max(grains.density for grains in case.kinds), max(diameters)


def limits(case, parameters, state, pace: float, known: dict[str, float]) -> dict[str, float]:
    """Longest sub-steps [s] by cause, infinite where nothing limits: what each effect bears, and sound of `pace` [m/s]
    (sdph.methods.grains.sound); `known` of `sdph.effects.effect.Live`."""
    of_sound = {"sound": sound.limit(case.smoothing_length, pace) if pace else NO_LIMIT}
    live = Live(state, known | {"artificial_viscosity": pace})
    return of_sound | effects.limits(parameters, case, live)
