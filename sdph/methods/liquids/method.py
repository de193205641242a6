"""A liquid through one step: kick, drift, density in the middle, drift, pressure and forces, kick.

Second order and symmetric in time, with one evaluation of the forces a step (Adami, Hu & Adams 2012, section 2.6).
"""

from __future__ import annotations

import math

import numpy as np

from sdph import effects
from sdph.effects import OFF
from sdph.effects.around import frame, tank
from sdph.engine import arrays, gathered, motion, world
from sdph.engine import kernels as smoothing
from sdph.engine import state as particles
from sdph.engine.clock import count_of_parts
from sdph.engine.kept import GROWING
from sdph.engine.neighbours import Neighbours
from sdph.engine.state import GAS, INFLOW, WALL
from sdph.laws import kernels
from sdph.methods.liquids import bodies as immersion
from sdph.methods.liquids import bubbles, correction, interface, openings, parts, phases, shift, start, walls
from sdph.methods.liquids import equations as rates
from sdph.methods.liquids.bounds import LiquidGuard, born, limits
from sdph.methods.liquids.heat import Heat
from sdph.methods.liquids.start import fluids, parts_of
from sdph.methods.liquids.walls import WallP

SLACK = 1.0125  # reach over 2 h: a particle may move 0.025 h, half a step, after the rows were found to hold
NO_WALL = WallP(*[0.0] * 10)


def reach(case) -> float:
    """Distance [m] up to which particles of a liquid see each other for as long as rows hold."""
    return 2.0 * SLACK * case.smoothing_length


