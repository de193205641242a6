"""Moving particles through one step: kick by what acts, pressure that keeps n, kick by it, collisions, drift."""

from __future__ import annotations

import math

import numpy as np

from sdph import effects
from sdph.engine import arrays, gathered, linear, motion, world
from sdph.engine import state as particles
from sdph.engine.clock import count_of_parts
from sdph.engine.kept import GROWING
from sdph.engine.neighbours import Neighbours
from sdph.engine.state import LIQUID
from sdph.engine.world import ALONE
from sdph.laws import moving_particles
from sdph.methods.mps import alone, compressible, equations, pools, start, tanks
from sdph.methods.mps.bounds import MpsGuard
from sdph.methods.mps.holes import Holes
from sdph.methods.mps.openings import Openings
from sdph.schema import CaseError

WORKS = ("gravity", "viscosity", "tension", "pressure", "collisions", "holes")
RELATIVE = 0.2  # of l0 that neighbours may move to each other in a step; swirl-sheet.md, section 2, 12
COURANT = 0.2  # of l0 that a particle of a pool moves in a step, whose way is bent: Koshizuka & Oka 1996
FALL = 0.1  # of sqrt(l0/g), so that a fall from rest by a step is 0.005 l0; our choice


class MpsStepper:
    """Particles of an incompressible liquid, and how they go forward."""

    # see sdph.engine.kept
    KEPT = (
        "state", "neighbours", "time", "steps", "limit", "works", "impulses", "iterations", "clipped",
        "openings", "load", "moved", "holes", "fallen", "drawn",
    )  # fmt: skip
    FORMS = {"state": GROWING}
    # what loops take from neighbours, fresh, of `state` and of what `_look` finds; the pressure is solved for by all
    HALO = (*"xyzuvw", "kind", "ident", "pressure", "density", "surface")
    SEEN = ("number", "surface", "energy")  # arrays of the particles that outputs read
    ROWS = ()  # all that goes on from one step to the next is in the state

    def __init__(self, case, shortest: float = 0.0):
        self.case, self.own, self.guard, self.shortest = case, case.method, MpsGuard(case), shortest
        self.p = {row.name: effects.kernel_of(row, case) for row in effects.REGISTRY.values()}
        self.cloud, unit = cloud(case), case.resolution.spacing
        self.pool = case.method.of_pools(case)
        self.state = start.fill(case)
        self.walls = tanks.walls_of(case, self.state)
        self.world = world.here()
        self.openings = Openings(case, self.state, self.world) if self.p["inflow"] or self.p["outflow"] else None
        if self.openings:
            self.state = self.openings.begin(self.state)
        self.holes = Holes(case, self.p, self.world) if self.p["perforation"] or self.p["suction"] else None
        sees, skin = self.own.sees(case) * unit, case.resolution.neighbour_skin
        self.neighbours = Neighbours(sees, case.liquid_period, skin, self.world)
        self.domain = self.neighbours.domain
        self.room, self.landed = arrays.Room(), None  # see sdph.engine.ashore
        self.time, self.steps, self.steps_before, self.limit = 0.0, 0, 0, ""
        self.works, self.impulses = np.zeros(len(WORKS)), np.zeros((2, 3))  # of gravity, of what waits
        self.fallen = self.drawn = 0.0  # work [J] of weight and of tension over the ways that the liquid went
        self.iterations = 0  # of all steps
        self.clipped = 0.0  # pressure below 0 that was left out, of all steps: sum of Pa
        self.load = np.zeros(3)  # of the pressure on walls [N], in the last step
        self.freed = np.zeros(0, bool)  # where the surface was drawn apart in the last step
        self.at_walls = 0.0, 0.0  # pairs of liquid and wall in the last step, and those whose wall would pull
        self.moved = 0.0  # longest way [l0] by which particles were kept apart in the last step
        self._rebuild()
        if self.walls and not self.world.any((self.domain.mine_of(self.surface) == 1).any()):
            raise CaseError("no particle is at a free surface, and mps gives a closed vessel no pressure: fill it less")

    def revive(self) -> None:
        """Make anew what a checkpoint does not hold, once it was put back; it holds the particles of all processes."""
        self.steps_before = self.steps
        if self.domain.alone:
            self.rows = self.neighbours.relist(self.state.kind)
        else:
            gathered.take_part(self)
        self._look()

    def admit(self, kept: dict) -> None:
        """Unfit where the particles cannot be of this case."""
        self.guard.admit_mps(kept["state"])

    @property
    def active(self):
        """Rows of the own particles that move by the equations."""
        return alone.of_kind(self.domain.own(self.state), LIQUID)

    @property
    def pressure(self):
        """Pressure (N,) [Pa] of the solver, a field of the state."""
        return self.state.pressure

    @property
    def around(self):
        """Arguments that every loop begins with."""
        return self.cloud, self.walls, self.state, self.rows, self.neighbours.box

    @property
    def within(self):
        """The same with rows of those within r_e, as they were at `_look`."""
        return self.cloud, self.walls, self.state, self.links, self.neighbours.box

    def step(self, most: float) -> float:
        """One step, no longer than `most` [s]; returns its length."""
        dt, active = self.next_step(most), self.active
        for name, acceleration in self._acting():
            self._kick(name, acceleration, dt, active)
        self.tell_velocities()
        self._kick("pressure", self._pressed(dt), dt, active)
        self.tell_velocities()
        self._collide(active)
        if self.holes:
            self._kick("holes", self.holes.advance(self, dt), 1.0, active)
        s, before = self.state, alone.energy_in_gravity(self, active)
        self.drawn += alone.drawn(self, active, dt)
        motion.drift(active, s.u, s.v, s.w, dt, s.x, s.y, s.z)
        if self.pool:
            self._keep_apart(active)
        self.fallen += before - alone.energy_in_gravity(self, active)
        if self.openings:
            self.openings.move(self.domain.own(s), self.time, dt)
        self.time += dt
        self.steps += 1
        if self.openings:
            self.openings.renew(self)
        self._rebuild()
        return dt

    def tell_velocities(self) -> None:
        """Have the velocities of copies as they are now."""
        self.domain.refresh(self.state.u, self.state.v, self.state.w)

    def _acting(self):
        """(cause, acceleration (N, 3) [m/s2]) of all that acts but the pressure, with the velocities as they are."""
        found, count = [], len(self.state.x)
        if self.p["gravity"]:
            falling = self._work("falling", (count, 3))
            alone.fall(*self.p["gravity"], falling)
            found.append(("gravity", falling))
        if self.p["laminar_viscosity"]:
            rubbed = self._work("acceleration", (count, 3))
            equations.rub(*self.within, self.case.liquid.viscosity / self.case.liquid.density, rubbed)
            found.append(("viscosity", rubbed))
        if self.p["free_energy_tension"]:
            found.append(("tension", self.pulled))
        return found

    def _work(self, name: str, shape, kind=np.float64):
        """Work array of that name, where the particles are; one acceleration is done with before the next is found."""
        return self.room(name, shape, self.state.x, kind)

    def _pressed(self, dt: float):
        """Acceleration (N, 3) [m/s2] by the pressure that takes the divergence out of the velocities (7), or answers
        it."""
        if self.own.pressure == "weakly_compressible":
            self.clipped += compressible.pressed(self, dt)
            return self._pushed(self.cloud.density / dt, None)
        cloud, own, count = self.cloud, self.own, len(self.state.x)
        source, beside = self._work("source", count), self._work("beside", count, np.int8)
        equations.near_surface(*self.within, self.surface, beside)
        if self.pool:
            pools.diverge(*self.within, beside, source)
        else:
            equations.diverge(*self.within, source)
        holds, self.freed = own.holds(self.case), self._work("freed", count, np.bool_)
        alone.source_of(
            cloud, self.state, self.number, beside, self.surface, dt, own.share_taken(self.case), holds, source,
            self.freed,
        )  # fmt: skip
        if self.walls:
            pools.lean(*self.within, cloud.density / dt, source)
        matrix = equations.matrix(*self.within, self.number, self.surface, self.room)
        try:
            self.iterations += linear.solve(
                matrix, source, self.pressure, own.tolerance, own.iterations, self.room, self.domain
            )
        except linear.Unsolved as error:
            self.guard.unsolved(self, error, source, matrix.diagonal)
        if holds:
            self.clipped += self.world.sum(alone.leave_out(self.domain.mine_of(self.pressure)))
        self.domain.refresh(self.pressure)
        self.beside = beside
        return self._pushed(cloud.density / dt, beside)

    def _pushed(self, scale: float, beside):
        """Acceleration (N, 3) [m/s2] by the pressure; scale: rho/dt."""
        s, count = self.state, len(self.state.x)
        pressed = self._work("acceleration", (count, 3))
        if not self.pool:
            equations.press(*self.within, self.pressure, pressed)
            return pressed
        borne = self._work("borne", (count, 3))
        self.at_walls = pools.press(*self.within, self.pressure, beside, scale, pressed, borne)
        own = self.domain.own(s)
        self.load = alone.summed(self.world, alone.add_load, 3, len(own.x), own, self.domain.mine_of(borne))
        return pressed

    def _keep_apart(self, active) -> None:
        """Particles inside a pool move to where there are few."""
        s, way = self.state, self._work("way", (len(self.state.x), 3))
        self.domain.refresh(s.x, s.y, s.z)
        pools.keep_apart(*self.around, self.beside, self.own.shift * self.cloud.spacing, way)
        self.moved = math.sqrt(self.world.most(alone.longest(way))) / self.cloud.spacing
        motion.kick(active, way, 1.0, s.x, s.y, s.z)

    def _kick(self, name: str, acceleration, dt: float, active) -> None:
        s = self.state
        work, *impulse = alone.summed(self.world, alone.add_kick, 4, len(active), s, active, acceleration, dt)
        self.works[WORKS.index(name)] += work
        self.impulses[0 if name == "gravity" else 1] += impulse
        motion.kick(active, acceleration, dt, s.u, s.v, s.w)

    def _collide(self, active) -> None:
        """Pairs nearer than they lie lose what they approach by."""
        s, own, count = self.state, self.own, len(self.state.x)
        distance, meeting = own.collision * self.cloud.spacing, self._work("meeting", count)
        found = equations.meet(self.walls, s, self.links, self.neighbours.box, distance, meeting)
        if self.world.any(found):
            self.domain.refresh(meeting)
            change = self._work("acceleration", (count, 3))
            equations.collide(
                self.walls, s, self.links, self.neighbours.box, distance, own.restitution, meeting, change
            )
            self._kick("collisions", change, 1.0, active)

    def next_step(self, left: float) -> float:
        """Length [s] of the next step: `left` in equal parts no longer than the shortest limit; `limit` names it."""
        relative = self.world.most(arrays.ends(self.speed)[1])
        found = limits(self.case, self.p, self.state, relative, self.world)
        self.limit = min(found, key=found.get, default="")
        longest = self.case.run.step_factor * found.get(self.limit, math.inf)
        return left / count_of_parts(
            left, longest, self.shortest, f"the step's limit {self.limit!r} (times run.step_factor)"
        )

    def share(self) -> None:
        """Rows of where the particles are now, and copies as they are."""
        self.state, self.rows = self.neighbours.update(self.state, *self.state[:6], self.state.kind)

    def _rebuild(self) -> None:
        """The same, and what is seen from there."""
        self.share()
        self._look()

    def _look(self) -> None:
        count = len(self.state.x)
        self.number, self.speed = self._work("number", count), self._work("speed", count)
        self.surface, near = self._work("surface", count, np.int8), self._work("near", count, np.int32)
        equations.look(*self.around, self.number, self.surface, self.speed, near)
        self.domain.refresh(self.surface)
        self.links = linear.links_of(near, self.room)
        equations.gather(*self.around, self.links, self.links.entries)
        if own := self.p["free_energy_tension"]:
            self.pulled, self.energy = self._work("pulled", (count, 3)), self._work("energy", count)
            equations.pull(self.cloud, own, *self.around[2:], self.pulled, self.energy)
        else:
            self.pulled, self.energy = (arrays.zeros(shape, self.state.x) for shape in ((count, 3), count))

    @property
    def gauge(self) -> np.ndarray:
        """Pressure (N,) [Pa] of the liquid: that of the solver less what only holds the cohesion of the lattice."""
        own = self.p["free_energy_tension"]
        return self.pressure + (own.cohesion if own else 0.0) * (self.surface == 0)

    def take(self, keep) -> None:
        """Take out the own particles that are not kept (N,); the next rows are made anew."""
        self.replace(particles.take(self.domain.own(self.state), keep))

    def replace(self, state) -> None:
        """Go on with another state; the next rows are made anew."""
        if state is not self.state:
            self.state, self.neighbours.built = self.domain.admitted(state), ()


