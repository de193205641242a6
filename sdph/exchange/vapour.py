"""Evaporation in the exchange of a window: the vapour around the particles, what they lose, what the gas gets of it."""

from __future__ import annotations

import copy
from dataclasses import replace

import numpy as np

from coupling.transfer import gather
from sdph.effects.gas import film
from sdph.effects.limiter import share
from sdph.engine import state as particles
from sdph.engine.state import GRAIN
from sdph.exchange import bursts
from sdph.exchange import droplets as droplet_loss
from sdph.exchange.amounts import Handed, Loss, Taken
from sdph.exchange.equations import Seen, vapour_concentration

REFUSED = 0.01  # of what evaporated, from which on what was refused to condense is told; our choice
LITTLE = 1e-6  # of the droplets: less condensation than that is not told of; our choice


def refusals(ledger) -> list[str]:
    """A line on a run in which more vapour than REFUSED of what evaporated would have condensed on droplets."""
    evaporated, refused = ledger.sums["evaporated_kg"], ledger.sums.get("condensation_refused_kg", 0.0)
    there = ledger.first["particle_mass_kg"] + ledger.sums["injected_kg"]
    if refused <= REFUSED * evaporated or refused <= LITTLE * there:
        return []
    share = f"{refused / evaporated:.0%} of what evaporated" if evaporated else "while nothing evaporated"
    return [
        f"condensation_refused_kg = {refused:.3g}, {share}: so much vapour would have condensed on droplets, and the "
        "effect evaporation has no condensation: it stays in the gas, which keeps its latent heat, and no key changes "
        "that; droplets in gas that is this humid grow and warm faster than here"
    ]


