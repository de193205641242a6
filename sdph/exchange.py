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

from dataclasses import dataclass

import numpy as np
from numba import njit, prange

from coupling.transfer import Weights, deposit, gather
from sdph import effects, particles
from sdph.effects import drag, heat, sizes
from sdph.laws.exchange import exponential_fraction
from sdph.ledger import vector

INSTANT = 1e-12  # s, so short that f_k/dt is K_k/C_k
NEGLIGIBLE = 1e-6  # of the temperature: smaller differences need not be resolved (round-off else rules the window); our choice


@dataclass(frozen=True)
class Handed:
    """What one window hands over: the sources for the gas, and what the reaction is computed from.

    heat (N,) [W/K] is C_k f_k/dt, drag (N,) [kg/s] is m_k f_k/dt; temperature and velocity are those of the particles
    when they were computed; damping (N,) [1/s] is beta/(alpha_p rho_p).
    """

    dt: float
    weights: Weights
    sources: dict[str, np.ndarray]
    heat: np.ndarray
    drag: np.ndarray
    damping: np.ndarray
    temperature: np.ndarray
    velocity: np.ndarray


@dataclass(frozen=True)
class Taken:
    """What the particles take in a window: heat (N,) [J], impulse (N, 3) [kg m/s]; and what the gas gave by its own sum."""

    heat: np.ndarray
    impulse: np.ndarray
    heat_from_gas: float
    impulse_from_gas: np.ndarray

    def columns(self) -> dict[str, float]:
        """Both sides of the exchange for the ledger."""
        heat = {"heat_to_particles_J": float(self.heat.sum()), "heat_to_gas_J": -self.heat_from_gas}
        own, other = self.impulse.sum(axis=0), -self.impulse_from_gas
        return heat | vector("impulse_to_particles", own) | vector("impulse_to_gas", other)


