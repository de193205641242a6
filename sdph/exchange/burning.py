"""Burn-off in the exchange of a window: the oxidant around the grains, what they lose, what the gas gets of it.

Grains strip k A [m3/s] of gas of its oxidant. If no flow carried any, a cell would keep exp(-x) of its oxidant, x being
what grains strip of its gas in the window: from that mean of the window every grain takes its part, cell by cell with
the weights of the transfer, and shrinks by it in closed form (sdph.laws.burn_off). It takes less than it stripped at
first, as it shrinks, so that no cell gives more than it holds. Both sides are made from the same sums: mass, species,
momentum and heat stay. k_s is that of the grain's temperature at the window's start: first order in the window.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numba import prange

from coupling.transfer import gather
from sdph.effects.gas import reaction
from sdph.effects.gas.evaporation import ventilation
from sdph.engine import state as particles
from sdph.engine.state import GRAIN
from sdph.exchange.amounts import Handed, Loss, Taken
from sdph.exchange.droplets import FINISHED
from sdph.exchange.equations import Seen
from sdph.laws import burn_off
from sdph.laws import evaporation as law
from sdph.laws.compiled import parallel, serial


class Burning:
    """Burn-off of a case with parameters `p`, the ReactionP of sdph.effects.gas.reaction."""

    name = "reaction"

    def __init__(self, case, p, sizes_p, cells):
        self.case, self.p, self.sizes_p, self.cells = case, p, sizes_p, cells
        self.richest = reaction.richest(case)

    def lose(self, state, weights, gas_state, seen, beside, convection, conductance, dt, thrown) -> Loss:
        """Burn-off in a window; the heat conductance (N,) [W/K] becomes the mean over it, as of grains that shrink."""
        count = len(state.x)
        slow, stripped = np.empty(count), np.empty(count)
        survey(self.p, self.sizes_p, state, seen.slip, seen.density, slow, stripped)
        there = self.oxidant(state, weights, gas_state, stripped, dt)
        loss = Loss(*(np.empty(count) for _ in range(3)), np.zeros(count), np.empty(count), np.zeros(count))
        burn(
            self.p, self.sizes_p, state, seen.slip, seen.density, gather(weights, there), dt, slow, stripped,
            conductance, loss.mass, loss.still, loss.moving, loss.rest,
        )  # fmt: skip
        velocity = particles.velocities(state)
        theta = state.theta if len(state.theta) else 0.0
        motion = loss.mass * (0.5 * np.einsum("ij,ij->i", velocity, velocity) + 1.5 * theta)
        terms = self._terms(weights, there, stripped, state.temperature, velocity)
        return replace(loss, motion=motion, slow=slow * loss.still, terms=terms)

    def oxidant(self, state, weights, gas_state, stripped, dt) -> np.ndarray:
        """Oxidant (C,) [kg/m3] that the cells have, the mean of the window; of gas that feels nothing that of now."""
        there = gas_state.fields["density"] * gas_state.fields["vapour_mass_fraction"]
        if self.case.coupling.one_way:
            return there
        return there * _mean_content(self._taken(state, weights, stripped) * dt)

    def _taken(self, state, weights, stripped) -> np.ndarray:
        """Gas that grains strip (N,) [m3/s], over that of the cells (C,) [1/s]."""
        return self.cells.density(weights, stripped) / self.cells.gas(weights, state.mass * (state.kind == GRAIN))

    def _terms(self, weights, there, stripped, temperature, velocity) -> dict:
        """Sources by volume of the cells: the oxidant that leaves, the products that come with the temperature of the
        grains, the motion of what was solid, and the gas's share of the heat."""
        p = self.p
        given = np.column_stack((stripped, stripped * temperature, stripped[:, None] * velocity))
        taken = there[:, None] * self.cells.density(weights, given)
        oxidant, solid = taken[:, 0], taken[:, 0] / p.ratio
        heat = p.carried / p.ratio * taken[:, 1] + p.heat_to_gas * solid
        told = {"vapour": -oxidant, "carrier": oxidant + solid, "momentum": taken[:, 2:] / p.ratio, "heat": heat}
        return {(quantity, self.name): values for quantity, values in told.items()}

    def power(self, loss: Loss, dt) -> np.ndarray:
        """Heat (N,) [W] that the reaction gives the grains, held over the window."""
        return self.p.heat_to_grains / dt * loss.mass

    def begin(self, state, weights, gas_state) -> dict[str, float]:
        """Nothing holds it; the state gets the rate at which its heat warms grains now."""
        stripped = self._stripped(state, Seen(weights, gas_state, state))
        there = gas_state.fields["density"] * gas_state.fields["vapour_mass_fraction"]
        heat = self.p.heat_to_grains / self.p.ratio * stripped * gather(weights, there)
        state.warming[:] = heat / (state.mass * self.p.grain_heat_capacity)
        return {}

    def _stripped(self, state, seen) -> np.ndarray:
        """Gas (N,) [m3/s] that grains strip of its oxidant now."""
        slow, stripped = np.empty(len(state.x)), np.empty(len(state.x))
        survey(self.p, self.sizes_p, state, seen.slip, seen.density, slow, stripped)
        return stripped

    def pace(self, state, weights, gas_state, seen) -> float:
        """Take, at the start, `share` of a second."""
        stripped = self._stripped(state, seen)
        there = gas_state.fields["vapour_mass_fraction"] / self.richest if self.richest else 0.0
        return float((there * self._taken(state, weights, stripped)).max(initial=0.0))

    def share(self, handed: Handed, gas_state) -> float:
        """Oxidant that a window took from a cell, over what the richest gas of the case holds there; the largest."""
        if not self.richest or self.case.coupling.one_way:
            return 0.0
        whole = self.cells.gas(handed.weights, handed.mass) * gas_state.fields["density"] * self.richest
        return float((-handed.terms["vapour", self.name] * handed.dt / whole).max(initial=0.0))

    def taken(self, taken: Taken, handed: Handed) -> Taken:
        """The same with what the reaction takes and gives."""
        own, p = handed.loss, self.p
        share = 0.0 if self.case.coupling.one_way else handed.dt  # s in which the gas feels anything of it
        vapour, carrier, brought = (
            share * np.tensordot(self.cells.volumes, handed.terms[name, self.name], 1)
            for name in ("vapour", "carrier", "momentum")
        )
        solid = float(own.mass.sum())
        excess = (p.grain_heat_capacity - p.carried) * float((own.mass * handed.temperature).sum())
        return replace(
            taken, warming=taken.heat + p.heat_to_grains * own.mass, reacted=solid, vapour_to_gas=float(vapour),
            carrier_to_gas=float(carrier), reaction_heat=(p.heat_to_grains + p.heat_to_gas) * solid,
            capacity_heat=excess, vapour_motion=float(own.motion.sum()), vapour_impulse=brought,
        )  # fmt: skip

    def settle(self, state, handed: Handed) -> None:
        """Take from the grains what burned."""
        own = handed.loss
        diameter, variance = np.empty(len(state.x)), np.empty(len(state.x))
        shrink(self.p, self.sizes_p, state, own.still, own.moving, own.slow, diameter, variance)
        state.mass[:] -= own.mass
        state.lost_still[:] += own.still
        state.lost_moving[:] += own.moving
        state.lost_kinetic[:] += own.slow
        state.diameter[:], state.diameter_variance[:] = diameter, variance


