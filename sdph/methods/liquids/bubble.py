"""The bubble of a liquid: its void, what is in it, and its pressure on the liquid.

Void: area within the outermost ring of the liquid, and half of that ring, less the area of the liquid, m/rho of all; in
a shell (`Carrier.shell`) within the shell's innermost ring, less half of that. What the polygon of the ring misses at
the start is taken off for good, so that the first void is that of the case. In a torn shell it is flooded once a window
(sdph.methods.liquids.pores), from the area on that it has then.
Pressure: -2 p_b is added to p_i + p_j of all pairs of the liquid nearer to the void than to the rim; in a shell a share
of it, which falls to 0 within two reaches of the kernel. The sum of V_j grad W vanishes inside, which leaves p_b on the
void's face alone. What is given back is not equal and opposite pair by pair: what the sum over a closed void misses is
taken back (sdph.methods.liquids.closed). Of a void with a way out it is the thrust of what leaves, in
`impulse_of_bubble_*`.
"""

from __future__ import annotations

import math

import numpy as np
from numba import prange

from sdph.effects.liquids import bubble
from sdph.engine import kernels as smoothing
from sdph.engine import polygons
from sdph.engine import state as particles
from sdph.engine.geometry import apart
from sdph.engine.kept import Maybe
from sdph.engine.rows import entry, length
from sdph.laws import cavities
from sdph.laws.compiled import fast_parallel
from sdph.methods.liquids import closed, pores, totals
from sdph.methods.liquids.content import Content

SAME = 1e-6  # of a radius: round-off
# of 1/h: |sum V_j grad W| from which on a particle is at a face; 0.6 half a spacing behind a plane one, 0.2 another
# spacing on, disorder below 0.1; our choice
AT_FACE = 0.25
RAYS = 32  # directions in which the void's face is looked for; our choice