class LiquidStepper:
    """Liquid and wall particles of a case, and how they go forward."""

    # see sdph.engine.kept
    KEPT = (
        "state", "neighbours", "time", "steps", "limit", "shifted", "eased", "pressure", "volume", "acceleration",
        "gradient", "shift", "twist", "extra", "excess", "openings", "void", "heat",
    )  # fmt: skip
    # of the particles
    ROWS = ("pressure", "volume", "acceleration", "gradient", "shift", "twist", "extra", "excess")
    SEEN = ("active", "walls", "enclosed", *ROWS)  # see sdph.engine.ashore
    FORMS = dict.fromkeys(("state", *ROWS), GROWING)
    # what the loops of a step take from neighbours and theirs, fresh, of `state` and of ROWS
    HALO = (*"xyzuvw", "mass", "density", "kind", "depth", "pressure", "volume", "gradient")

    def __init__(self, case, shortest: float = 0.0, carrier: immersion.Carrier | None = None):
        self.case, self.guard, d = case, LiquidGuard(case), case.dimensions
        self.shortest = shortest  # step [s] below which the run gets nowhere
        self.p, self.state, self.move = parts_of(case, own := start.world_of(case))
        self.viscous = self.p["shear_thinning"] or self.p["laminar_viscosity"]  # parameters of friction, for the loops
        self.renewing = [(row, self.p[name]) for name in case.effects if (row := effects.REGISTRY[name]).renew]
        self.kernel = smoothing.smoothing(case.liquid.kernel, d, case.smoothing_length)
        self.world = world.here()
        self.neighbours = Neighbours(reach(case), case.liquid_period, case.resolution.neighbour_skin, self.world)
        self.domain = self.neighbours.domain
        self.fluids, self.phases, self.domain.parted = fluids(case), phases.kernel(case), own.number > 1
        self.bodies, self.moving = immersion.Bodies(carrier, case) if carrier else None, ()
        # walls follow the liquid, those of the outlet pipe come last
        first_of_pipe = own.sum(len(self.state.x)) - start.pipe_walls(case)
        if self.bodies:
            self.state = self.bodies.immersed(case, self.state)
            first_of_pipe = self.bodies.first  # beside bodies there is no pipe
        self.own_walls = range(own.sum(int((self.state.kind != WALL).sum())), first_of_pipe)  # of the tank's own
        self.parts = parts.Parts(case, self.state, self.own_walls) if case.run.forces else None
        self.openings = openings.Openings(case, self.state) if self.p["inflow"] or self.p["outflow"] else None
        if self.openings:
            self.state = self.openings.begin(self.state)
        behind = self.p["tank"] or (immersion.wall_of(case) if self.bodies else ())
        self.wall = WallP(*[0.0] * 6, *behind) if behind else NO_WALL
        self.summed = case.gas_phase is not None and case.gas_phase.density_by == "summation"
        self.lattice = kernels.lattice_factor(case.liquid.kernel, d, case.resolution.smoothing_ratio)
        self.limit, self.steps, self.time, self.steps_before = "", 0, 0.0, 0
        self.shifted, self.eased = np.zeros(3), np.zeros(2)  # what shifting gave [kg m/s], and `shift.displace` told
        self.tightening = np.zeros((0, 3))  # acceleration by surface tension [m/s2]
        self.compliance = np.array([self._compliance(kind) for kind in range(GAS + 1)])
        self.aim(0.0)
        self.heat = None  # until it is known what there is to heat
        self.void = bubbles.Bubbles(case, self.p["bubble"], self.state, self.bodies) if self.p["bubble"] else None
        self.landed = None  # see sdph.engine.ashore
        self.look = None  # who is told of new forces, with the length [s] of the kick to come
        self.born = born(self.state, own)
        self.forces()
        self.heat = Heat(self, self.p["liquid_heat"]) if self.p["liquid_heat"] else None
        if self.bodies:
            carrier.meet(self.bodies.force(self))

    def revive(self) -> None:
        """Make anew what a checkpoint does not hold, once it was put back; it holds the particles of all processes."""
        self.steps_before = self.steps
        if self.domain.alone:
            self.rows = self.neighbours.relist(self.state.kind)
            self.tell_apart()
        else:
            gathered.take_part(self, self._allocate)
        self.enclosed = self.state.enclosure
        self.aim(self.time)

    def admit(self, kept: dict) -> None:
        """Unfit where the particles cannot be of this case, or other arrays are not one row a particle each."""
        self.guard.admit_stepper(self, kept)

    @property
    def flow(self) -> rates.Flow:
        """Values that loops share."""
        return rates.Flow(self.active, self.pressure, self.volume, self.enclosed)

    def step(self, most: float) -> float:
        """One step, no longer than `most` [s]; returns its length."""
        dt = self.next_step(most)
        if self.bodies:
            self.bodies.set_off(dt)
        self._kick(0.5 * dt)
        self._drift(0.5 * dt)
        self.domain.refresh(*self.state[:6])  # places and velocities
        if not self.summed:
            self._densify(dt)
        self._drift(0.5 * dt)
        if self.p["shifting"]:
            self._shift(dt)
        if self.openings:
            self.openings.move(self.state, self.time, dt)
        self.time += dt
        self.aim(self.time)
        if self.openings:
            self.openings.renew(self)
        self.forces(0.5 * dt)
        if self.frame:
            motion.turn(self.active, self.frame, dt, self.acceleration)
        self._kick(0.5 * dt)
        if self.bodies:
            self.bodies.carrier.arrive(dt, self.bodies.force(self))
        self.steps += 1
        return dt

    def next_step(self, left: float) -> float:
        """Length [s] of the next step: `left` in equal parts no longer than the shortest limit; `limit` names it."""
        speed, force = self.world.most(np.array(motion.fastest(self.state, self.active, self.acceleration)))
        c = self.case.fastest_sound
        if not speed + 0.0 * force <= c * c:  # or one of them is no number
            self.guard.look(self)
        found = limits(self.case, self.p, self.state, math.sqrt(speed), math.sqrt(force))
        if self.bodies:
            found |= self.bodies.limits(self.state)
        found = effects.finite(self.world.leasts(found))
        self.limit = min(found, key=found.get)
        longest = self.case.run.step_factor * found[self.limit]
        return left / count_of_parts(
            left, longest, self.shortest, f"the step's limit {self.limit!r} (times run.step_factor)"
        )

    def _compliance(self, kind: int) -> float:
        """d rho/dp = 1/c^2 [s2/m2] of a kind, by which shifting carries density along the pressure gradient."""
        gas = self.case.gas_phase
        return (gas.speed_of_sound(self.case.liquid) if gas and kind == GAS else self.case.liquid.sound_speed) ** -2

    def aim(self, time: float) -> None:
        """The frame's acceleration and rotation at `time` [s]."""
        self.frame = OFF
        if self.move:
            acceleration, omega, rate = self.move(time)
            self.frame = frame.FrameP(*map(float, (*acceleration, *omega, *rate)))

    def _kick(self, dt: float) -> None:
        s = self.state
        motion.kick(self.active, self.acceleration, dt, s.u, s.v, s.w)
        for velocity, push in zip((s.u, s.v, s.w), particles.pushes(s)):
            if len(push):
                velocity += dt * push

    def _drift(self, dt: float) -> None:
        s = self.state
        motion.drift(self.active, s.u, s.v, s.w, dt, s.x, s.y, s.z)
        if self.p["xsph"]:
            motion.drift(self.active, *self.extra, dt, s.x, s.y, s.z)
        if self.bodies:
            self.bodies.drift(s, dt)

    def _densify(self, dt: float) -> None:
        rates.compress(
            self.kernel, self.state, self.rows, self.neighbours.box, self.flow, self.wall, self.moving,
            self.p["density_diffusion"], self.phases, correction.of_continuity(self), self.gradient, self.rate,
        )  # fmt: skip
        motion.densify(self.active, self.rate, dt, self.state.density)

    def forces(self, ahead: float = 0.0) -> None:
        """Neighbours, pressure, walls, accelerations of where the particles are now, before a kick by `ahead` [s]."""
        built = self.neighbours.built
        if self.bodies and self.moving:
            self.bodies.place(self.state)
        self.state, self.rows = self.neighbours.update(self.state, *self.state[:6], self.state.density)
        if built is not self.neighbours.built:
            self._allocate()
        s, p = self.state, self.p
        if self.bodies:
            self.bodies.let_go(self.volume)
        around = self.kernel, s, self.rows, self.neighbours.box, self.active
        if self.summed:
            rates.sum_up(*around, self.lattice, s.density)
            self.domain.refresh(s.density)
        rates.state_of(self.fluids, s, self.wet, self.pressure, self.volume)
        if p["bubble"] and p["bubble"].vapour and ahead:
            self.void.boil(self, 2.0 * ahead)
            rates.state_of(self.fluids, s, self.wet, self.pressure, self.volume)
        if self.openings:
            openings.wait(self, around[:-1])
        if len(self.walls):
            walls.extrapolate(
                self.kernel, s, self.rows, self.neighbours.box, self.walls, self.wall, self.moving, p["gravity"],
                self.frame, self.volume, self.pressure, s.u, s.v, s.w,
            )  # fmt: skip
        self.domain.refresh(self.pressure, s.u, s.v, s.w)
        for row, own in self.renewing:
            row.renew(own, self)
        if self.excess:
            correction.surround(*around, self.volume, *self.excess)
            self.domain.refresh(*self.excess)
        self.enclosed = arrays.copy(s.enclosure)  # what pairs go by until the next forces: shifting looks around anew
        rates.push(
            self.kernel, s, self.rows, self.neighbours.box, self.flow, self.wall, p["gravity"], self.frame,
            self.viscous, p["liquid_damping"], p["density_diffusion"], p["shifting"], self.phases, self.excess,
            self.acceleration, self.gradient,
        )  # fmt: skip
        if p["surface_tension"]:
            interface.tighten(self)
        if self.void:
            self.void.press(self, 2.0 * ahead)
        if self.bodies:
            self.bodies.keep_off(self)
        self.domain.refresh(self.acceleration, self.gradient)
        shift.prepare(self, around)
        if self.look:
            self.look(ahead)

    def _allocate(self) -> None:
        """Work arrays for the particles in their new order; none outlives a step."""
        s = self.state
        self.tell_apart()
        count = len(s.x)
        self.pressure, self.volume = self._room(count), self._room(count)
        rates.turn_inside(s, self.volume)
        self.acceleration, self.gradient = self._room((count, 3)), self._room((count, 3))
        corrected = self.case.liquid.pressure_gradient == "corrected"
        self.excess = tuple(self._room(count) for _ in range(6)) if corrected else ()
        shifted = count if self.p["shifting"] else 0
        self.extra = tuple(self._room(count if self.p["xsph"] and len(axis) else 0) for axis in (s.x, s.y, s.z))
        self.shift, self.twist = self._room((shifted, 3)), self._room((shifted, 9))

    def _room(self, shape, kind=np.float64):
        """Array of a shape, all 0, where the particles are."""
        return arrays.zeros(shape, self.state.x, kind)

    def tell_apart(self) -> None:
        """Tell liquid particles, those that wait, those of the walls that liquid is near; arrays that no step takes
        from the last."""
        s = self.state
        wet, wall = self._room(len(s.x), np.bool_), self._room(len(s.x), np.bool_)
        rates.tell(s.kind, self.rows.number, wet, wall)
        self.waiting = self.domain.mine(s, s.kind == INFLOW) if self.openings else ()
        self.wet, self.active = arrays.chosen(wet), self.domain.mine(s, wet)  # copies too, own ones
        self.walls = self.domain.mine(s, wall)
        self.moving = self.bodies.find(s) if self.bodies else ()
        if self.bodies:
            self.bodies.look(self)
        self.rate = self._room(len(s.x))
        near = len(s.x) if self.p["surface_tension"] else 0
        self.normal, self.curvature = self._room((near, 3)), self._room(near)
        blown = len(s.x) if self.p["bubble"] else 0
        self.inflating, self.facing = self._room((blown, 3)), self._room(blown)  # see sdph.methods.liquids.faces

    @property
    def capacity(self) -> float:
        """Mass [kg] of the liquid that would fill the tank, its outlet pipe left out."""
        return self.case.liquid.density * tank.shape_of(self.case).volume

    def leave(self, keep) -> None:
        """Take the particles out that are not kept (N,); the next forces make neighbours anew."""
        self.replace(particles.take(self.state, keep))

    def replace(self, state) -> None:
        """Go on with another state; the next forces make neighbours anew."""
        if state is not self.state:
            self.state, self.neighbours.built = self.domain.admitted(state), ()

    def _shift(self, dt: float) -> None:
        s, before = self.state, np.array(motion.momentum(self.state, self.active))
        eased = shift.displace(
            self.p["shifting"], self.fluids, s, self.active, self.shift, self.gradient, self.twist, self.compliance,
            (self.p["gravity"], dt), s.x, s.y, s.z, s.u, s.v, s.w, s.density,
        )  # fmt: skip
        given = self.world.sum(np.array([*(motion.momentum(s, self.active) - before), *eased]))
        self.shifted, self.eased = self.shifted + given[:3], self.eased + given[3:]
