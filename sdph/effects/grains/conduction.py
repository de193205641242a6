"""Heat conduction from grain to grain, Cleary & Monaghan 1999, paper Eq. 19 with the sign mended."""

from __future__ import annotations

import math
from typing import NamedTuple

from sdph.effects import limiter
from sdph.effects.effect import NO_LIMIT, Effect, Judgement
from sdph.engine import arrays
from sdph.laws import exchange as law
from sdph.laws import packed_beds
from sdph.laws.compiled import serial
from sdph.laws.constants import SOFTENING
from sdph.schema import CaseError, choice, record

STABLE = 0.1  # of rho c h^2 / k, Cleary & Monaghan 1999


@record
class Conduction:
    # grains conduct as if they were one piece in their share of the volume (the paper), or as a bed with gas in it
    law: str = choice("parallel", "zehner_schluender")


class ConductionP(NamedTuple):
    """k [W/m/K] and density [kg/m3] of the grains."""

    conductivity: float
    grain_density: float


class MixedP(NamedTuple):
    """Largest conductivity [W/m/K] of several materials: what each has is in the State."""

    most: float


class PackedP(NamedTuple):
    """k of the gas, k [W/m/K] and density [kg/m3] of the grains; what each of several materials has is in the State."""

    gas_conductivity: float
    conductivity: float
    grain_density: float


def kernel(case) -> ConductionP | MixedP | PackedP:
    if case.parameters["conduction"].law == "zehner_schluender":
        return _packed(case)
    if case.mixed:
        return MixedP(max(grains.conductivity for grains in case.kinds))
    return ConductionP(case.grains.conductivity, case.grains.density)


def _packed(case) -> PackedP:
    least = min(grains.conductivity for grains in case.kinds)
    if least < case.gas.conductivity:
        raise CaseError(
            f"conduction.law = 'zehner_schluender': grains of {least:g} W/(m K) insulate in gas of "
            f"{case.gas.conductivity:g} W/(m K), and would take heat up the slope; it needs grains that conduct no "
            "less than the gas: take law = 'parallel'"
        )
    return PackedP(case.gas.conductivity, case.grains.conductivity, case.grains.density)


@serial
def pair(p, own, h, s, i, j, r_squared, pull):
    """Heat per mass and time [W/kg] that i gets from j; `pull` is m_j (dW/dr)/r [kg/m^(d+2)], own (N,) [W/m/K] what
    `packed` gives, where the law is one of packed beds."""
    if len(p) == 0:
        return 0.0
    if len(p) == 2:
        mean = 0.5 * (s.density[i] + s.density[j])
        coefficient = law.cleary_monaghan(pull, r_squared, SOFTENING * h * h, p.conductivity, p.grain_density, mean)
        return coefficient * (s.temperature[i] - s.temperature[j])
    if len(p) == 3:
        k_i, k_j = own[i], own[j]
    else:
        k_i = s.density[i] / s.grain_density[i] * s.grain_conductivity[i]
        k_j = s.density[j] / s.grain_density[j] * s.grain_conductivity[j]
    unlike = law.cleary_monaghan_unlike(pull, r_squared, SOFTENING * h * h, k_i, k_j, s.density[i] * s.density[j])
    return unlike * (s.temperature[i] - s.temperature[j])


@serial
def packed(p, s, i):
    """K [W/m/K] of the grains of particle i beside the gas, by the law of packed beds."""
    if len(p) != 3:
        return 0.0
    if len(s.grain_density):
        return packed_beds.beside_gas(s.density[i] / s.grain_density[i], s.grain_conductivity[i], p.gas_conductivity)
    return packed_beds.beside_gas(s.density[i] / p.grain_density, p.conductivity, p.gas_conductivity)


@serial
def conducted(p, s, i):
    """k [W/m/K] that the grains of particle i conduct with, by any law."""
    if len(p) == 3:
        return packed(p, s, i)
    if len(p) == 2:
        return s.density[i] / p.grain_density * p.conductivity
    return s.density[i] / s.grain_density[i] * s.grain_conductivity[i]


def dt_limit(p, case, state) -> float:
    """Sub-step limit [s] by the largest diffusivity; among others a grain's own k is up to twice that (harmonic
    mean)."""
    diffusivity = _of_packed(p, case, state) if len(p) == 3 else _of_materials(case)
    return STABLE * case.smoothing_length**2 / diffusivity if diffusivity else NO_LIMIT


def _of_materials(case) -> float:
    most = max(grains.conductivity for grains in case.kinds)
    among = [law.harmonic_mean(grains.conductivity, most) for grains in case.kinds]
    return max(k / (grains.density * grains.heat_capacity) for k, grains in zip(among, case.kinds))


def _of_packed(p, case, state) -> float:
    """Twice the largest diffusivity [m2/s], that of the densest, as K/alpha_p rises with alpha_p."""
    if not len(state.density):
        return 0.0
    if len(state.grain_density):
        densest = float((state.density / state.grain_density).max())
    else:
        densest = arrays.ends(state.density)[1] / p.grain_density
    stored = ((grains.conductivity, grains.density * grains.heat_capacity) for grains in case.kinds)
    return 2.0 * max(packed_beds.beside_gas(densest, k, p.gas_conductivity) / densest / c for k, c in stored)


def conductivity(case, alpha_p: float) -> float:
    """K/alpha_p [W/m/K] of the grains of a case, of several materials of the first, by its law."""
    if alpha_p and "conduction" in case.parameters and case.parameters["conduction"].law == "zehner_schluender":
        return packed_beds.beside_gas(alpha_p, case.grains.conductivity, case.gas.conductivity) / alpha_p
    return case.grains.conductivity


def over_packed(scales) -> float:
    """Conductivity of grains and gas by the law of a case over that of a packed bed (Zehner & Schluender)."""
    gas, alpha_p = scales.gas.conductivity, scales.alpha_p
    whole = alpha_p * conductivity(scales.case, alpha_p) + (1.0 - alpha_p) * gas
    return whole / packed_beds.zehner_schluender(alpha_p, scales.grains.conductivity, gas)


def call(scales) -> Judgement:
    """Fourier number of the grains; of it matters the share of the temperatures that reaches the grains."""
    stored = scales.grains.density * scales.grains.heat_capacity
    diffusivity = conductivity(scales.case, scales.alpha_p) / stored
    fourier = diffusivity * scales.end / scales.length**2 if not scales.lone and scales.span else 0.0
    source = "Carslaw & Jaeger 1959: depth sqrt(D t) over the width"
    return Judgement("Fourier number of the grains", fourier, 0.01, source, -math.expm1(-fourier))


EFFECT = Effect(
    name="conduction",
    summary="heat conduction from grain to grain",
    parameters=Conduction,
    kernel=kernel,
    arrays=("temperature",),
    dt_limit=dt_limit,
    held=limiter.softened,
    call=call,
)