class Void(Content):
    """A bubble: void [m2], pressure over that around [Pa], mass [kg/m] and temperature [K] of vapour, heat that it got
    and with which it warmed [J/m]; passed (5,): mass, momentum and energy that the liquid gave to it, and mass that it
    still owes, of this step's warming; vented: mass that went out through a tear. In a shell, where there is one.
    unclosed (2,) and pushed: impulse [N s] that its push was off by while closed, and all its impulses."""

    # see sdph.engine.kept
    KEPT = (
        "area",
        "pressure",
        "mass",
        "temperature",
        "heat",
        "warmed",
        "owed",
        "passed",
        "vented",
        "rim",
        "missed",
        "corners",
        "held",
        "torn",
        "short",
        "width",
        "unclosed",
        "pushed",
    )
    FORMS = {"short": Maybe(0.0)}

    def __init__(self, case, p, state, bodies=None):
        self.p, pool = p, bubble.pool_of(case)
        self.carrier = bodies.carrier if bodies and bodies.carrier.shell else None
        self.spacing, self.torn = case.resolution.spacing, False
        x, y = state.x - pool.centre[0], state.y - pool.centre[1]
        r = np.where(particles.wet(state), np.hypot(x, y), 0.0)
        ring = np.flatnonzero((r > r.max() * (1.0 - SAME)) & (r > 0.0))
        self.loop = state.ident[ring][np.argsort(np.arctan2(y[ring], x[ring]))]  # counterclockwise
        first = self._begin(case, state)
        self.missed, self.corners = 0.0, 0  # corners of the lining, where there is one
        self.missed = self._measure(state) - first
        self.passed = np.zeros(5)
        self.unclosed, self.pushed = np.zeros(2), 0.0
        self.news: list[str] = []  # for the user, until somebody has passed them on

    def revive(self) -> None:
        """Forget news of the start: they were told before the checkpoint."""
        self.news.clear()

    def _begin(self, case, state) -> float:
        """Fill what there is of bubbles at the start; their void [m2]."""
        first = cavities.void(bubble.holes_of(case)[0].radius, 2)
        self.fill(self.p, first)
        return first

    def press(self, stepper, dt: float) -> None:
        """Add to the accelerations of a stepper, which hold for `dt` [s]; what was added is its `inflating` (N, 3)
        [m/s2]."""
        self._facing(stepper, self._outside(stepper))
        if not self.width:
            self._close_up(stepper, dt)
        stepper.acceleration += stepper.inflating

    def _close_up(self, stepper, dt: float) -> None:
        """Take from `inflating` what pushes or turns the liquid as a whole, and count it."""
        own, mass = stepper.active, stepper.state.mass[stepper.active]
        places = particles.positions(stepper.state)[own, :2]
        taken, net, whole = closed.close(places, mass[:, None] * stepper.inflating[own, :2])
        stepper.inflating[own, :2] -= taken / mass[:, None]
        self.unclosed, self.pushed = self.unclosed + dt * net, self.pushed + dt * whole

    def open(self, stepper) -> None:
        """Flood, before a window, what a torn shell still holds, and find its way out."""
        shell = self.carrier
        if not (shell and shell.torn):
            return
        self.torn, wet = True, particles.positions(stepper.state)[stepper.active, :2]
        points = np.concatenate([wet, shell.places()[~shell.loose(), :2], shell.links()])
        self._flood(stepper, pores.find(points, self.spacing))

    def _flood(self, stepper, grid: pores.Grid) -> None:
        if self.held:
            self.look(grid)
            self.flood()

    def _outside(self, stepper) -> np.ndarray:
        """(N,) [Pa] that is taken off pairs of particles."""
        s, reach = stepper.state, 2.0 * stepper.kernel.h
        if not self.held:
            return np.zeros(len(s.x))
        self.swell(self.area if self.torn else self._whole(s), stepper.guard)
        return self.pressure * (share_of(self.depth(s), reach) if self.torn else self._share(s, reach))

    def _whole(self, state) -> float:
        """Void [m2] of the particles as they are."""
        corners, measured = self.corners, self._measure(state)
        if self.corners != corners:  # some broke off: another polygon, the same void
            self.missed = measured - self.area
        return measured - self.missed

    def _facing(self, stepper, outside) -> None:
        s = stepper.state
        press(
            stepper.kernel, s, stepper.rows, stepper.neighbours.box, stepper.active, stepper.volume, outside,
            stepper.inflating, stepper.facing,
        )  # fmt: skip

    def boil(self, stepper, dt: float) -> None:
        """Boil for `dt` [s]: take mass off the liquid at the void's face, by how much of each particle faces it."""
        s, own = stepper.state, stepper.active
        self._facing(stepper, np.zeros(len(s.x)))
        lost = self.evaporate(dt, s.mass[own] * self.face(stepper)[own])
        if lost is not None:
            self.take(stepper, own, lost)

    def face(self, stepper) -> np.ndarray:
        """(N,) [1/m] how much of the void's face each particle has; 0 of those within, whose sum V_j grad W is but
        disorder: through that the whole liquid would boil."""
        return faced(stepper, self.near(stepper.state))

    def take_up(self, stepper, conductance, dt: float) -> tuple[np.ndarray, np.ndarray]:
        """Heat (N,) [J] of the particles, and mass (N,) [kg] that boils off them, as `soak` has them."""
        return self.soak(conductance, stepper.state.temperature, dt)

    def take(self, stepper, own, lost) -> None:
        """Take mass (P,) [kg] off the particles `own`, with what it carries."""
        s, (kinetic, elastic) = stepper.state, totals.specific_energies(stepper, own)
        self.passed += [lost.sum(), *(lost @ particles.velocities(s)[own]), float(lost @ (kinetic + elastic))]
        s.mass[own] -= lost
        if stepper.heat:
            stepper.heat.carry(own, lost)

    def _measure(self, state) -> float:
        """Area [m2] within the rim less that of the liquid; half of the rim's own stands outside the polygon."""
        wet = particles.wet(state)
        volume = state.mass / state.density
        if self.carrier:
            points, own = self.carrier.lining()
            self.rim, self.corners = points.mean(axis=0), len(points)
            return polygons.area(*points.T) - 0.5 * own - float(volume[wet].sum())
        place = np.empty(int(state.ident.max()) + 1, np.int64)
        place[state.ident] = np.arange(len(state.ident))
        rim = place[self.loop]
        x, y = state.x[rim], state.y[rim]
        self.rim = np.array([x.mean(), y.mean()])
        return polygons.area(x, y) + 0.5 * float(volume[rim].sum()) - float(volume[wet].sum())

    def _share(self, state, reach: float) -> np.ndarray:
        """(N,) share of the pressure that is taken off particles' pairs.

        In a shell it is 1 within the kernel's reach [m] of the void, and falls to 0 over another: where it is 1 nothing
        keeps particles apart, and where it is 0 a gap in the liquid closes; were it 1 all over, the shell would leave
        the liquid behind. Without a shell it is 1 of those nearer to the void than to the rim.
        """
        if not self.carrier:
            return self.near(state).astype(float)
        wet = particles.wet(state)
        return np.where(wet, share_of(behind(state, self.rim, wet), reach), 0.0)

    def near(self, state) -> np.ndarray:
        """(N,) whether particles are nearer to the void than to the rim: a round one in the rim's middle; in a torn
        shell than to the air."""
        if self.torn:
            return np.isfinite(self.depth(state)) if self.held else np.zeros(len(state.x), bool)
        r = np.hypot(state.x - self.rim[0], state.y - self.rim[1])
        reach = math.sqrt((self.area + float((state.mass / state.density)[particles.wet(state)].sum())) / math.pi)
        return r < 0.5 * (self.radius + reach)

    def row(self) -> dict[str, float]:
        """Columns of history.csv."""
        told = {"bubble_area_m2": self.area, "bubble_pressure_Pa": self.pressure}
        if self.p.vapour:
            told |= {"bubble_mass_kg": self.mass, "bubble_temperature_K": self.temperature}
            told |= {"vented_kg": self.vented}
        return told

    def summary(self) -> dict[str, float]:
        """Impulse by which the push of closed voids was off, over all of that push; the rest is in the last row."""
        off = float(np.hypot(*self.unclosed))
        return {"bubble_impulse_rel": off / self.pushed if self.pushed else 0.0}


