"""Heat conduction from grain to grain, Cleary & Monaghan 1999, paper Eq. 19 with the sign mended."""

from __future__ import annotations

import math
from typing import NamedTuple

from sdph.effects import limiter
from sdph.effects.effect import NO_LIMIT, Effect, Judgement
from sdph.laws import exchange as law
from sdph.laws.compiled import serial
from sdph.laws.constants import SOFTENING
from sdph.schema import record

STABLE = 0.1  # of rho c h^2 / k, Cleary & Monaghan 1999


@record
class Conduction:
    """Has no input of its own: the conductivity is that of the grains."""


class ConductionP(NamedTuple):
    """k [W/m/K] and density [kg/m3] of the grains."""

    conductivity: float
    grain_density: float


class MixedP(NamedTuple):
    """Largest conductivity [W/m/K] of several materials: what each has is in the State."""

    most: float


def kernel(case) -> ConductionP | MixedP:
    if case.mixed:
        return MixedP(max(grains.conductivity for grains in case.kinds))
    return ConductionP(case.grains.conductivity, case.grains.density)


@serial
def pair(p, h, s, i, j, r_squared, pull):
    """Heat per mass and time [W/kg] that i gets from j; `pull` is m_j (dW/dr)/r [kg/m^(d+2)]."""
    if len(p) == 0:
        return 0.0
    if len(p) == 1:
        k_i = s.density[i] / s.grain_density[i] * s.grain_conductivity[i]
        k_j = s.density[j] / s.grain_density[j] * s.grain_conductivity[j]
        unlike = law.cleary_monaghan_unlike(pull, r_squared, SOFTENING * h * h, k_i, k_j, s.density[i] * s.density[j])
        return unlike * (s.temperature[i] - s.temperature[j])
    mean = 0.5 * (s.density[i] + s.density[j])
    coefficient = law.cleary_monaghan(pull, r_squared, SOFTENING * h * h, p.conductivity, p.grain_density, mean)
    return coefficient * (s.temperature[i] - s.temperature[j])


def dt_limit(p, case, state) -> float:
    """Sub-step limit [s] by the largest diffusivity; among others a grain's own k is up to twice that (harmonic
    mean)."""
    most = max(grains.conductivity for grains in case.kinds)
    if most == 0.0:
        return NO_LIMIT
    among = [law.harmonic_mean(grains.conductivity, most) for grains in case.kinds]
    diffusivity = max(k / (grains.density * grains.heat_capacity) for k, grains in zip(among, case.kinds))
    return STABLE * case.smoothing_length**2 / diffusivity if diffusivity else NO_LIMIT


def call(scales) -> Judgement:
    """Fourier number of the grains; of it matters the share of the temperatures that reaches the grains."""
    diffusivity = scales.grains.conductivity / (scales.grains.density * scales.grains.heat_capacity)
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