class Vapour:
    """Evaporation of a case with parameters `p`, the EvaporationP of sdph.effects.gas.evaporation."""

    name = "evaporation"

    def __init__(self, case, p, sizes_p, cells):
        self.case, self.p, self.sizes_p, self.cells = case, p, sizes_p, cells

    def lose(self, state, weights, gas_state, seen, beside, convection, conductance, dt, thrown) -> Loss:
        """Evaporation in a window in which `beside` (N,) [W] comes beside what the gas gives; the heat conductance (N,)
        [W/K], of which convection (N,) is the part that flowing vapour hinders, becomes the mean over it. The state is
        that after torn droplets have `thrown` their vapour, where there are any.

        Vapour and temperature in each cell are taken as they would be at the window's end if no flow carried them: fast
        exchange saturates a cell, or cools it to the droplets, and does not overshoot.
        """
        p, count = self.p, len(state.x)
        flow, surface = np.empty(count), np.empty(count)
        if not self.case.coupling.one_way:
            seen = self._cooled(state, weights, gas_state, seen, conductance * dt)
        around = seen.slip, self.density(state, seen), seen.temperature
        droplet_loss.survey(p, self.sizes_p, state, *around, beside, dt, conductance, flow, surface)
        concentration = gather(weights, vapour_concentration(p, gas_state))
        if not self.case.coupling.one_way:
            evaporating = surface > concentration
            after = [
                self._relaxed(state, weights, gas_state, flow * some * dt, surface)
                for some in (evaporating, ~evaporating)
            ]
            concentration = np.where(evaporating, *after)
        held = self.held(state, seen, concentration)
        loss = Loss(*(np.empty(count) for _ in range(5)), np.zeros(count), held, thrown)
        droplet_loss.losses(
            p,
            self.sizes_p,
            state,
            *around,
            concentration,
            beside,
            dt,
            convection,
            conductance,
            loss.mass,
            loss.still,
            loss.moving,
            loss.refused,
            loss.rest,
        )
        velocity = particles.velocities(state)
        theta = state.theta if len(state.theta) else 0.0
        return replace(loss, motion=loss.vapour * (0.5 * np.einsum("ij,ij->i", velocity, velocity) + 1.5 * theta))

    def density(self, state, seen) -> np.ndarray:
        """Density (N,) [kg/m3] with which the gas's viscosity gives the film's kinematic one
        (sdph.effects.gas.film)."""
        if not self.case.coupling.film:
            return seen.density
        return seen.density * (seen.temperature / film.temperature(seen.temperature, state.temperature)) ** 2

    def held(self, state, seen, concentration) -> dict[str, float]:
        """Shares of the particles whose rate is taken not to fall with temperature, and that are held below boiling."""
        flat, boiling = (np.empty(len(state.x), bool) for _ in range(2))
        droplet_loss.held(self.p, state, seen.density, seen.temperature, concentration, flat, boiling)
        return {"flat_rate_share": share(state, flat), "boiling_held_share": share(state, boiling)}

    def begin(self, state, weights, gas_state) -> dict[str, float]:
        """The same before the first window."""
        return self.held(
            state, Seen(weights, gas_state, state), gather(weights, vapour_concentration(self.p, gas_state))
        )

    def power(self, loss: Loss, dt) -> np.ndarray:
        """Heat (N,) [W] that evaporation gives the particles, held over the window: below 0."""
        return self.p.latent_heat / -dt * loss.mass

    def _relaxed(self, state, weights, gas_state, exchanged, surface) -> np.ndarray:
        """Vapour around the particles [kmol/m3] once they have exchanged so much gas (N,) [m3] with the cells."""
        deposited = self.cells.sums(weights, np.stack((exchanged, exchanged * surface), axis=1))
        room = self.cells.gas(weights, state.mass * (state.kind == GRAIN)) * self.cells.volumes
        cells = vapour_concentration(self.p, gas_state)
        return gather(weights, (room * cells + deposited[:, 1]) / (room + deposited[:, 0]))

    def _cooled(self, state, weights, gas_state, seen, exchanged) -> Seen:
        """The gas as the particles see it once they have exchanged so much heat (N,) [J/K] with the cells."""
        deposited = self.cells.sums(weights, np.stack((exchanged, exchanged * state.temperature), axis=1))
        gas = gas_state.fields["density"] * self.cells.gas(weights, state.mass * (state.kind == GRAIN))
        capacity = gas * self.cells.volumes * self.case.gas.heat_capacity
        cells = (capacity * gas_state.fields["temperature"] + deposited[:, 1]) / (capacity + deposited[:, 0])
        found = copy.copy(seen)
        found.temperature = gather(weights, cells)
        return found

    def pace(self, state, weights, gas_state, seen) -> float:
        """Vapour that comes into a cell now, over the gas in it [1/s]; the largest of all cells."""
        p, rate = self.p, np.empty(len(state.x))
        concentration = gather(weights, vapour_concentration(p, gas_state))
        around = seen.slip, self.density(state, seen), seen.temperature
        droplet_loss.rates(p, self.sizes_p, state, *around, concentration, rate)
        room = self.cells.gas(weights, state.mass * (state.kind == GRAIN))
        return float((self.cells.density(weights, rate) / (room * gas_state.fields["density"])).max(initial=0.0))

    def share(self, handed: Handed, gas_state) -> float:
        """Vapour that a window brought into a cell, over the gas in it; the largest of all cells."""
        room = self.cells.gas(handed.weights, handed.mass)
        return float(
            (handed.terms["vapour", "evaporation"] * handed.dt / (room * gas_state.fields["density"])).max(initial=0.0)
        )

    def taken(self, taken: Taken, handed: Handed) -> Taken:
        """The same with what evaporation takes."""
        own, latent = handed.loss, self.p.latent_heat
        vapour, warmth = float(own.vapour.sum()), float(own.warmth(handed.temperature).sum())
        excess = self.case.grains.heat_capacity - self.case.vapour.heat_capacity
        share = 0.0 if self.case.coupling.one_way else handed.dt  # s in which the gas feels anything of it
        given, brought = (
            share * np.tensordot(self.cells.volumes, handed.terms[name, "evaporation"], 1)
            for name in ("vapour", "momentum")
        )
        return replace(
            taken, warming=taken.heat - latent * own.mass, vapour=vapour, vapour_to_gas=float(given),
            latent_heat=latent * vapour, capacity_heat=excess * warmth, refused=float(own.refused.sum()),
            vapour_motion=float(own.motion.sum()), vapour_impulse=brought,
        )  # fmt: skip

    def settle(self, state, handed: Handed) -> None:
        """Take from the particles what they threw and what evaporated."""
        own = handed.loss
        if own.thrown:
            bursts.take(state, own.thrown)
        droplet_loss.apply(self.p, self.sizes_p, state, own.mass, own.still, own.moving)
