"""Heat of a liquid and of the bodies in it: pairs that conduct, power from outside, a bubble that takes what it boils
with.

    m_i c_i dT_i/dt = sum V_i V_j 2 k (T_i - T_j) r.grad W/(r^2 + eta^2) + Q_i - G_i (T_i - T_b)

k the harmonic mean, over what the sum makes of it on a square lattice, which then conducts exactly (0.96 with h = 1.3
spacings: eta and a kernel of few neighbours). G_i = 2 k V_i |sum V_j grad W|/(h/2) leads to the void's face,
half an h away (our choice; its error is that of a layer so thin). One step a window, or as many as conduction asks for;
`pace` seconds pass in each second of the motion (sdph.effects.liquids.time_scaling). Temperatures hold while particles
move.
"""

from __future__ import annotations

import math

import numpy as np
import scipy

from sdph.effects.liquids import liquid_heat
from sdph.engine import kernels as smoothing
from sdph.engine.geometry import apart
from sdph.laws import exchange
from sdph.laws.compiled import serial
from sdph.laws.constants import ROUND_OFF, SOFTENING

FACE = 0.5  # of h: how far the liquid that faces a void lies behind its face, in the mean; our choice
# of the heat m c T of all: of less that is exchanged 1e-10 (sdph.running.balances) is below 1e-15 of all heat, the
# round-off of its sums, so that there is nothing to relate a drift to (as in sdph.engine.ledger); our choice
TOLD = 1e-5


class Heat:
    """Account [J] of the heat of a stepper's particles: what came in, went to a bubble, and left with what boiled."""

    KEPT = ("came", "taken", "carried", "origin")  # see sdph.engine.kept

    def __init__(self, stepper, p):
        self.stepper, self.p, case = stepper, p, stepper.case
        self.carrier = stepper.bodies.carrier if stepper.bodies else None
        self.origin = p.temperature or float(stepper.void.temperature)
        stepper.state.temperature[:] = self.origin
        self.came = self.taken = self.carried = 0.0
        solid = self.carrier.density if self.carrier else case.liquid.density
        self.longest = liquid_heat.longest(p, stepper.kernel.h, case.liquid.density, solid)
        self.lattice = conducted(stepper.kernel, case.resolution.spacing)
        self.rim, self.power = self._outermost()
        self.built = None

    def _outermost(self) -> tuple[np.ndarray, float]:
        """Numbers (`ident`) of the outermost particles, and the power [W] from outside."""
        s = self.stepper.state
        if self.carrier and self.carrier.shell:
            shell = self.carrier.shell
            return self.stepper.bodies.first + shell.outer, self.p.flux * 2.0 * math.pi * shell.radius
        pools = [pool for pool in self.stepper.case.pools.values() if pool.shape in ("ring", "disc")]
        if not pools:
            return np.zeros(0, np.int64), 0.0
        far = np.hypot(s.x - pools[0].centre[0], s.y - pools[0].centre[1])
        far[s.density == 0.0] = 0.0
        return s.ident[far > pools[0].radius - 1.01 * self.stepper.case.resolution.spacing], (
            self.p.flux * 2.0 * math.pi * pools[0].radius
        )

    def advance(self, time: float) -> None:
        """Go on by `time` [s]."""
        if not time > 0.0:
            return
        self._find()
        count = max(1, math.ceil(time / self.longest - ROUND_OFF))
        for _ in range(count):
            self._step(time / count)

    def _find(self) -> None:
        """Values of the particles as they stand now, and pairs anew where rows were."""
        own = self.stepper
        self._weigh()
        self.filled = self.capacity > 0.0
        self.volume = np.abs(own.volume)
        if self.built is not own.neighbours.built:
            self.built = own.neighbours.built
            self.pairs = _pairs(self.built, self.filled, own.neighbours.reach * (1.0 + own.neighbours.skin))

    def _weigh(self) -> None:
        """Heat capacities (N,) [J/K] and conductivities (N,) [W/m/K] of the particles."""
        own, s = self.stepper, self.stepper.state
        self.capacity, self.conductivity = np.zeros(len(s.x)), np.zeros(len(s.x))
        self.capacity[own.active] = s.mass[own.active] * self.p.heat_capacity
        self.conductivity[own.active] = self.p.conductivity
        if self.carrier:
            at = own.bodies.at
            self.capacity[at] = self.carrier.mass * self.p.body_heat_capacity
            self.conductivity[at] = self.p.body_conductivity
        self.conductivity /= self.lattice

    def _powers(self) -> np.ndarray:
        """(N,) [W] from outside."""
        share = np.where(self.filled, self.capacity, 0.0)
        if not self.p.inside:
            share[~np.isin(self.stepper.state.ident, self.rim)] = 0.0
        return self.power * share / share.sum() if self.power else np.zeros(len(share))

    def _step(self, dt: float) -> None:
        own, s = self.stepper, self.stepper.state
        powers = self._powers()
        gained = powers.copy()
        conduct(own.kernel, s, own.neighbours.box, self.pairs, self.volume, self.conductivity, s.temperature, gained)
        heat, lost = self._boil(dt) if own.void and own.void.p.vapour else (0.0, ())
        change = dt * gained - heat
        s.temperature[self.filled] += change[self.filled] / self.capacity[self.filled]
        self.came += dt * float(powers.sum())
        if len(lost):
            self.taken += float(heat.sum())
            before = s.mass[own.active].copy()
            own.void.take(own, own.active, lost[own.active])
            own.acceleration[own.active] *= (before / s.mass[own.active])[:, None]  # by the forces of now
            self.capacity[own.active] = s.mass[own.active] * self.p.heat_capacity

    def _boil(self, dt: float) -> tuple[np.ndarray, np.ndarray]:
        """Heat (N,) [J] that each particle gives to the bubble, and mass (N,) [kg] that boils off it."""
        own = self.stepper
        return own.void.take_up(own, 2.0 * self.p.conductivity / (FACE * own.kernel.h) * self.volume, dt)

    def carry(self, own, lost) -> None:
        """Mass (P,) [kg] leaves particles `own` with their heat."""
        warmth = self.stepper.state.temperature[own] - self.origin
        self.carried += self.p.heat_capacity * float(lost @ warmth)

    def give_back(self, own, heat) -> None:
        """Heat (P,) [J] of a bubble that is gone comes to particles `own`."""
        s = self.stepper.state
        s.temperature[own] += heat / (s.mass[own] * self.p.heat_capacity)
        self.taken -= float(heat.sum())

    def sensible(self) -> float:
        """Heat [J] of the particles above the start."""
        self._find()
        return float(self.capacity @ (self.stepper.state.temperature - self.origin))

    def summary(self) -> dict[str, float]:
        """Heat [J] in, to the bubble, with what boiled; what is missing, and that over what came in and went to the
        bubble, or over TOLD of all heat where that is more."""
        missing = abs(self.came - self.sensible() - self.taken - self.carried)
        moved, least = abs(self.came) + abs(self.taken), TOLD * float(self.capacity @ self.stepper.state.temperature)
        return {
            "heat_in_J": self.came, "heat_to_bubble_J": self.taken, "heat_boiled_off_J": self.carried,
            "heat_drift_J": missing, "heat_drift_rel": missing / (moved if moved > least else least),
        }  # fmt: skip

    def row(self) -> dict[str, float]:
        """Columns of history.csv: heat that came in, temperature of the outermost particles."""
        s = self.stepper.state
        rim = np.isin(s.ident, self.rim)
        told = {"heat_in_J": self.came, "heat_to_bubble_J": self.taken}
        return told | ({"rim_temperature_K": float(s.temperature[rim].mean())} if rim.any() else {})


