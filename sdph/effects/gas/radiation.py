"""Radiation of grains: grey, optically thin, to surroundings of one temperature and, for its share, to the gas.

Of epsilon sigma A T^4 the gas takes the share `gas_absorptivity`, and gives as much back by its own temperature: a
conductance beside that of heat. The rest leaves the system, and comes back by the temperature of the surroundings,
exactly, half of it before and half of it after what a window exchanges with the gas (Strang 1968, second order in the
window).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import prange

from sdph.effects.effect import NO_LIMIT, Effect, Judgement
from sdph.effects.gas import sizes
from sdph.engine.state import GRAIN
from sdph.laws import radiation as law
from sdph.laws.compiled import inlined, parallel, serial
from sdph.laws.constants import STEFAN_BOLTZMANN
from sdph.schema import quantity, record

# Of the time in which grains cool by radiation, most that a window takes it apart from the rest; our choice: errs by
# 2.5e-5 of the cooling (tests/effects/gas/test_radiation_effect.py)
SPLIT = 0.1
BESIDE = ("heat", "conduction", "evaporation", "reaction")  # what changes the temperature of grains too
THICK = 1.0  # optical depth through which a third of the radiation, exp(-1), gets; our choice
HIDDEN = (
    "radiation takes each grain to see the surroundings past all others (optically thin), and "
    f"from {THICK:g} on most are hidden: what is radiated to the surroundings is too much"
)
TIMES, SOURCE = "run / radiative response time", "Incropera & DeWitt, section 5.3"


@record
class Radiation:
    emissivity: float = quantity("", above=0.0, most=1.0)  # of the grains
    surroundings_temperature: float = quantity("K", least=0.0)
    gas_absorptivity: float = quantity("", 0.0, least=0.0, most=1.0)  # share of it that the gas exchanges

    @property
    def temperatures(self) -> tuple[float]:
        """Temperature of the surroundings [K], one of those of the case."""
        return (self.surroundings_temperature,)


class RadiationP(NamedTuple):
    """Emissivity for gas and surroundings [-]; temperature of these [K]; density [kg/m3], heat capacity [J/(kg K)]."""

    to_gas: float
    to_surroundings: float
    surroundings: float
    grain_density: float
    grain_heat_capacity: float


def kernel(case) -> RadiationP:
    own, grains = case.parameters["radiation"], case.grains
    shares = own.emissivity * own.gas_absorptivity, own.emissivity * (1.0 - own.gas_absorptivity)
    return RadiationP(*shares, own.surroundings_temperature, grains.density, grains.heat_capacity)


@serial
def surface(sizes_p, s, i):
    """Surface of the grains of particle i over their volume [1/m]: 6/d, the mass average over its sizes."""
    total = whole = 0.0
    own = sizes.birth(sizes_p, s, i)
    for q in range(sizes.classes(sizes_p)):
        d, mass = sizes.grain(sizes_p, s, i, own, q)
        if mass == 0.0:  # gone; what comes after is smaller still
            break
        total += mass * 6.0 / d
        whole += mass
    return total / whole


@parallel
def surfaces(sizes_p, s, out):
    """Surface of the grains of each particle over their volume [1/m], into out (N,); 0 of others."""
    for i in prange(len(s.x)):
        out[i] = surface(sizes_p, s, i) if s.kind[i] == GRAIN else 0.0


@inlined
def conductance(p, sizes_p, s, i, gas_temperature):
    """Heat exchanged with the gas per kelvin [W/K] by the grains of particle i, at the temperatures of now."""
    if len(p) == 0:
        return 0.0
    rho = s.grain_density[i] if len(s.grain_density) else p.grain_density
    area = s.mass[i] / rho * surface(sizes_p, s, i)
    return p.to_gas * area * law.exchange_coefficient(s.temperature[i], gas_temperature)


@serial
def cooled(p, sizes_p, s, i, temperature, dt):
    """Temperature [K] of particle i after dt [s] of radiation to the surroundings alone."""
    rho = s.grain_density[i] if len(s.grain_density) else p.grain_density
    c = s.grain_capacity[i] if len(s.grain_capacity) else p.grain_heat_capacity
    rate = p.to_surroundings * STEFAN_BOLTZMANN * surface(sizes_p, s, i) / (rho * c)
    return law.cooled(temperature, p.surroundings, rate, dt)


@parallel
def cool(p, sizes_p, s, temperature, dt, out):
    """Temperatures (N,) [K] after dt [s] of radiation to the surroundings alone, into out (N,)."""
    for i in prange(len(s.x)):
        out[i] = cooled(p, sizes_p, s, i, temperature[i], dt) if s.kind[i] == GRAIN else temperature[i]


def window_limit(p, case, state) -> float:
    """A part of the time in which the hottest and finest grains cool, where something else warms or cools them too."""
    if not len(state.mass) or not any(name in case.effects for name in BESIDE):
        return NO_LIMIT
    hottest = max(float(state.temperature.max()), p.surroundings)
    finest = float(np.min(state.diameter, where=state.diameter > 0.0, initial=case.grains.diameter))
    rate = (p.to_gas + p.to_surroundings) * law.exchange_coefficient(hottest, hottest) * 6.0 / finest
    stored = min(grains.density * grains.heat_capacity for grains in case.kinds)
    return SPLIT * stored / rate


def call(scales) -> Judgement:
    """Time of the run over the time in which the grains take the temperature of the surroundings."""
    s, own = scales, scales.case.parameters["radiation"]
    temperatures = [patch.temperature for patch in s.patches]
    if not temperatures:
        return Judgement(TIMES, 0.0, 0.01, SOURCE, 0.0)
    apart = max(abs(t - own.surroundings_temperature) for t in temperatures)
    coefficient = own.emissivity * law.exchange_coefficient(max(temperatures), own.surroundings_temperature)
    felt = s.end * coefficient * 6.0 / (s.grains.density * s.grains.heat_capacity * s.grains.diameter) if apart else 0.0
    return Judgement(TIMES, felt, 0.01, SOURCE, -math.expm1(-felt))


EFFECT = Effect(
    name="radiation",
    summary="radiation of grains to surroundings and gas",
    parameters=Radiation,
    kernel=kernel,
    arrays=("temperature", "diameter", "diameter_variance", "received", "exchanged"),
    sources=("alpha_g", "heat", "heat_coefficient"),
    window_limit=window_limit,
    call=call,
)
