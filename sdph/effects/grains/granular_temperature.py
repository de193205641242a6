"""Granular temperature: production, diffusion, dissipation and damping by the gas; or the algebraic equilibrium."""

from __future__ import annotations

import math
from typing import NamedTuple

from numba import prange

from sdph.effects import limiter
from sdph.effects.effect import NO_LIMIT, Effect, Judgement, diffusive_limit, found
from sdph.engine.state import by_material
from sdph.laws import granular
from sdph.laws.compiled import parallel, serial
from sdph.laws.exchange import harmonic_mean
from sdph.schema import choice, flag, quantity, record

MODELS = ("transport", "algebraic")
PART = 0.25  # of the decay time: steady theta is within PART^2/12 = 0.5 % of its balance; our choice
DISSIPATIONS = ("lun", "paper")  # alpha_p^2 as derived, or alpha_p^1 as printed


@record
class GranularTemperature:
    model: str = choice(*MODELS)
    dissipation: str = choice(*DISSIPATIONS)
    artificial_heating: bool = flag(False)  # heat of the artificial viscosity to theta, as in the paper; else to T
    # grains at rest are sheared into motion from it; 1e-5 m/s is far below any speed that is told; our choice
    least: float = quantity("m2_s2", 1e-10, above=0.0)
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


@serial
def conductivity(p, alpha_p, theta, diameter, g0):
    """k_theta [kg/m/s] (paper section 2.1) where grains crowd by g0 (sdph.laws.granular.crowding); the kinetic part by
    `granular.streaming_share` where they are few."""
    if len(p) == 0 or p.model == 1:
        return 0.0
    a = granular.capped_fraction(alpha_p, p.packing)
    e, rho = p.restitution, p.grain_density
    share = granular.streaming_share(a, e, g0, diameter, granular.STREAMING_AGITATION, p.h)
    return granular.gidaspow_conductivity(a, theta, e, g0, rho, diameter, share)


@serial
def diffusivity(p, k, density):
    """Diffusivity of theta [m2/s], from its conductivity [kg/m/s] and the density of the particle [kg/m3]."""
    if len(p) == 0:
        return 0.0
    return k / (1.5 * density)


@parallel
def largest(p, density, theta, diameter):
    """Largest diffusivity of theta [m2/s] of particles of `density` (N,) [kg/m3]."""
    most = 0.0
    for i in prange(len(density)):
        if density[i] > 0.0:
            alpha_p = density[i] / p.grain_density
            k = conductivity(p, alpha_p, theta[i], diameter[i], granular.crowding(alpha_p, p.packing))
            most = max(most, diffusivity(p, k, density[i]))
    return most


def held(p, method) -> dict[str, float]:
    """Shares of the particles whose theta is at its bounds and whose free path is at its limit, and the mean part of
    the kinetic conductivity that this takes away."""
    s = method.state
    found = {
        "theta_at_least_share": limiter.share(s, s.theta <= p.least),
        "theta_at_most_share": limiter.share(s, s.theta >= p.most),
    }
    factor = granular.STREAMING_AGITATION if p.model == 0 else 0.0
    return found | limiter.streaming(p, s, factor, "conductivity") | limiter.capped(p, s)


@serial
def pair(p, stress, s, i, j, squeeze_work, artificial_work, scale):
    """Rate of theta of i by the pair, per mass [W/kg]: work of agitation, and diffusion with the harmonic mean.

    scale = m_j (dW/dr)/r / (rho_i rho_j). The works [W/kg] are those of the whole pair; half goes to each. Where theta
    stands it is what would raise it.
    """
    made = 0.5 * squeeze_work
    if len(p) == 0:
        return made
    k_i, k_j = stress.conductivity[i], stress.conductivity[j]
    made += 0.5 * p.artificial * artificial_work
    return made + 2.0 * harmonic_mean(k_i, k_j) * (s.theta[i] - s.theta[j]) * scale


@serial
def fed(p, lost):
    """Share of what viscosity takes from the motion [W/kg] that feeds theta: all, where there is this effect."""
    return lost if len(p) else 0.0


@serial
def rest(p, artificial_work):
    """Share of the artificial viscosity's work that does not feed theta and heats the grains [W/kg]."""
    if len(p) == 0:
        return artificial_work
    return (1.0 - p.artificial) * artificial_work


