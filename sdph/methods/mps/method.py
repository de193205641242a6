"""Moving particles through one step: kick by what acts, pressure that keeps n, kick by it, collisions, drift."""

from __future__ import annotations

import math

import numpy as np

from sdph import effects
from sdph.engine import linear, motion
from sdph.engine import state as particles
from sdph.engine.clock import count_of_parts
from sdph.engine.kept import GROWING
from sdph.engine.rows import Neighbours
from sdph.engine.state import INFLOW, LIQUID
from sdph.laws import moving_particles
from sdph.methods.mps import compressible, equations, pools, start, tanks
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
        "openings", "load", "moved", "holes",
    )  # fmt: skip
    FORMS = {"state": GROWING}
    # what loops take from neighbours, fresh, of `state` and of what `_look` finds; the pressure is solved for by all
    HALO = (*"xyzuvw", "kind", "ident", "pressure", "surface")

    def __init__(self, case, shortest: float = 0.0):
        self.case, self.own, self.guard, self.shortest = case, case.method, MpsGuard(case), shortest
        self.p = {row.name: effects.kernel_of(row, case) for row in effects.REGISTRY.values()}
        self.cloud, unit = cloud(case), case.resolution.spacing
        self.pool = case.method.of_pools(case)
        self.state = start.fill(case)
        self.walls = tanks.walls_of(case, self.state)
        self.openings = Openings(case, self.state) if self.p["inflow"] or self.p["outflow"] else None
        if self.openings:
            self.state = self.openings.begin(self.state)
        self.holes = Holes(case, self.p) if self.p["perforation"] or self.p["suction"] else None
        pulled = self.p["free_energy_tension"]
        reach = max(self.cloud.reach, pulled.reach if pulled else 0.0, self.own.piece * unit)
        self.neighbours = Neighbours(reach, case.liquid_period, case.resolution.neighbour_skin)
        self.energy = np.zeros(0)
        self.time, self.steps, self.limit = 0.0, 0, ""
        self.works, self.impulses = np.zeros(len(WORKS)), np.zeros((2, 3))  # of gravity, of what waits
        self.iterations = 0  # of all steps
        self.clipped = 0.0  # pressure below 0 that was left out, of all steps: sum of Pa
        self.load = np.zeros(3)  # of the pressure on walls [N], in the last step
        self.freed = np.zeros(0, bool)  # where the surface was drawn apart in the last step
        self.moved = 0.0  # longest way [l0] by which particles were kept apart in the last step
        self._rebuild()
        if self.walls and not (self.surface == 1).any():
            raise CaseError("no particle is at a free surface, and mps gives a closed vessel no pressure: fill it less")

    def revive(self) -> None:
        """Make anew what a checkpoint does not hold, once it was put back."""
        self.rows = self.neighbours.relist(self.state.kind)
        self._look()

    def admit(self, kept: dict) -> None:
        """Unfit where the particles cannot be of this case."""
        self.guard.admit_mps(kept["state"])

    @property
    def active(self) -> np.ndarray:
        """Numbers of the particles that move by the equations."""
        return np.flatnonzero(self.state.kind == LIQUID).astype(np.int32)

    @property
    def pressure(self) -> np.ndarray:
        """Pressure (N,) [Pa] of the solver, a field of the state."""
        return self.state.pressure

    @property
    def around(self):
        """Arguments that every loop begins with."""
        return self.cloud, self.walls, self.state, self.rows, self.neighbours.box

    def step(self, most: float) -> float:
        """One step, no longer than `most` [s]; returns its length."""
        dt, active = self.next_step(most), self.active
        for name, acceleration in self._acting():
            self._kick(name, acceleration, dt, active)
        self._kick("pressure", self._pressed(dt), dt, active)
        self._collide(active)
        if self.holes:
            self._kick("holes", self.holes.advance(self, dt), 1.0, active)
        s = self.state
        motion.drift(active, s.u, s.v, s.w, dt, s.x, s.y, s.z)
        if self.pool:
            self._keep_apart(active)
        if self.openings:
            self.openings.move(s, self.time, dt)
        self.time += dt
        self.steps += 1
        if self.openings:
            self.openings.renew(self)
        self._rebuild()
        return dt

    def _acting(self):
        """(cause, acceleration (N, 3) [m/s2]) of all that acts but the pressure, with the velocities as they are."""
        found, count = [], len(self.state.x)
        if self.p["gravity"]:
            found.append(("gravity", np.tile(np.array(self.p["gravity"]), (count, 1))))
        if self.p["laminar_viscosity"]:
            rubbed = np.empty((count, 3))
            equations.rub(*self.around, self.case.liquid.viscosity / self.case.liquid.density, rubbed)
            found.append(("viscosity", rubbed))
        if self.p["free_energy_tension"]:
            found.append(("tension", self.pulled))
        return found

    def _pressed(self, dt: float) -> np.ndarray:
        """Acceleration (N, 3) [m/s2] by the pressure that takes the divergence out of the velocities (7), or answers
        it."""
        if self.own.pressure == "weakly_compressible":
            self.clipped += compressible.pressed(self, dt)
            return self._pushed(self.cloud.density / dt, None)
        cloud, own, count = self.cloud, self.own, len(self.state.x)
        divergence, beside = np.empty(count), np.empty(count, np.int8)
        equations.near_surface(*self.around, self.surface, beside)
        if self.pool:
            pools.diverge(*self.around, beside, divergence)
        else:
            equations.diverge(*self.around, divergence)
        surplus = (self.number - cloud.number) / cloud.number
        surplus = np.where(beside == 1, np.maximum(surplus, 0.0), surplus)
        source = cloud.density / dt * (divergence - own.share_taken(self.case) * surplus / dt)
        source[self.state.kind == INFLOW] = 0.0
        self.freed = (self.surface == 1) & (source > 0.0) & (not own.holds(self.case))
        source[self.freed] = 0.0  # a surface that is drawn apart is not held together
        right = -cloud.spread * cloud.number / (2.0 * cloud.dimensions) * source
        if self.walls:
            pools.lean(*self.around, cloud.density / dt, right)
        matrix = equations.matrix(*self.around, self.number, self.surface)
        try:
            self.iterations += linear.solve(matrix, right, self.pressure, own.tolerance, own.iterations)
        except linear.Unsolved as error:
            self.guard.unsolved(self, error)
        pressure = self.pressure
        below = pressure < 0.0 if own.holds(self.case) else np.zeros(count, bool)
        self.clipped -= float(pressure[below].sum())
        pressure[below] = 0.0
        self.beside = beside
        return self._pushed(cloud.density / dt, beside)

    def _pushed(self, scale: float, beside) -> np.ndarray:
        """Acceleration (N, 3) [m/s2] by the pressure; scale: rho/dt."""
        pressed = np.empty((len(self.state.x), 3))
        if not self.pool:
            equations.press(*self.around, self.pressure, pressed)
            return pressed
        borne = np.empty_like(pressed)
        pools.press(*self.around, self.pressure, beside, scale, pressed, borne)
        self.load = -self.state.mass @ np.where((self.state.kind == LIQUID)[:, None], borne, 0.0)
        return pressed

    def _keep_apart(self, active) -> None:
        """Particles inside a pool move to where there are few."""
        s, way = self.state, np.empty((len(self.state.x), 3))
        pools.keep_apart(*self.around, self.beside, self.own.shift * self.cloud.spacing, way)
        self.moved = float(particles.lengths(way).max(initial=0.0)) / self.cloud.spacing
        for axis, column in zip(particles.axes(s), way.T):
            axis[active] += column[active]

    def _kick(self, name: str, acceleration, dt: float, active) -> None:
        s = self.state
        mass, change = s.mass[active], dt * acceleration[active]
        before = particles.velocities(s)[active]
        self.works[WORKS.index(name)] += float(mass @ np.einsum("ij,ij->i", change, before + 0.5 * change))
        self.impulses[0 if name == "gravity" else 1] += mass @ change
        motion.kick(active, acceleration, dt, s.u, s.v, s.w)

    def _collide(self, active) -> None:
        """Pairs nearer than they lie lose what they approach by."""
        s, own, count = self.state, self.own, len(self.state.x)
        distance, meeting, change = own.collision * self.cloud.spacing, np.empty(count), np.empty((count, 3))
        equations.meet(self.walls, s, self.rows, self.neighbours.box, distance, meeting)
        if meeting.any():
            equations.collide(self.walls, s, self.rows, self.neighbours.box, distance, own.restitution, meeting, change)
            self._kick("collisions", change, 1.0, active)

    def next_step(self, left: float) -> float:
        """Length [s] of the next step: `left` in equal parts no longer than the shortest limit; `limit` names it."""
        found = limits(self.case, self.p, self.state, float(self.speed.max(initial=0.0)))
        self.limit = min(found, key=found.get, default="")
        longest = self.case.run.step_factor * found.get(self.limit, math.inf)
        return left / count_of_parts(
            left, longest, self.shortest, f"the step's limit {self.limit!r} (times run.step_factor)"
        )

    def _rebuild(self) -> None:
        """Rows of where the particles are now, and what is seen from there."""
        self.state, self.rows = self.neighbours.update(self.state)
        self._look()

    def _look(self) -> None:
        count = len(self.state.x)
        self.number, self.surface, self.speed = np.empty(count), np.empty(count, np.int8), np.empty(count)
        equations.look(*self.around, self.number, self.surface, self.speed)
        self.pulled, self.energy = np.zeros((count, 3)), np.zeros(count)
        if own := self.p["free_energy_tension"]:
            equations.pull(self.cloud, own, *self.around[2:], self.pulled, self.energy)

    @property
    def gauge(self) -> np.ndarray:
        """Pressure (N,) [Pa] of the liquid: that of the solver less what only holds the cohesion of the lattice."""
        own = self.p["free_energy_tension"]
        return self.pressure + (own.cohesion if own else 0.0) * (self.surface == 0)

    def take(self, keep) -> None:
        """Take out the particles that are not kept (N,); the next rows are made anew."""
        self.replace(particles.take(self.state, keep))

    def replace(self, state) -> None:
        """Go on with another state; the next rows are made anew."""
        if state is not self.state:
            self.state, self.neighbours.built = state, ()


def cloud(case) -> equations.Cloud:
    """Lattice numbers of a case."""
    unit, own, d = case.resolution.spacing, case.method, case.dimensions
    lattice = moving_particles.lattice(own.reach, d)
    return equations.Cloud(
        unit, own.reach * unit, lattice.number, lattice.spread * unit**2, float(d), case.liquid.density
    )


def limits(case, parameters, state, relative: float) -> dict[str, float]:
    """Longest steps [s] by cause: neighbours that move to each other by `relative` [m/s], each effect."""
    unit, gravity = case.resolution.spacing, math.hypot(*case.domain.gravity) if "gravity" in case.effects else 0.0
    own = {"relative motion": RELATIVE * unit / relative} if relative else {}
    if gravity:
        own["gravity"] = FALL * math.sqrt(unit / gravity)
    if case.method.pressure == "weakly_compressible":
        sound = compressible.sound_speed(case, parameters["free_energy_tension"])
        own["sound"] = compressible.COURANT * unit / sound
    if case.method.of_pools(case) and (speed := float(particles.lengths(particles.velocities(state)).max(initial=0.0))):
        own["motion"] = COURANT * unit / speed
    return own | effects.limits(parameters, case, state)
