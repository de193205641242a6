"""The bubble of a liquid: its void, what is in it, and its pressure on the liquid.

Void: area within the outermost ring of the liquid, and half of that ring, less the area of the liquid, m/rho of all; in
a shell (`Carrier.shell`) within the shell's innermost ring, less half of that. What the polygon of the ring misses at
the start is taken off for good, so that the first void is that of the case.
Pressure: -2 p_b is added to p_i + p_j of all pairs of the liquid nearer to the void than to the rim; in a shell a share
of it, which falls to 0 within two reaches of the kernel. The sum of V_j grad W vanishes inside, which leaves p_b on the
void's face alone. What is given back is not equal and opposite pair by pair: `impulse_of_bubble_*` says what the sum
over a closed void misses.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit, prange

from sdph.effects.liquids import bubble
from sdph.engine import kernels as smoothing
from sdph.engine import polygons
from sdph.engine import state as particles
from sdph.engine.geometry import FAST, apart
from sdph.engine.rows import entry, length
from sdph.laws import cavities, real_gas
from sdph.methods.liquids import totals

SAME = 1e-6  # of a radius: round-off
COLDEST, HOTTEST = (
    0.5,
    0.999,
)  # of the critical temperature: beyond, a vapour's bubble is no longer followed; our choice
# of 1/h: |sum V_j grad W| from which on a particle is at a face; 0.6 half a spacing behind a plane one, 0.2 another
# spacing on, disorder below 0.1; our choice
AT_FACE = 0.25
RAYS = 32  # directions in which the void's face is looked for; our choice
LOWER = "bubble.flux_W_m2 or run.step_factor"


class Void:
    """A bubble: void [m2], pressure over that around [Pa], mass [kg/m] and temperature [K] of vapour, heat that it got
    and with which it warmed [J/m]; passed (5,): mass, momentum and energy that the liquid gave to it, and mass that it
    still owes, of this step's warming; vented: mass that went out through a tear. In a shell, where there is one."""

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
    )

    def __init__(self, case, p, state, bodies=None):
        self.p, pool = p, bubble.pool_of(case)
        self.carrier = bodies.carrier if bodies and bodies.carrier.shell else None
        x, y = state.x - pool.centre[0], state.y - pool.centre[1]
        r = np.where(particles.wet(state), np.hypot(x, y), 0.0)
        ring = np.flatnonzero((r > r.max() * (1.0 - SAME)) & (r > 0.0))
        self.loop = state.ident[ring][np.argsort(np.arctan2(y[ring], x[ring]))]  # counterclockwise
        self.first = cavities.void(pool.inner_radius, 2)
        self.area, self.missed, self.corners = self.first, 0.0, 0  # corners of the lining, where there is one
        self.missed = self._measure(state) - self.first
        self.pressure, self.mass, self.temperature = p.excess, 0.0, 0.0
        self.heat = self.warmed = 0.0
        self.owed, self.passed, self.vented = 0.0, np.zeros(5), 0.0
        if p.vapour:
            self.coldest, self.hottest = (share * p.vapour.critical_temperature for share in (COLDEST, HOTTEST))
            self.thinnest, self.densest = (
                float(real_gas.saturated_density(p.vapour, end)) for end in (self.coldest, self.hottest)
            )
            self.temperature = float(real_gas.saturation_temperature(p.vapour, p.around + self._capillary()))
            self.mass = float(real_gas.saturated_density(p.vapour, self.temperature) * self.area)

    @property
    def radius(self) -> float:
        """R [m] of a round void of that area."""
        return math.sqrt(self.area / math.pi)

    def press(self, stepper) -> None:
        """Add to the accelerations of a stepper; what was added is its `inflating` (N, 3) [m/s2]."""
        s = stepper.state
        corners, measured = self.corners, self._measure(s)
        if self.corners != corners:  # some broke off: another polygon, the same void
            self.missed = measured - self.area
        self.area = measured - self.missed
        if not self.area > 0.0:
            stepper.guard.stop("void", "the bubble", np.zeros(3), self.area, (0.0, math.inf, "m2"), LOWER)
        self.pressure = self._content(stepper.guard) - self.p.around - self._capillary()
        outside = self.pressure * self._share(s, 2.0 * stepper.kernel.h)
        self._facing(stepper, outside)
        stepper.acceleration += stepper.inflating

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
        heat = dt * self.p.flux * 2.0 * math.pi * self.radius
        boiled = heat / self.p.vapour.latent_heat
        self.heat, self.mass, self.owed = self.heat + heat, self.mass + boiled, self.owed + boiled
        share = s.mass[own] * self.face(stepper)[own]
        if share.any():  # else it goes on owing: nothing faces it
            mass, self.owed = self.owed, 0.0
            self.take(stepper, own, share * (mass / share.sum()))

    def face(self, stepper) -> np.ndarray:
        """(N,) [1/m] how much of the void's face each particle has; 0 of those within, whose sum V_j grad W is but
        disorder: through that the whole liquid would boil."""
        facing = np.where(self.near(stepper.state), stepper.facing, 0.0)
        return np.where(facing * stepper.kernel.h > AT_FACE, facing, 0.0)

    def take(self, stepper, own, lost) -> None:
        """Take mass (P,) [kg] off the particles `own`, with what it carries."""
        s, (kinetic, elastic) = stepper.state, totals.specific_energies(stepper, own)
        self.passed += [lost.sum(), *(lost @ particles.velocities(s)[own]), float(lost @ (kinetic + elastic))]
        s.mass[own] -= lost
        if stepper.heat:
            stepper.heat.carry(own, lost)

    def soak(self, conductance, temperature, dt: float) -> tuple[np.ndarray, np.ndarray]:
        """Heat (N,) [J] from particles of a temperature [K] by a conductance (N,) [W/K] in dt [s], at the temperature
        that the bubble has in the end, of which no sub-step is too long; mass (N,) [kg] that boils off each."""
        v, first, near = self.p.vapour, self.temperature, conductance > 0.0
        if not near.any():
            return np.zeros_like(conductance), np.zeros_like(conductance)
        span = np.append(temperature[near], first)
        low, high = float(span.min()), float(span.max())
        while high - low > cavities.NEAR * high:
            middle = 0.5 * (low + high)
            mass = float(real_gas.saturated_density(v, middle)) * self.area
            wanted = float(cavities.heat_taken(v, mass - self.mass, mass, middle - first))
            given = dt * float(conductance @ (temperature - middle))
            low, high = (middle, high) if given > wanted else (low, middle)
        heat = np.where(near, dt * conductance * (temperature - 0.5 * (low + high)), 0.0)
        whole = float(heat.sum())
        gained = (whole - self.mass * v.heat_capacity * (high - first)) / (
            v.latent_heat + v.heat_capacity * (high - first)
        )
        warmed = whole - v.latent_heat * gained
        self.mass, self.temperature = self.mass + gained, high
        self.heat, self.warmed = self.heat + whole, self.warmed + warmed
        return heat, heat / v.latent_heat - conductance * (warmed / v.latent_heat / conductance.sum())

    def vent(self, dt: float, width: float) -> None:
        """Let vapour out for dt [s] through a way that is `width` [m] wide."""
        v = self.p.vapour
        inside = self.pressure + self.p.around
        flux = cavities.vent_flux(inside, self.temperature, self.p.around, v.molar_mass, v.heat_ratio)
        lost = float(flux) * width * dt
        self.mass, self.vented = self.mass - lost, self.vented + lost

    def _capillary(self) -> float:
        return float(cavities.capillary_pressure(self.p.tension, self.radius, 2))

    def _content(self, guard) -> float:
        """Pressure [Pa] of what is in it, absolute."""
        p, v = self.p, self.p.vapour
        if not v:
            held = p.around + p.tension / math.sqrt(self.first / math.pi)
            return (held + p.excess) * (self.first / self.area) ** p.exponent
        before = self.temperature
        density = self.mass / self.area
        if not self.thinnest < density < self.densest:
            allowed = (self.thinnest, self.densest, "kg/m3")
            guard.stop("density of the vapour", "the bubble", np.append(self.rim, 0.0), density, allowed, LOWER)
        self.temperature = float(cavities.temperature_of(v, density, self.coldest, self.hottest))
        warmed = self.mass * v.heat_capacity * (self.temperature - before)
        self.mass, self.owed = self.mass - warmed / v.latent_heat, self.owed - warmed / v.latent_heat
        self.warmed += warmed
        return float(real_gas.saturation_pressure(v, self.temperature))

    def _measure(self, state) -> float:
        """Area [m2] within the rim less that of the liquid; half of the rim's own stands outside the polygon."""
        wet = particles.wet(state)
        volume = state.mass / state.density
        if self.carrier:
            points, own = self.carrier.lining()
            self.rim, self.corners = points.mean(axis=0), len(points)
            self.within = self.carrier.inside(points, state, wet)
            return polygons.area(*points.T) - 0.5 * own - float(volume[self.within].sum())
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
        if not self.within.any():  # it has all left a shell that tore
            return np.zeros(len(state.x))
        r, turn = self._polar(state.x, state.y)
        share = 2.0 - (r - self._face_radius(r, turn)) / reach
        return np.where(self.within, np.clip(share, 0.0, 1.0), 0.0)

    def _polar(self, x, y) -> tuple[np.ndarray, np.ndarray]:
        """Distance (N,) [m] and angle [rad] from the middle of the rim."""
        x, y = x - self.rim[0], y - self.rim[1]
        return np.hypot(x, y), np.arctan2(y, x)

    def _face_radius(self, r, turn) -> np.ndarray:
        """(N,) distance [m] of the void's face from the middle of the rim, along the ray of each particle."""
        ray = ((turn[self.within] + math.pi) / (2.0 * math.pi) * RAYS).astype(int) % RAYS
        nearest, middle = np.full(RAYS, np.inf), (np.arange(RAYS) + 0.5) / RAYS * 2.0 * math.pi - math.pi
        np.minimum.at(nearest, ray, r[self.within])
        seen = np.isfinite(nearest)
        return np.interp(turn, middle[seen], nearest[seen], period=2.0 * math.pi)

    def near(self, state) -> np.ndarray:
        """(N,) whether particles are nearer to the void than to the rim: a round one in the rim's middle."""
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


@njit(cache=True, parallel=True, error_model="numpy", fastmath=FAST)
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