def cloud(case) -> equations.Cloud:
    """Lattice numbers of a case."""
    unit, own, d = case.resolution.spacing, case.method, case.dimensions
    lattice = moving_particles.lattice(own.reach, d)
    return equations.Cloud(
        unit, own.reach * unit, lattice.number, lattice.spread * unit**2, float(d), case.liquid.density
    )


def limits(case, parameters, state, relative: float, own_world=ALONE) -> dict[str, float]:
    """Longest steps [s] by cause, of all processes of a world: neighbours that move to each other by `relative` [m/s],
    each effect."""
    unit, gravity = case.resolution.spacing, math.hypot(*case.domain.gravity) if "gravity" in case.effects else 0.0
    own = {"relative motion": RELATIVE * unit / relative} if relative else {}
    if gravity:
        own["gravity"] = FALL * math.sqrt(unit / gravity)
    if case.method.pressure == "weakly_compressible":
        sound = compressible.sound_speed(case, parameters["free_energy_tension"])
        own["sound"] = compressible.COURANT * unit / sound
    if case.method.of_pools(case) and (speed := own_world.most(alone.fastest(state))):
        own["motion"] = COURANT * unit / math.sqrt(speed)
    return own | effects.finite(own_world.leasts(effects.limits(parameters, case, state)))
