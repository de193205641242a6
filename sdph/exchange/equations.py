"""Terms of the exchange: what each particle sees of the gas, its coefficients, the vapour in the cells."""

from __future__ import annotations

import copy
from typing import NamedTuple

import numpy as np
from numba import prange

from coupling.transfer import gather
from sdph.effects.gas import drag, film, heat, lift, radiation, reaction
from sdph.engine import state as particles
from sdph.engine.state import GRAIN
from sdph.laws import evaporation
from sdph.laws.by_reference import by_reference
from sdph.laws.compiled import parallel
from sdph.laws.exchange import exponential_fraction

# K, least difference of temperatures that the length of a window takes a case to have: where there is none, drag warms
# gas and grains by some mK, and that need not be resolved; `coupling.window_tolerance` of it is 0.01 K; our choice
LEAST_SPAN = 10.0


@by_reference
class Around(NamedTuple):
    """The gas around N particles: its velocity from theirs (N, 3), slip [m/s], density [kg/m3], temperature [K]; and
    what effects ask for besides, no row where none does: vorticity (N, 3) [1/s]."""

    apart: np.ndarray
    slip: np.ndarray
    density: np.ndarray
    temperature: np.ndarray
    vorticity: np.ndarray


class Seen:
    """The gas as the particles see it: its velocity from theirs `apart` (N, 3) and slip (N,), their own velocity (N,
    3); its density and temperature (N,); `fields`, what effects ask for besides, by name."""

    def __init__(self, weights, gas_state, state, fields=()):
        velocity, self.density, self.temperature = (
            gather(weights, gas_state.fields[name]) for name in ("velocity", "density", "temperature")
        )
        self.own = particles.velocities(state)
        self.apart = velocity - self.own
        self.slip = particles.lengths(self.apart)
        self.fields = {name: gather(weights, gas_state.fields[name]) for name in fields}

    @property
    def around(self) -> Around:
        """The same for loops."""
        vorticity = self.fields.get("vorticity", np.zeros((0, 3)))
        return Around(self.apart, self.slip, self.density, self.temperature, vorticity)

    def stirred(self, eddies) -> Seen:
        """The same with the velocity of eddies (N, 3) [m/s] on top of the gas's."""
        found = copy.copy(self)
        found.apart = self.apart + eddies
        found.slip = particles.lengths(found.apart)
        return found


def vapour_concentration(p, gas_state) -> np.ndarray:
    """Vapour in the cells [kmol/m3], Eq. 10."""
    Y, temperature = gas_state.fields["vapour_mass_fraction"], gas_state.fields["temperature"]
    fraction = evaporation.vapour_mole_fraction(Y, p.molar_mass, p.gas_molar_mass)
    return evaporation.vapour_concentration(fraction * p.operating_pressure, temperature)


def temperature_span(case) -> float:
    """Hottest less coldest of all that the case gives a temperature [K], or what a reaction warms it by; LEAST_SPAN at
    least."""
    return max(max(case.temperatures) - min(case.temperatures), reaction.rise(case), LEAST_SPAN)


@parallel
def rates(
    drag_p, heat_p, radiation_p, lift_p, film_p, sizes_p, s, grain_density, around, convection, conductance, damping,
    force,
):  # fmt: skip
    """Rates of every particle as it is, in the gas `around`: heat to it per kelvin [W/K], by convection and in all,
    beta/(alpha_p rho_p) [1/s], and force of the gas that is held (N, 3) [N], where an effect makes one."""
    for i in prange(len(s.x)):
        convection[i] = conductance[i] = damping[i] = 0.0
        if s.kind[i] == GRAIN:
            alpha_p = s.density[i] / (s.grain_density[i] if len(s.grain_density) else grain_density)
            temperature, slip = around.temperature[i], around.slip[i]
            r = film.ratio(film_p, s, i, temperature)
            density = around.density[i] * (r * r)
            convection[i] = heat.conductance(heat_p, sizes_p, s, i, alpha_p, slip, density) / r
            conductance[i] = convection[i] + radiation.conductance(radiation_p, sizes_p, s, i, temperature)
            damping[i] = drag.damping(drag_p, sizes_p, s, i, alpha_p, slip, density) / r
            if len(force):
                x, y, z = lift.force(lift_p, sizes_p, s, i, around, slip)
                force[i, 0] += x
                force[i, 1] += y
                force[i, 2] += z


@parallel
def shares(s, temperature, heat_capacity, origin, dt, conductance, damping, kept, power, heat_share, pull, shared_mass):
    """Shares of a window's exchange: heat_share [W/K] and pull [W] of heat, from `temperature` (N,) on, m_k f_k/dt
    [kg/s] of momentum.

    Temperatures count from `origin` [K], so that what is exchanged is no small difference of large numbers.

    With a `power` P [W] from elsewhere held over the window, x = dt K/C and C of the mass that is `kept` [kg],
    Q/dt = K phi (T'_g - T) - P (1 - phi), phi = (1 - exp(-x))/x; without one K phi = C f/dt.
    """
    for i in prange(len(s.x)):
        heat_share[i] = pull[i] = 0.0
        capacity = kept[i] * (s.grain_capacity[i] if len(s.grain_capacity) else heat_capacity)
        if conductance[i] > 0.0:
            heat_share[i] = (
                capacity * exponential_fraction(dt * conductance[i] / capacity) / dt if capacity > 0.0 else 0.0
            )
            pull[i] = heat_share[i] * (temperature[i] - origin)
            if len(power) > 0:
                pull[i] += power[i] * (1.0 - heat_share[i] / conductance[i])
        shared_mass[i] = kept[i] * exponential_fraction(dt * damping[i]) / dt