class Exchange:
    """The effects of a case that reach across to the gas."""

    def __init__(self, case, mesh, parameters):
        self.case = case
        self.parameters = parameters
        self.sizes_p = sizes.kernel(case)
        self.volumes = mesh.volumes / mesh.depth
        rows = [effects.REGISTRY[name] for name in case.effects]
        self.sources = tuple(dict.fromkeys(name for row in rows for name in row.sources))
        self.drag_heat = np.zeros(len(self.volumes))  # [W/m3], for the next window

    def alpha_g(self, state, weights) -> np.ndarray:
        """Gas volume fraction of the cells."""
        return 1.0 - deposit(weights, state.mass / self.case.grains.density) / self.volumes

    def hand(self, state, weights, gas_state, dt, alpha_g) -> Handed:
        """Coefficients from the old gas state, and the sources for the gas; `alpha_g` (C,) is that of the window's end."""
        velocity, density = (gather(weights, gas_state.fields[name]) for name in ("velocity", "density"))
        own = particles.velocities(state)
        slip = np.sqrt(((velocity - own) ** 2).sum(axis=1))
        shared_heat, shared_mass, damping = (np.zeros(len(slip)) for _ in range(3))
        _coefficients(
            self.parameters["drag"], self.parameters["heat"], self.sizes_p, state, self._grains(), dt, slip, density,
            shared_heat, shared_mass, damping,
        )  # fmt: skip
        sources = {"alpha_g": alpha_g} if "alpha_g" in self.sources else {}
        if self.parameters["heat"]:
            columns = np.stack((shared_heat, shared_heat * state.temperature), axis=1)
            sources["heat"], sources["heat_temperature"] = self._density(weights, columns).T
        if self.parameters["drag"]:
            columns = np.concatenate((shared_mass[:, None], shared_mass[:, None] * own), axis=1)
            columns = self._density(weights, columns)
            sources["drag"], sources["drag_velocity"], sources["heat_source"] = columns[:, 0], columns[:, 1:], self.drag_heat
        sources = {name: np.ascontiguousarray(values) for name, values in sources.items()}
        return Handed(dt, weights, sources, shared_heat, shared_mass, damping, state.temperature.copy(), own)

    def pace(self, state, weights, gas_state) -> tuple[float, float]:
        """Rate [1/s] of the fastest cell, and a scale of heat [J]: the gas among the grains, and they, brought to
        equilibrium through all of the temperatures that the case has."""
        if not self.parameters["heat"]:
            return 0.0, 0.0
        alpha_g = self.alpha_g(state, weights)
        eps = self.hand(state, weights, gas_state, INSTANT, alpha_g).sources["heat"]
        content = self._density(weights, state.mass * self.case.grains.heat_capacity)
        gas = alpha_g * gas_state.fields["density"] * self.case.gas.heat_capacity
        full = content > 0.0
        resistance = 1.0 / content[full] + 1.0 / gas[full]
        span = _temperature_span(self.case)
        return float((eps[full] * resistance).max(initial=0.0)), float(span * (self.volumes[full] / resistance).sum())

    def take(self, handed: Handed, gas_state) -> Taken:
        """The reaction on the particles, from the new gas state with the old weights, temperatures and velocities."""
        count = len(handed.heat)
        taken_heat, from_gas = np.zeros(count), 0.0
        impulse, impulse_from_gas = np.zeros((count, 3)), np.zeros(3)
        if self.parameters["heat"]:
            temperature = gas_state.fields["temperature"]
            taken_heat = handed.dt * handed.heat * (gather(handed.weights, temperature) - handed.temperature)
            given = handed.sources["heat"] * temperature - handed.sources["heat_temperature"]
            from_gas = float((given * self.volumes).sum() * handed.dt)
        if self.parameters["drag"]:
            velocity = gas_state.fields["velocity"]
            apart = gather(handed.weights, velocity) - handed.velocity
            impulse = handed.dt * handed.drag[:, None] * apart
            given = handed.sources["drag"][:, None] * velocity - handed.sources["drag_velocity"]
            impulse_from_gas = (given * self.volumes[:, None]).sum(axis=0) * handed.dt
            self.drag_heat = self._density(handed.weights, (impulse * apart).sum(axis=1) / handed.dt)
        if self.case.coupling.one_way:  # the gas feels nothing
            from_gas, impulse_from_gas = 0.0, np.zeros(3)
        return Taken(taken_heat, impulse, from_gas, impulse_from_gas)

    def drag_heat_of(self, handed: Handed) -> float:
        """Heat of drag [J] that the gas was handed."""
        if "heat_source" not in handed.sources or self.case.coupling.one_way:
            return 0.0
        return float((handed.sources["heat_source"] * self.volumes).sum() * handed.dt)

    def _density(self, weights, amounts) -> np.ndarray:
        """Extensive amounts (N,) or (N, m) of the particles per volume of the cells."""
        deposited = deposit(weights, amounts)
        return deposited / (self.volumes if deposited.ndim == 1 else self.volumes[:, None])

    def _grains(self):
        return self.case.grains.density, self.case.grains.heat_capacity


def _temperature_span(case) -> float:
    """Hottest less coldest of all that the case gives a temperature [K], and where they are alike a negligible part of it."""
    given = [case.gas.temperature, *(region.temperature for region in case.particles.values())]
    given += [boundary.temperature for boundary in case.boundaries.values() if boundary.temperature]
    return max(max(given) - min(given), NEGLIGIBLE * max(given))


@njit(cache=True, parallel=True, error_model="numpy")
def _coefficients(drag_p, heat_p, sizes_p, s, grains, dt, slip, gas_density, shared_heat, shared_mass, damping):
    """C_k f_k/dt [W/K], m_k f_k/dt [kg/s] and beta/(alpha_p rho_p) [1/s] of every particle."""
    density, heat_capacity = grains
    for i in prange(len(s.x)):
        alpha_p = s.density[i] / density
        conductance = heat.conductance(heat_p, sizes_p, s, i, alpha_p, slip[i], gas_density[i])
        capacity = s.mass[i] * heat_capacity
        shared_heat[i] = capacity * exponential_fraction(dt * conductance / capacity) / dt
        rate = drag.damping(drag_p, sizes_p, s, i, alpha_p, slip[i], gas_density[i])
        shared_mass[i] = s.mass[i] * exponential_fraction(dt * rate) / dt
        damping[i] = rate
