"""Exchange between particles and gas over one window: unconditionally stable, and equal on both sides.

For particle k with heat capacity C_k = m_k c, the share f_k = 1 - exp(-dt K_k/C_k) of it meets the gas, cell by
cell with the transfer weights w_kc (sdph-notes, section 3). The gas is handed, as implicit coefficient and source,

    eps_c V_c = sum_k w_kc C_k f_k/dt,      eps T_p V_c = sum_k w_kc C_k f_k/dt T_k

and from the temperature T'_c that it answers with, particle k takes exactly what the cells gave:

    Q_k = C_k f_k sum_c w_kc (T'_c - T_k)   [J].

Momentum goes the same way with m_k for C_k and the drag coefficient for K_k.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit, prange

from coupling.transfer import Weights, deposit, gather
from sdph import effects, particles
from sdph.effects import heat, sizes
from sdph.laws.exchange import exponential_fraction


INSTANT = 1e-12  # s, so short that f_k/dt is K_k/C_k
NEGLIGIBLE = 1e-6  # of the temperature: smaller differences need not be resolved (round-off else rules the window); our choice


@dataclass(frozen=True)
class Handed:
    """What one window hands over.

    heat (N,) [W/K] is C_k f_k/dt, temperature (N,) [K] that of the particles when it was computed.
    """

    dt: float
    weights: Weights
    sources: dict[str, np.ndarray]
    heat: np.ndarray
    temperature: np.ndarray


@dataclass(frozen=True)
class Taken:
    """What the particles take from the gas in a window: heat (N,) [J]; the gas's own sum `heat_from_gas` [J]."""

    heat: np.ndarray
    heat_from_gas: float


class Exchange:
    """The effects of a case that reach across to the gas."""

    def __init__(self, case, mesh):
        self.case = case
        self.heat_p = effects.kernel_of(effects.REGISTRY["heat"], case)
        self.sizes_p = sizes.kernel(case)
        self.volumes = mesh.volumes / mesh.depth
        rows = [effects.REGISTRY[name] for name in case.effects]
        self.sources = tuple(dict.fromkeys(name for row in rows for name in row.sources))

    def alpha_g(self, state, weights) -> np.ndarray:
        """Gas volume fraction of the cells."""
        return 1.0 - deposit(weights, state.mass / self.case.grains.density) / self.volumes

    def hand(self, state, weights, gas_state, dt) -> Handed:
        """Coefficients from the old gas state, and the sources for the gas."""
        velocity, density = (gather(weights, gas_state.fields[name]) for name in ("velocity", "density"))
        slip = np.sqrt(((velocity - particles.velocities(state)) ** 2).sum(axis=1))
        shared = np.empty(len(slip))
        _coefficients(self.heat_p, self.sizes_p, state, self._grains(), dt, slip, density, shared)
        columns = np.stack((shared, shared * state.temperature), axis=1)
        eps, eps_t = (deposit(weights, columns) / self.volumes[:, None]).T
        sources = {"alpha_g": self.alpha_g(state, weights), "heat": eps, "heat_temperature": eps_t}
        return Handed(dt, weights, sources, shared, state.temperature.copy())

    def pace(self, state, weights, gas_state) -> tuple[float, float]:
        """Rate [1/s] of the fastest cell, and the heat [J] that flows until every cell is in equilibrium with itself."""
        eps = self.hand(state, weights, gas_state, INSTANT).sources
        content = deposit(weights, state.mass * self.case.grains.heat_capacity) / self.volumes
        gas = self.alpha_g(state, weights) * gas_state.fields["density"] * self.case.gas.heat_capacity
        full = content > 0.0
        rate = eps["heat"][full] * (1.0 / content[full] + 1.0 / gas[full])
        temperature = gas_state.fields["temperature"][full]
        apart = np.abs(temperature - eps["heat_temperature"][full] / eps["heat"][full])
        heat = np.maximum(apart, NEGLIGIBLE * temperature) * self.volumes[full] / (1.0 / content[full] + 1.0 / gas[full])
        return float(rate.max(initial=0.0)), float(heat.sum())

    def take(self, handed: Handed, gas_state) -> Taken:
        """The reaction on the particles, from the new gas state with the old weights and temperatures."""
        temperature = gas_state.fields["temperature"]
        taken = handed.dt * handed.heat * (gather(handed.weights, temperature) - handed.temperature)
        given = handed.sources["heat"] * temperature - handed.sources["heat_temperature"]
        return Taken(taken, float((given * self.volumes).sum() * handed.dt))

    def _grains(self):
        return self.case.grains.density, self.case.grains.heat_capacity


@njit(cache=True, parallel=True, error_model="numpy")
def _coefficients(heat_p, sizes_p, s, grains, dt, slip, gas_density, shared):
    """C_k f_k/dt [W/K] of every particle."""
    density, heat_capacity = grains
    for i in prange(len(s.x)):
        alpha_p = s.density[i] / density
        conductance = heat.conductance(heat_p, sizes_p, s, i, alpha_p, slip[i], gas_density[i])
        capacity = s.mass[i] * heat_capacity
        shared[i] = capacity * exponential_fraction(dt * conductance / capacity) / dt