def faced(stepper, near) -> np.ndarray:
    """(N,) [1/m] how much of a face particles have, of those that are `near` (N,) one."""
    facing = np.where(near, stepper.facing, 0.0)
    return np.where(facing * stepper.kernel.h > AT_FACE, facing, 0.0)


def share_of(depth, reach: float) -> np.ndarray:
    """(N,) share of the pressure at depths (N,) [m] behind the void's face."""
    return np.clip(2.0 - depth / reach, 0.0, 1.0)


def behind(state, middle, wet) -> np.ndarray:
    """(N,) distance [m] from the face of a void about a middle (2,) [m], along the ray of each particle; faces are
    those of the `wet`."""
    x, y = state.x - middle[0], state.y - middle[1]
    r, turn = np.hypot(x, y), np.arctan2(y, x)
    return r - face_radius(r, turn, wet)


def face_radius(r, turn, within) -> np.ndarray:
    """(N,) distance [m] of a void's face from its middle along the ray of each particle, which is at a distance r [m]
    and an angle [rad]; faces are those `within`."""
    ray = ((turn[within] + math.pi) / (2.0 * math.pi) * RAYS).astype(int) % RAYS
    nearest, middle = np.full(RAYS, np.inf), (np.arange(RAYS) + 0.5) / RAYS * 2.0 * math.pi - math.pi
    np.minimum.at(nearest, ray, r[within])
    seen = np.isfinite(nearest)
    return np.interp(turn, middle[seen], nearest[seen], period=2.0 * math.pi)


@fast_parallel
def press(kernel, s, rows, box, active, volume, outside, inflating, facing):
    """inflating (N, 3) [m/s2] = 2 p_b/rho sum V_j grad W of a pressure `outside` (N,) [Pa]; facing (N,) [1/m] the
    length of that sum."""
    for n in prange(len(active)):
        i = active[n]
        x = y = z = 0.0
        for k in range(length(rows, i)):
            j = entry(rows, i, k)
            dx, dy, dz = apart(s, box, i, j)
            share = abs(volume[j]) * smoothing.slope(kernel, math.sqrt(dx * dx + dy * dy + dz * dz))
            x += share * dx
            y += share * dy
            z += share * dz
        scale = 2.0 * outside[i] / s.density[i]
        inflating[i, 0], inflating[i, 1], inflating[i, 2] = scale * x, scale * y, scale * z
        facing[i] = math.sqrt(x * x + y * y + z * z)