@parallel
def survey(p, sizes_p, s, slip, gas_density, slow, stripped):
    """Look, before the loss, at the length l (N,) [m] by which surfaces are slow, and the gas (N,) [m3/s] that grains
    strip of its oxidant now; slip (N,) [m/s], gas_density (N,) [kg/m3]."""
    for i in prange(len(s.x)):
        slow[i] = stripped[i] = 0.0
        if s.kind[i] == GRAIN:
            slow[i] = reaction.surface(p, s.temperature[i])
            stripped[i] = reaction.stripped(p, sizes_p, s, i, slow[i], ventilation(p, slip[i], gas_density[i]))


@parallel
def burn(
    p, sizes_p, s, slip, gas_density, oxidant, dt, slow, stripped, conductance, loss, still, moving, rest,
):  # fmt: skip
    """Loss of each particle (N,) in dt [s] with `oxidant` (N,) [kg/m3] around it: mass [kg]; its integrals of a dt [m2]
    and a c dt [m^(3/2)]; rest [kg] of one that has finished, which burns at once.

    `stripped` becomes the mean over the window, `conductance` [W/K] shrinks as it does.
    """
    for i in prange(len(s.x)):
        loss[i] = still[i] = moving[i] = rest[i] = 0.0
        if stripped[i] == 0.0 or oxidant[i] <= 0.0:
            stripped[i] = 0.0
            continue
        still[i] = law.regression_rate(oxidant[i] / p.ratio, p.diffusivity, p.grain_density) * dt
        moving[i] = ventilation(p, slip[i], gas_density[i]) * still[i]
        loss[i], rest[i] = taken_from(p, sizes_p, s, i, still[i], moving[i], slow[i] * still[i])
        mean = loss[i] * p.ratio / (oxidant[i] * dt)
        conductance[i] *= min(1.0, mean / stripped[i])
        stripped[i] = mean


@serial
def taken_from(p, sizes_p, s, i, still, moving, slow):
    """Mass that particle i loses, and the rest [kg] among it that burns at once; its integrals as in
    `reaction.remaining`."""
    left = s.mass[i] * reaction.remaining(p, sizes_p, s, i, still, moving, slow)[0]
    rest = 0.0 if left > FINISHED * s.born_mass[i] else left
    return s.mass[i] - (left - rest), rest


@parallel
def shrink(p, sizes_p, s, still, moving, slow, diameter, variance):
    """Mean [m] and variance [m2] of the diameters (N,) that are left."""
    for i in prange(len(s.x)):
        diameter[i], variance[i] = s.diameter[i], s.diameter_variance[i]
        if still[i] > 0.0:
            left = reaction.remaining(p, sizes_p, s, i, still[i], moving[i], slow[i])
            diameter[i], variance[i] = left[1], left[2]


def _mean_content(taken) -> np.ndarray:
    """Mean of what the cells hold over the window, over what they held; taken (C,)."""
    found = np.empty(len(taken))
    _mean_contents(taken, found)
    return found


@parallel
def _mean_contents(taken, found):
    for c in prange(len(taken)):
        found[c] = burn_off.mean_content(taken[c])
