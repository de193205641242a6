"""Exchange between particles and gas over one window: unconditionally stable, and equal on both sides.

For particle k with heat capacity C_k = m_k c, the share f_k = 1 - exp(-dt K_k/C_k) of it meets the gas, cell by
cell with the transfer weights w_kc (sdph-notes, section 3). The gas is handed, as implicit coefficient and source,

    eps_c V_c = sum_k w_kc C_k f_k/dt,      eps T_p V_c = sum_k w_kc C_k f_k/dt T_k

and from the temperature T'_c that it answers with, particle k takes exactly what the cells gave:

    Q_k = C_k f_k sum_c w_kc (T'_c - T_k)   [J].

Momentum goes the same way with m_k for C_k and the drag coefficient for K_k. The heat of drag, force times slip with
the new gas velocity, is known when the window is done: the gas gets it in the next one.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from coupling.transfer import deposit, gather
from sdph import effects
from sdph.effects import OFF
from sdph.effects.gas import sizes
from sdph.engine.state import GRAIN
from sdph.exchange import droplets as droplet_loss
from sdph.exchange.amounts import Handed, Loss, Taken
from sdph.exchange.equations import Seen, coefficients, temperature_span, vapour_concentration

INSTANT = 1e-12  # s, so short that f_k/dt is K_k/C_k


class Exchange:
    """The effects of a case that reach across to the gas."""

    KEPT = ("drag_heat",)

    def __init__(self, case, mesh, parameters):
        self.case = case
        self.parameters = parameters
        self.sizes_p = sizes.kernel(case)
        self.volumes = mesh.volumes / mesh.depth
        rows = [effects.REGISTRY[name] for name in case.effects]
        names = dict.fromkeys(name for row in rows for name in row.sources)
        self.sources = tuple(name for name in names if name != "alpha_g" or case.coupling.voidage)
        self.drag_heat = np.zeros(len(self.volumes))  # [W/m3], for the next window

    def alpha_g(self, state, weights, inside=1.0) -> np.ndarray:
        """Gas volume fraction of the cells; `inside` (N,) is the share of each particle that is in the gas."""
        return self._room(weights, state.mass * inside)

    def hand(self, state, weights, ahead, gas_state, dt) -> Handed:
        """Coefficients from the old gas state, and the sources for the gas.

        `ahead` are the weights of where the particles will be at the end of the window, and the share of each (N,) that
        will be in the gas: the volume fraction then is told to the gas.
        """
        seen = Seen(weights, gas_state, state)
        conductance, loss = np.empty(len(state.x)), None
        if self.parameters["evaporation"]:
            conductance, loss = self._evaporate(state, weights, gas_state, seen, dt)
        kept = state.mass - loss.mass if loss else state.mass
        heat_share, pull, shared_mass, damping = (np.zeros(len(state.x)) for _ in range(4))
        latent = self.parameters["evaporation"].latent_heat / dt * loss.mass if loss else OFF
        coefficients(
            self.parameters["drag"], self.parameters["heat"], self.sizes_p, state, self._grains(), dt, seen.slip,
            seen.density, kept, conductance, latent, heat_share, pull, shared_mass, damping,
        )  # fmt: skip
        there, inside = ahead
        sources = {"alpha_g": self._room(there, kept * inside)} if "alpha_g" in self.sources else {}
        sources |= self._sources(state, weights, seen, dt, loss, heat_share, pull, shared_mass)
        sources = {name: np.ascontiguousarray(values) for name, values in sources.items()}
        return Handed(
            dt,
            weights,
            sources,
            heat_share,
            pull,
            shared_mass,
            damping,
            state.temperature.copy(),
            seen.own,
            kept * (state.kind == GRAIN),
            loss,
        )

    def _sources(self, state, weights, seen, dt, loss, heat_share, pull, shared_mass) -> dict[str, np.ndarray]:
        """All but the volume fraction."""
        sources = {}
        if self.parameters["heat"]:
            sources["heat"], sources["heat_temperature"] = self._density(
                weights, np.stack((heat_share, pull), axis=1)
            ).T
        if self.parameters["drag"]:
            columns = np.concatenate((shared_mass[:, None], shared_mass[:, None] * seen.own), axis=1)
            columns = self._density(weights, columns)
            sources["drag"], sources["drag_velocity"], sources["heat_source"] = (
                columns[:, 0],
                columns[:, 1:],
                self.drag_heat,
            )
        if loss:
            rate = loss.mass[:, None] / dt
            enthalpy = self.case.vapour.heat_capacity * state.temperature[:, None]
            columns = self._density(weights, np.concatenate((rate, rate * seen.own, rate * enthalpy), axis=1))
            sources["vapour"], sources["vapour_momentum"], sources["vapour_enthalpy"] = (
                columns[:, 0],
                columns[:, 1:4],
                columns[:, 4],
            )
        return sources

    def _evaporate(self, state, weights, gas_state, seen, dt) -> tuple[np.ndarray, Loss]:
        """Mean heat conductance (N,) [W/K] of a window, and what evaporates in it.

        The vapour in each cell is taken as it would be at the window's end if no flow carried it: fast exchange
        saturates a cell and does not overshoot.
        """
        p, count = self.parameters["evaporation"], len(state.x)
        conductance, flow, surface = (np.empty(count) for _ in range(3))
        around = seen.slip, seen.density, seen.temperature
        droplet_loss.survey(p, self.parameters["heat"], self.sizes_p, state, *around, dt, conductance, flow, surface)
        concentration = gather(weights, vapour_concentration(p, gas_state))
        if not self.case.coupling.one_way:
            evaporating = surface > concentration
            after = [
                self._relaxed(state, weights, gas_state, flow * some * dt, surface)
                for some in (evaporating, ~evaporating)
            ]
            concentration = np.where(evaporating, *after)
        loss = Loss(*(np.empty(count) for _ in range(4)))
        droplet_loss.losses(
            p,
            self.sizes_p,
            state,
            *around,
            concentration,
            dt,
            conductance,
            loss.mass,
            loss.still,
            loss.moving,
            loss.refused,
        )
        return conductance, loss

    def _relaxed(self, state, weights, gas_state, exchanged, surface) -> np.ndarray:
        """Vapour around the particles [kmol/m3] once they have exchanged so much gas (N,) [m3] with the cells."""
        deposited = deposit(weights, np.stack((exchanged, exchanged * surface), axis=1))
        room = self._room(weights, state.mass * (state.kind == GRAIN)) * self.volumes
        cells = vapour_concentration(self.parameters["evaporation"], gas_state)
        return gather(weights, (room * cells + deposited[:, 1]) / (room + deposited[:, 0]))

    def pace(self, state, weights, gas_state) -> tuple[float, float, float]:
        """At the start: rate [1/s] at which the fastest cell takes the grains' temperature, `stake` [J], and rate [1/s]
        at which vapour comes into the fastest cell, over the gas in it."""
        handed = self.hand(state, weights, (weights, state.kind == GRAIN), gas_state, INSTANT)
        thickening = self.vapour_share(handed, gas_state) / INSTANT
        if not self.parameters["heat"]:
            return 0.0, 0.0, thickening
        full, resistance = self._resistance(state, weights, gas_state)
        rate = float((handed.sources["heat"][full] * resistance).max(initial=0.0))
        return rate, self.stake(state, weights, gas_state), thickening

    def vapour_share(self, handed: Handed, gas_state) -> float:
        """Vapour that a window brought into a cell, over the gas in it; the largest of all cells."""
        if "vapour" not in handed.sources:
            return 0.0
        room = self._room(handed.weights, handed.mass)
        return float((handed.sources["vapour"] * handed.dt / (room * gas_state.fields["density"])).max(initial=0.0))

    def stake(self, state, weights, gas_state) -> float:
        """A scale of heat [J]: the gas among the grains, and they, brought to equilibrium through all of the
        temperatures that the case has."""
        if not self.parameters["heat"]:
            return 0.0
        full, resistance = self._resistance(state, weights, gas_state)
        return float(temperature_span(self.case) * (self.volumes[full] / resistance).sum())

    def _resistance(self, state, weights, gas_state) -> tuple[np.ndarray, np.ndarray]:
        """Mask of the cells with grains, and 1/C_p + 1/C_g of these [m3 K/J]."""
        content = self._density(weights, state.mass * (state.kind == GRAIN) * self.case.grains.heat_capacity)
        gas = (
            self._room(weights, state.mass * (state.kind == GRAIN))
            * gas_state.fields["density"]
            * self.case.gas.heat_capacity
        )
        full = content > 0.0
        return full, 1.0 / content[full] + 1.0 / gas[full]

    def take(self, handed: Handed, gas_state) -> Taken:
        """The reaction on the particles, from the new gas state with the old weights, temperatures and velocities."""
        count = len(handed.heat)
        taken_heat, from_gas = np.zeros(count), 0.0
        impulse, impulse_from_gas = np.zeros((count, 3)), np.zeros(3)
        if self.parameters["heat"]:
            temperature = gas_state.fields["temperature"]
            taken_heat = handed.dt * (handed.heat * gather(handed.weights, temperature) - handed.pull)
            given = handed.sources["heat"] * temperature - handed.sources["heat_temperature"]
            from_gas = float((given * self.volumes).sum() * handed.dt)
        if self.parameters["drag"]:
            velocity = gas_state.fields["velocity"]
            apart = gather(handed.weights, velocity) - handed.velocity
            impulse = handed.dt * handed.drag[:, None] * apart
            given = handed.sources["drag"][:, None] * velocity - handed.sources["drag_velocity"]
            impulse_from_gas = np.einsum("ij,i->j", given, self.volumes) * handed.dt
            self.drag_heat = self._density(handed.weights, np.einsum("ij,ij->i", impulse, apart) / handed.dt)
        if self.case.coupling.one_way:  # the gas feels nothing
            from_gas, impulse_from_gas = 0.0, np.zeros(3)
        if not handed.loss:
            return Taken(taken_heat, taken_heat, impulse, from_gas, impulse_from_gas)
        return self._with_vapour(Taken(taken_heat, taken_heat, impulse, from_gas, impulse_from_gas), handed)

    def _with_vapour(self, taken: Taken, handed: Handed) -> Taken:
        """The same with what evaporation takes."""
        mass, latent = handed.loss.mass, self.parameters["evaporation"].latent_heat
        excess = self.case.grains.heat_capacity - self.case.vapour.heat_capacity
        given = (
            0.0 if self.case.coupling.one_way else float((handed.sources["vapour"] * self.volumes).sum() * handed.dt)
        )
        return replace(
            taken, warming=taken.heat - latent * mass, vapour=float(mass.sum()), vapour_to_gas=given,
            latent_heat=latent * float(mass.sum()), capacity_heat=excess * float((mass * handed.temperature).sum()),
            refused=float(handed.loss.refused.sum()),
        )  # fmt: skip

    def grip(self, state, handed: Handed) -> float:
        """Rate [1/s] at which gas that cannot give way stops grains that move as one, mean by mass.

        With alpha_g v_g + alpha_p v_p given, drag and pressure gradient together are beta/alpha_g^2 v_p: the rate is
        beta/(alpha_g^2 alpha_p rho_p). 0 where the gas does not feel the volume of the grains.
        """
        mass = state.mass * (state.kind == GRAIN)
        if not self.parameters["gas_pressure"] or self.case.coupling.one_way or not mass.any():
            return 0.0
        alpha_p = np.minimum(state.density / self.case.grains.density, self.case.grains.packing_limit)
        return float(np.average(handed.damping / (1.0 - alpha_p) ** 2, weights=mass))

    def settle(self, state, handed: Handed) -> None:
        """Take from the particles what evaporated."""
        if handed.loss:
            droplet_loss.apply(
                self.parameters["evaporation"],
                self.sizes_p,
                state,
                handed.loss.mass,
                handed.loss.still,
                handed.loss.moving,
            )

    def drag_heat_of(self, handed: Handed) -> float:
        """Heat of drag [J] that the gas was handed."""
        if "heat_source" not in handed.sources or self.case.coupling.one_way:
            return 0.0
        return float((handed.sources["heat_source"] * self.volumes).sum() * handed.dt)

    def _room(self, weights, mass) -> np.ndarray:
        """Gas volume fraction of the cells with grains of `mass` (N,) [kg] in them."""
        return 1.0 - deposit(weights, mass / self.case.grains.density) / self.volumes

    def _density(self, weights, amounts) -> np.ndarray:
        """Extensive amounts (N,) or (N, m) of the particles per volume of the cells."""
        deposited = deposit(weights, amounts)
        return deposited / (self.volumes if deposited.ndim == 1 else self.volumes[:, None])

    def _grains(self):
        return self.case.grains.density, self.case.grains.heat_capacity