@serial
def advance(p, alpha_p, theta, heating, damping, diameter, shear_squared, divergence, g0, dt):
    """theta after dt [m2/s2] by `heating` [W/kg], dissipation and damping = beta/(alpha_p rho_p) [1/s].

    Returns theta held within its bounds, by how much these changed it, and what went into collisions and into the gas
    [m2/s2].
    """
    if len(p) == 0:
        return theta, 0.0, 0.0, 0.0
    a = granular.capped_fraction(alpha_p, p.packing)
    if p.dissipation == 0:
        cooling = granular.cooling_coefficient(a, p.restitution, g0, diameter)
    else:
        cooling = granular.cooling_coefficient_paper(a, p.restitution, g0, diameter)
    damped, fed = granular.damping_rate(damping), 2.0 / 3.0 * heating * dt
    if p.model == 1:
        beta = damping * alpha_p * p.grain_density
        free = granular.equilibrium_theta(
            a, p.restitution, g0, p.grain_density, diameter, shear_squared, divergence, beta
        )
        begun = max(theta + fed, 0.0)
        mended = begun - (theta + fed)
        collided, gone = lost(begun, free, cooling, damped)
    else:
        free, mended, collided, gone = transported(theta, fed, cooling, damped, dt)
    held = min(max(free, p.least), p.most)
    return held, mended + held - free, collided, gone


@serial
def transported(theta, fed, cooling, damped, dt):
    """theta [m2/s2] after dt in which it is fed [m2/s2], cools and is damped; what was needed to keep it from below 0,
    and what went into collisions and into the gas.

    In parts of PART of its decay time: half of what it is fed, the exact decay, the other half (Strang 1968, SIAM J.
    Numer. Anal. 5, 506), so that it comes to where they balance however long the step is.
    """
    decays = (cooling * math.sqrt(theta + max(fed, 0.0)) + damped) * dt / PART
    parts = max(1, math.ceil(decays)) if math.isfinite(decays) else 1
    half, mended, collided, gone = 0.5 * fed / parts, 0.0, 0.0, 0.0
    for _ in range(parts):
        begun = max(theta + half, 0.0)
        decayed = granular.theta_step(begun, cooling, damped, dt / parts)
        mended += begun - (theta + half)
        theta = max(decayed + half, 0.0)
        mended += theta - (decayed + half)
        to_heat, to_gas = lost(begun, decayed, cooling, damped)
        collided += to_heat
        gone += to_gas
    return theta, mended, collided, gone


@serial
def lost(begun, decayed, cooling, damped):
    """Loss of theta to collisions and to the gas [m2/s2], shared by their rates at the mean of sqrt(theta)."""
    colliding = 0.5 * cooling * (math.sqrt(begun) + math.sqrt(decayed))
    share = damped / (damped + colliding) if damped > 0.0 else 0.0
    return (1.0 - share) * (begun - decayed), share * (begun - decayed)


@parallel
def advance_all(p, s, heating, damping, strain, crowd, dt, theta, held, collided, damped):
    """theta (N,) [m2/s2] of all particles after dt, strained as `sdph.methods.grains.equations.Scratch` tells, where
    they crowd by g0 = crowd (N,) [-]; by bounds, collisions and gas it lost or got the others (N,) [m2/s2]."""
    for i in prange(len(s.x)):
        rho = s.grain_density[i] if len(s.grain_density) else p.grain_density
        theta[i], held[i], collided[i], damped[i] = advance(
            p, s.density[i] / rho, s.theta[i], heating[i], damping[i], s.diameter[i], strain[0, i], strain[1, i],
            crowd[i], dt,
        )  # fmt: skip


def dt_limit(p, case, state) -> float:
    """Sub-step limit [s] by diffusion of theta; none where theta is algebraic."""
    if p.model == 1:
        return NO_LIMIT
    most = found(state, EFFECT.name)
    if most is None:
        density = state.density * (p.grain_density / by_material(state.grain_density, p.grain_density))
        most = largest(p, density, state.theta, state.diameter)
    return diffusive_limit(p.h, most)


def call(scales) -> Judgement:
    """Time of the run over the decay time of theta, which acts by way of pressure and viscosity."""
    cooling = (
        granular.cooling_coefficient(scales.capped, scales.grains.restitution, scales.g0, scales.grains.diameter)
        if scales.alpha_p
        else 0.0
    )
    rate = cooling * math.sqrt(scales.theta) + granular.damping_rate(1.0 / scales.drag_time)
    changed = -math.expm1(-rate * scales.end) if scales.speed and scales.a_fluid else 0.0
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
    held=held,
    call=call,
)
