"""Bodies that touch a liquid: it meets their particles as it meets those of a wall, but for that they move.

Pressure and velocity of a body's particle are extrapolated from the liquid in front (Adami, Hu & Adams 2012, J. Comput.
Phys. 231, 7057), with gravity and without the body's own acceleration: that is known from the step before, and would
drive a light body wild (our choice; an error of first order in the spacing). Force and friction of each pair go to the
body with the sign turned, so that momentum closes pair by pair.

A shell that stretches parts its particles, and liquid would get in between: it has contact with the polyline through
the shell's innermost particles (sdph.engine.polyline), from half a spacing on. There a liquid particle's own half width
ends; at rest it stands half a layer further off, so that the polyline bears where the particles no longer do.
"""

from __future__ import annotations

from typing import NamedTuple, Protocol

import numpy as np
import scipy

from sdph.effects.around import tank
from sdph.engine import contact, motion, polyline
from sdph.engine import state as particles
from sdph.engine.state import LIQUID, WALL
from sdph.methods.liquids import start, walls
from sdph.methods.liquids.forces import Moving
from sdph.methods.liquids.openings import NEAREST
from sdph.schema import CaseError

BEFORE = 0.5  # spacings: half of what a liquid particle fills, which a polyline keeps it off


class Shell(NamedTuple):
    """A ring: numbers (N,) of its innermost and outermost particles, counterclockwise, and its outer radius [m]."""

    inner: np.ndarray
    outer: np.ndarray
    radius: float

    @property
    def links(self) -> np.ndarray:
        """(N, 2) particles of the innermost circle and those next to them."""
        return np.stack([self.inner, np.roll(self.inner, -1)], axis=1)


class Carrier(Protocol):
    """Bodies as a liquid knows them, M particles in an order that stays.

    volume  (M,) [m^d]
    mass    (M,) [kg], and density [kg/m3] of what they are made of
    given   (4,) impulse [N s] and work [J] that they have got from the liquid
    shell   the ring that the liquid is in, None where there is none
    """

    volume: np.ndarray
    mass: np.ndarray
    density: float
    given: np.ndarray
    shell: Shell | None

    def places(self) -> np.ndarray:
        """(M, 3) [m]."""

    def velocities(self) -> np.ndarray:
        """(M, 3) [m/s]."""

    def lining(self) -> tuple[np.ndarray, float]:
        """Points (N, 2) [m] of the shell's innermost circle that have not broken off, and their area [m2]."""

    def links(self) -> np.ndarray:
        """Points (N, 2) [m] along the links of the shell's lining, which close a stretched one."""

    @property
    def torn(self) -> bool:
        """Tell whether a particle of the bodies has broken off."""

    def loose(self) -> np.ndarray:
        """(M,) bool: what has broken off, which the liquid no longer meets."""

    def limits(self) -> dict[str, float]:
        """Longest steps [s] by cause."""

    def set_off(self, dt: float) -> None:
        """The first half of the kick of a step of `dt` [s], and the way."""

    def meet(self, force: np.ndarray) -> None:
        """Forces (M, 3) [N] of the liquid at the start, which the first kick is with."""

    def arrive(self, dt: float, force: np.ndarray) -> None:
        """Forces at the end of the step, (M, 3) [N] of the liquid among them, and the second half of the kick."""


def beside(case, state, places):
    """The liquid and walls of a case less what stands where bodies have particles, places (N, 3) [m]; `CaseError` where
    no liquid is left."""
    here = particles.positions(state)
    gap, _ = scipy.spatial.cKDTree(places).query(here, distance_upper_bound=NEAREST * case.resolution.spacing)
    left = particles.take(state, np.isinf(gap))
    if not (left.kind == LIQUID).any():
        pools, bodies = ", ".join(f"[pools.{name}]" for name in case.pools), "bodies take all of its places"
        raise CaseError(f"no particle of the liquid is left of {pools}: {bodies}; move or shrink them, or the pools")
    return left