def conducted(kernel, spacing: float) -> float:
    """Conductivity of a square lattice of a spacing [m] over that of its particles, as the sum has it."""
    reach = math.ceil(2.0 * kernel.h / spacing)
    across = spacing * np.arange(-reach, reach + 1)
    x, y = (axis.ravel() for axis in np.meshgrid(across, across))
    r2 = x * x + y * y
    slope = np.array([smoothing.slope(kernel, r) for r in np.sqrt(r2)])
    return -float((slope * x * x * r2 / (r2 + SOFTENING * kernel.h**2)).sum()) * spacing**2


def _pairs(built, filled, reach: float) -> np.ndarray:
    """Pairs (M, 2) of what is `filled` nearer than `reach` [m], in one order."""
    which = np.flatnonzero(filled)
    tree = scipy.spatial.cKDTree(np.stack(built, axis=1)[which])
    pairs = which[tree.query_pairs(reach, output_type="ndarray")]
    return pairs[np.lexsort(pairs.T)]


@serial
def conduct(kernel, s, box, pairs, volume, conductivity, temperature, gained):
    """Add to gained (N,) [W] what pairs (M, 2) conduct: equal and opposite."""
    soft = SOFTENING * kernel.h * kernel.h
    for n in range(len(pairs)):
        i, j = pairs[n]
        dx, dy, dz = apart(s, box, i, j)
        r2 = dx * dx + dy * dy + dz * dz
        slope = smoothing.slope(kernel, math.sqrt(r2)) * r2 / (r2 + soft)
        k = 2.0 * exchange.harmonic_mean(conductivity[i], conductivity[j])
        flow = volume[i] * volume[j] * k * (temperature[i] - temperature[j]) * slope
        gained[i] += flow
        gained[j] -= flow
