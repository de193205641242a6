"""Granular temperature: production, diffusion, dissipation and damping by the gas; or the algebraic equilibrium."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit, prange

from sdph.effects.effect import NO_LIMIT, Effect, Judgement, diffusive_limit
from sdph.laws import granular
from sdph.laws.constants import TINY
from sdph.schema import choice, flag, quantity, record

MODELS = ("transport", "algebraic")
DISSIPATIONS = ("lun", "paper")  # alpha_p^2 as derived, or alpha_p^1 as printed


@record
class GranularTemperature:
    model: str = choice(*MODELS)
    dissipation: str = choice(*DISSIPATIONS)
    artificial_heating: bool = flag(False)  # heat of the artificial viscosity to theta, as in the paper; else to T
    least: float = quantity("m2_s2", 1e-6, above=0.0)  # sdph-notes, section 2
    most: float = quantity("m2_s2", 100.0, above=0.0)


class TemperatureP(NamedTuple):
    """Model and dissipation by place; share of artificial heating to theta; restitution; packing; density; h;
    bounds."""

    model: int
    dissipation: int
    artificial: float
    restitution: float
    packing: float
    grain_density: float
    h: float
    least: float
    most: float


def kernel(case) -> TemperatureP:
    own, grains = case.parameters["granular_temperature"], case.grains
    places = MODELS.index(own.model), DISSIPATIONS.index(own.dissipation), float(own.artificial_heating)
    return TemperatureP(
        *places, grains.restitution, grains.packing_limit, grains.density, case.smoothing_length, own.least, own.most
    )


@njit(cache=True, error_model="numpy")
def conductivity(p, alpha_p, theta, diameter):
    """k_theta [kg/m/s] (paper section 2.1), held at the Knudsen limit 3/2 alpha_p rho h sqrt(theta), our choice."""
    if len(p) == 0 or p.model == 1:
        return 0.0
    a = granular.capped_fraction(alpha_p, p.packing)
    g0 = granular.sinclair_jackson(a, p.packing)
    own = granular.gidaspow_conductivity(a, theta, p.restitution, g0, p.grain_density, diameter)
    return min(own, 1.5 * alpha_p * p.grain_density * p.h * np.sqrt(theta))


@njit(cache=True, error_model="numpy")
def pair(p, stress, s, i, j, squeeze_work, viscous_work, artificial_work, scale):
    """What the pair gives to theta of i per mass [W/kg]: work of agitation, and diffusion with the harmonic mean.

    scale = m_j (dW/dr)/r / (rho_i rho_j). The works [W/kg] are those of the whole pair; half goes to each.
    """
    if len(p) == 0:
        return 0.0
    k_i, k_j = stress.conductivity[i], stress.conductivity[j]
    k = 2.0 * k_i * k_j / max(k_i + k_j, TINY)
    made = 0.5 * (squeeze_work + viscous_work + p.artificial * artificial_work)
    return made + 2.0 * k * (s.theta[i] - s.theta[j]) * scale


@njit(cache=True, error_model="numpy")
def rest(p, artificial_work):
    """Share of the artificial viscosity's work that does not feed theta and heats the grains [W/kg]."""
    if len(p) == 0:
        return artificial_work
    return (1.0 - p.artificial) * artificial_work


@njit(cache=True, error_model="numpy")
def advance(p, alpha_p, theta, heating, damping, diameter, shear_squared, divergence, dt):
    """theta after dt [m2/s2]: explicit `heating` [W/kg], then dissipation and damping by their exact step.

    damping = beta/(alpha_p rho_p) [1/s]. Returns theta held within its bounds, and by how much that changed it.
    """
    if len(p) == 0:
        return theta, 0.0
    a = granular.capped_fraction(alpha_p, p.packing)
    g0 = granular.sinclair_jackson(a, p.packing)
    if p.model == 1:
        beta = damping * alpha_p * p.grain_density
        free = granular.equilibrium_theta(
            a, p.restitution, g0, p.grain_density, diameter, shear_squared, divergence, beta
        )
    else:
        weight = 1.0 if p.dissipation == 0 else 1.0 / a
        cooling = granular.cooling_coefficient(a, p.restitution, g0, diameter) * weight
        free = granular.theta_step(max(theta + 2.0 / 3.0 * heating * dt, 0.0), cooling, 2.0 * damping, dt)
    held = min(max(free, p.least), p.most)
    return held, held - free


@njit(cache=True, parallel=True, error_model="numpy")
def advance_all(p, s, heating, damping, shear_squared, divergence, dt, theta, held):
    """theta (N,) [m2/s2] of all particles after dt; held (N,) [m2/s2] is what the bounds changed."""
    for i in prange(len(s.x)):
        alpha_p = s.density[i] / p.grain_density
        theta[i], held[i] = advance(
            p, alpha_p, s.theta[i], heating[i], damping[i], s.diameter[i], shear_squared[i], divergence[i], dt
        )


def dt_limit(p, case, state) -> float:
    """theta spreads with h sqrt(theta) at most; where it is algebraic it does not spread."""
    return diffusive_limit(p.h, p.h * math.sqrt(state.theta.max(initial=0.0))) if p.model == 0 else NO_LIMIT


def call(scales) -> Judgement:
    """How much of theta is made or lost within the run; it acts by way of pressure and viscosity."""
    cooling = (
        granular.cooling_coefficient(scales.capped, scales.grains.restitution, scales.g0, scales.grains.diameter)
        if scales.alpha_p
        else 0.0
    )
    rate = cooling * math.sqrt(scales.theta) + 2.0 / scales.drag_time
    changed = -math.expm1(-rate * scales.end) if scales.speed and scales.collides else 0.0
    stiffness = 1.0 + 2.0 * (1.0 + scales.grains.restitution) * scales.alpha_p * scales.g0
    push = scales.theta * stiffness / scales.speed**2 if scales.speed else 0.0
    source = "Haff 1983; Lun et al. 1984"
    return Judgement(
        "run / decay time of theta", rate * scales.end if scales.speed else 0.0, 0.01, source, changed * min(1.0, push)
    )


EFFECT = Effect(
    name="granular_temperature",
    summary="granular temperature: production, diffusion, dissipation, damping by the gas",
    parameters=GranularTemperature,
    kernel=kernel,
    arrays=("theta", "diameter"),
    moves=True,
    dt_limit=dt_limit,
    call=call,
)