class Bodies:
    """Particles of a carrier within a liquid: wall particles, numbered behind all others; springs of the polyline:
    forces `pressed` (N, 3) [N] on all particles, and their energy [J]."""

    def __init__(self, carrier: Carrier, case):
        self.carrier = carrier
        self.first = 0  # their first number
        self.at = np.zeros(0, np.int64)  # (M,) where each stands
        self.moving = Moving(*np.zeros((3, 0)))
        self.links = carrier.shell.links if carrier.shell else np.zeros((0, 2), np.int64)
        self.contact = contact.Contact(BEFORE * case.resolution.spacing, contact.between(case).stiffness)
        self.pairs = np.zeros((0, 2), np.int64)  # of a liquid particle and a link, that may touch
        self.pressed, self.springs = np.zeros((0, 3)), 0.0

    def immersed(self, case, state):
        """The liquid and walls of a case less what stands in the bodies, and the bodies' particles behind them."""
        places, d = self.carrier.places(), case.dimensions
        state = beside(case, state, places)
        own = start.placed(case, places[:, :d])
        own.kind[:], own.density[:] = WALL, case.liquid.density
        own.mass[:] = case.liquid.density * self.carrier.volume
        self.first = len(state.x)
        state = particles.join(state, own)
        state.ident[:] = np.arange(len(state.ident))
        return state

    def find(self, state) -> Moving:
        """Find out where they stand in a state; velocities of all wall particles."""
        own = np.flatnonzero(state.ident >= self.first)
        self.at = np.empty(len(own), np.int64)
        self.at[state.ident[own] - self.first] = own
        self.moving = Moving(*np.zeros((3, len(state.ident))))
        self._tell()
        return self.moving

    def among(self, chosen) -> np.ndarray:
        """(W,) whether the wall particles `chosen` are theirs."""
        own = np.zeros(len(self.moving.u), bool)
        own[self.at] = True
        return own[chosen]

    def look(self, stepper) -> None:
        """Find what may touch the polyline while the rows of neighbours hold: all that move by less than half the skin
        since then."""
        own, wet = stepper.neighbours, stepper.active
        points = np.stack(own.built[:2], axis=1)
        first, second = (points[self.at[ends]] for ends in self.links.T)
        self.pairs = polyline.near(points[wet], first, second, self.contact.spacing + own.skin * own.reach)
        self.pairs[:, 0] = wet[self.pairs[:, 0]]

    def keep_off(self, stepper) -> None:
        """Add what the polyline does to the accelerations of a stepper; links with an end that has broken off bear
        nothing."""
        self.pressed, self.springs = np.zeros_like(stepper.acceleration), 0.0
        if not len(self.pairs):
            return
        s, bears = stepper.state, ~self.carrier.loose()[self.links].any(axis=1)
        self.springs = polyline.press(
            self.contact.stiffness, self.contact.spacing, s.x, s.y, self.at[self.links], bears, self.pairs,
            self.pressed,
        )  # fmt: skip
        own = stepper.active
        stepper.acceleration[own] += self.pressed[own] / s.mass[own, None]

    def limits(self, state) -> dict[str, float]:
        """Longest steps [s] by cause: the carrier's, and the polyline's for the liquid that may touch it."""
        found = self.carrier.limits()
        if len(self.pairs):
            found["polyline"] = self.contact.limit(float(state.mass[self.pairs[:, 0]].min()))
        return found

    def set_off(self, dt: float) -> None:
        """The carrier's kick, and velocities after it."""
        self.carrier.set_off(dt)
        self._tell()

    def drift(self, state, dt: float) -> None:
        """Go along for `dt` [s]."""
        motion.drift(self.at, *self.moving, dt, state.x, state.y, state.z)

    def let_go(self, volume) -> None:
        """No longer meet what has broken off: nothing of volume (N,) [m^d] is there for the liquid."""
        loose = self.carrier.loose()
        if loose.any():
            volume[self.at[loose]] = -0.0

    def place(self, state) -> None:
        """Go to where the carrier has them."""
        for axis, column in zip(particles.axes(state), self.carrier.places().T):
            axis[self.at] = column

    def force(self, stepper) -> np.ndarray:
        """(M, 3) [N] of the liquid on them now."""
        near = self.at[stepper.rows.number[self.at] > 0]
        found = np.zeros((len(stepper.state.x), 3))
        found[near] = walls.feel(stepper, near, 0.0)[:, :3]
        return (found + self.pressed)[self.at]

    def add_velocities(self, gain) -> None:
        """Add theirs to (N, 3) [m/s]."""
        gain[self.at] += np.stack([axis[self.at] for axis in self.moving], axis=1)

    def _tell(self) -> None:
        for axis, column in zip(self.moving, self.carrier.velocities().T):
            axis[self.at] = column


def wall_of(case) -> tank.TankP:
    """Parameters of bodies in a liquid without a tank: they slip, and do not pull."""
    return tank.acts(case, stick=0.0, least=0.0)
