"""Solids through one step: kick, drift, deformation, stress, cuts, forces, kick (velocity Verlet)."""

from __future__ import annotations

import numpy as np

from sdph import effects
from sdph.effects.solids import rigid_sides
from sdph.engine import kernels as smoothing
from sdph.engine import motion
from sdph.engine import state as particles
from sdph.engine.clock import count_of_parts
from sdph.engine.contact import Contact, Touching
from sdph.engine.kept import Unfit
from sdph.methods.solids import equations, start
from sdph.methods.solids.bounds import SolidGuard
from sdph.methods.solids.cavity import Cavity
from sdph.methods.solids.weights import Weights, keep_strain
from sdph.schema import CaseError

WORKS = ("forces", "hourglass", "viscosity", "pressure", "plastic", "cut", "gravity", "scaling")
IMPULSES = ("gravity", "sides", "clamp", "liquid", "scaling")


class SolidStepper:
    """Particles of the bodies of a case, and how they go forward."""

    # see sdph.engine.kept
    KEPT = (
        "state", "time", "steps", "limit", "works", "impulses", "acting", "springs", "touching", "cavity", "free",
        "broken",
        "unloaded", "strained", "hardened", "harm", "gradient", "stress", "kirchhoff", "amounts", "acceleration",
        "steadying", "friction", "pressed", "inverted",
    )  # fmt: skip

    # what the loops of a step take from neighbours, fresh, beside the undeformed bodies, which stay as they are
    HALO = (*"xyzuvw", "gradient", "stress", "free")

    def __init__(self, case, shortest: float = 0.0, *, wet: bool = False, sides=None):
        self.case, self.guard, self.shortest = case, SolidGuard(case), shortest
        self.wet = wet  # whether a liquid presses on the bodies
        made = start.Made(case)
        self.state, self.body, self.held = made.state, made.body, made.held
        self.p = {row.name: effects.kernel_of(row, case) for row in effects.REGISTRY.values()}
        self.p["rigid_sides"] = self.p["rigid_sides"] if sides is None else sides  # of a tank
        self.kernel = smoothing.smoothing(case.solid.kernel, case.dimensions, case.smoothing_length)
        self.material = start.material(case)
        self.plastic, self.damage = start.plastic(case), start.damage(case)
        self.reference = particles.positions(self.state)
        self.weights = Weights(self.kernel, self.reference, made.volume, made.body, case.dimensions)
        if not self.weights.correction.any(axis=1).all():
            thin = "has too few neighbours to tell a deformation"
            raise CaseError(f"a particle of [bodies] {thin}; give a finer resolution.spacing_mm, or enlarge the body")
        for number in case.track:
            if not 1 <= number <= len(made.volume):
                raise CaseError(f"track.particles holds {number}; the case has {len(made.volume)}, counted from 1")
        self.active = np.flatnonzero(~made.held).astype(np.int32)
        self.touching = Touching(contact(case), made.body)
        self.sides = rigid_sides.Sides(self.p["rigid_sides"], made, self.touching.contact, list(case.bodies))
        self.cavity = self._cavity(made)
        self.time, self.steps, self.limit = 0.0, 0, ""
        self.works, self.impulses = np.zeros(len(WORKS)), np.zeros((len(IMPULSES), 3))
        self.acting = np.zeros((len(IMPULSES), 3))  # forces [N] of now, by the names of IMPULSES
        self.springs, self.inverted = 0.0, 0  # energy [J] of contact; particles that failed turned inside out
        self._allocate(len(self.state.x))
        self.load = np.zeros_like(self.pressed) if wet else None  # forces (N, 3) [N] of the liquid
        self.forces(1.0)  # nothing flows at rest: the length of a step decides nothing

    def _allocate(self, count: int) -> None:
        self.free, self.broken = self.weights.free, self.weights.broken
        self.unloaded = np.tile([1.0, 1.0, 1.0, 0.0, 0.0, 0.0], (count, 1))
        self.strained, self.hardened, self.harm = np.zeros((3, count))
        self.gradient, self.stress, self.kirchhoff = np.zeros((count, 9)), np.zeros((count, 9)), np.zeros((count, 6))
        self.amounts = np.zeros((count, 3))
        self.acceleration, self.steadying, self.friction = np.zeros((3, count, 3))
        self.pressed = np.zeros((count if self.cavity or self.wet else 0, 3))

    def _cavity(self, made):
        own = self.p["inflation"]
        if not own:
            return None
        return Cavity(own, start.circles(self.case, self.case.parameters["inflation"].body), made)

    def revive(self) -> None:
        """Cut links as they were, after a checkpoint was put back."""
        own = self.weights
        own.free[:], own.broken[:] = self.free, self.broken
        own.cut(np.zeros(len(self.free), bool))
        self.free, self.broken = own.free, own.broken
        self.touching.find(self.free)

    def admit(self, kept: dict) -> None:
        """Unfit where the particles cannot be of this case."""
        self.guard.admit_solid(kept["state"], self.state)
        if not (np.isin(kept["free"], (0, 1)).all() and np.isin(kept["broken"], (0, 1)).all()):
            raise Unfit("free or broken is neither 0 nor 1 somewhere")

    @property
    def ref(self) -> equations.Reference:
        """Undeformed bodies as kernels take them."""
        own = self.weights
        return equations.Reference(*own.axes, own.volume, own.slope, own.correction, own.free)

    def step(self, most: float) -> float:
        """One step, no longer than `most` [s]; returns its length."""
        dt = self.next_step(most)
        self.set_off(dt)
        self.arrive(dt)
        return dt

    def hasten(self, pace: float, kick: float) -> None:
        """Let `pace` seconds pass for what goes by time in each second of motion (sdph.effects.liquids.time_scaling);
        velocities become `kick` times as large."""
        s, plastic = self.state, start.plastic(self.case)
        self.plastic = plastic and plastic._replace(reference_rate=pace * plastic.reference_rate)
        if kick == 1.0:
            return
        before, motion_before = particles.energy_of_motion(s), s.mass @ particles.velocities(s)
        for axis in (s.u, s.v, s.w):
            axis *= kick
        self.works[WORKS.index("scaling")] += particles.energy_of_motion(s) - before
        self.impulses[IMPULSES.index("scaling")] += s.mass @ particles.velocities(s) - motion_before

    def set_off(self, dt: float) -> None:
        """The first half of the kick of a step of `dt` [s], and the way."""
        s = self.state
        self._kick(0.5 * dt)
        before = self._height()
        motion.drift(self.active, s.u, s.v, s.w, dt, s.x, s.y, s.z)
        self.works[WORKS.index("gravity")] += self._height() - before
        self.time += dt

    def arrive(self, dt: float) -> None:
        """Forces at the end of the step, and the second half of the kick."""
        self.forces(dt)
        self._kick(0.5 * dt)
        self.steps += 1

    def _kick(self, dt: float) -> None:
        s = self.state
        found = equations.kick(
            s.mass, self.active, self.acceleration, self.steadying, self.friction, self.pressed, dt, s.u, s.v, s.w
        )
        self.works[: len(found)] += found
        self.impulses += dt * self.acting

    def _height(self) -> float:
        """sum m g.r [J] of what moves; 0 without gravity."""
        if not self.p["gravity"]:
            return 0.0
        places = particles.positions(self.state)[self.active]
        return float(self.state.mass[self.active] @ (places @ np.array(self.p["gravity"])))

    def next_step(self, left: float) -> float:
        """Length [s] of the next step: `left` in equal parts no longer than the shortest limit; `limit` names it."""
        found = limits(self)
        self.limit = min(found, key=found.get)
        longest = self.case.run.step_factor * found[self.limit]
        return left / count_of_parts(
            left, longest, self.shortest, f"the step's limit {self.limit!r} (times run.step_factor)"
        )

    def forces(self, dt: float) -> None:
        """Stress after a step of `dt` [s] and accelerations of where the particles are now."""
        self._deform()
        self._load(self.plastic, self.damage, dt)
        self.works[WORKS.index("plastic")] += self.weights.volume @ self.amounts[:, 1]
        while (broken := self._failed()).any():
            self._break(broken)
        s = self.state
        equations.push(
            self.kernel, self.material, s.x, s.y, s.z, s.u, s.v, s.w, self.weights.rows, self.ref, self.gradient,
            self.stress, self.acceleration, self.steadying, self.friction,
        )  # fmt: skip
        if self.cavity:
            self.cavity.push(s, self.gradient, self.time, self.pressed)
        if self.wet:
            np.divide(self.load, s.mass[:, None], out=self.pressed)
            self.acting[IMPULSES.index("liquid")] = self.load.sum(axis=0)
        if len(self.pressed):
            self.acceleration += self.pressed
        self.springs = self._touch()
        self.acting[IMPULSES.index("clamp")] = -(s.mass[self.held] @ self.acceleration[self.held])
        energy, self.acting[IMPULSES.index("sides")] = self.sides.press(s, self.acceleration)
        self.springs += energy
        if self.p["gravity"]:
            self.acceleration += self.p["gravity"]
            self.acting[IMPULSES.index("gravity")] = s.mass[self.active].sum() * np.array(self.p["gravity"])

    def _deform(self) -> None:
        equations.deform(self.state.x, self.state.y, self.state.z, self.weights.rows, self.ref, self.gradient)

    def _load(self, plastic, damage, dt: float) -> None:
        equations.load(
            self.material, plastic, damage, self.ref, dt, self.gradient, self.unloaded, self.strained,
            self.hardened, self.harm, self.stress, self.kirchhoff, self.amounts,
        )  # fmt: skip

    def _failed(self) -> np.ndarray:
        """Mask (N,) of particles that fail now: by damage, or turned inside out, where there is no strain to go by."""
        inverted = self.amounts[:, 2] <= 0.0
        if not self.damage:
            self.guard.refuse_inverted(self, inverted)
            return inverted
        return (self.harm >= self.damage.critical) & (self.free == 0) | inverted

    def _break(self, broken) -> None:
        """Cut what has failed; the energy that it had is told. Without its links the neighbours tell another
        deformation: theirs begins anew at the stress that they bear, and nothing flows by a cut."""
        self.inverted += int((self.amounts[:, 2] <= 0.0).sum())
        before, bound, last = self.elastic_energy, self.free.copy(), self.gradient.copy()
        self.weights.cut(broken)
        self.touching.break_off(self.state, bound, self.free)
        self._deform()
        keep_strain(self.free, last, self.gradient, self.unloaded)
        self._load((), (), 1.0)
        self.works[WORKS.index("cut")] += before - self.elastic_energy

    def _touch(self) -> float:
        """Contact of bodies and of what has broken off; its energy [J]."""
        if len(self.case.bodies) == 1 and not self.free.any():
            return 0.0
        self.touching.update(self.state, self.free)
        return self.touching.forces(self.state, self.acceleration)

    @property
    def elastic_energy(self) -> float:
        """Elastic energy [J] of all links."""
        return float(self.weights.volume @ self.amounts[:, 0])


def contact(case) -> Contact:
    """Springs of bodies that touch: k = rho c^2 dx^(d-2)."""
    spacing = case.resolution.spacing
    return Contact(spacing, case.solid.density * start.sound(case) ** 2 * spacing ** (case.dimensions - 2))


def limits(stepper) -> dict[str, float]:
    """Longest steps [s] by cause: waves across the least stretched element, contact where there is any, each effect."""
    case = stepper.case
    stretch = float(stepper.amounts[:, 2].min())
    found = {"waves": case.solid.courant * case.smoothing_length * stretch / start.sound(case)}
    if stepper.springs or len(stepper.touching.pairs) or stepper.sides.near(stepper.state):
        found["contact"] = stepper.touching.contact.limit(float(stepper.state.mass.min()))
    return found | effects.finite(effects.limits(stepper.p, case, stepper.state))
