"""Collisional, kinetic and bulk viscosity of agitated grains, Gidaspow 1994 and Lun et al. 1984 (paper section 2.1)."""

from __future__ import annotations

import math
from typing import NamedTuple

from numba import prange

from sdph.effects import limiter
from sdph.effects.effect import Effect, Judgement, diffusive_limit, found
from sdph.engine.state import by_material
from sdph.laws import granular
from sdph.laws.compiled import parallel, serial
from sdph.schema import record

SOURCE = "diffusion of momentum, Gidaspow 1994 viscosity"


@record
class GranularViscosity:
    """Has no input of its own."""


class ViscosityP(NamedTuple):
    """Restitution [-], packing limit [-], grain density [kg/m3], smoothing length [m]; 1 where there is a theta that it
    feeds, else 0."""

    restitution: float
    packing: float
    grain_density: float
    h: float
    feeds: float


def kernel(case) -> ViscosityP:
    grains, feeds = case.grains, float("granular_temperature" in case.effects)
    return ViscosityP(grains.restitution, grains.packing_limit, grains.density, case.smoothing_length, feeds)


@serial
def viscosities(p, alpha_p, theta, diameter, g0):
    """Total shear and bulk viscosity [Pa s] where grains crowd by g0 (sdph.laws.granular.crowding); the kinetic part by
    `granular.streaming_share` where they are few."""
    if len(p) == 0:
        return 0.0, 0.0
    a = granular.capped_fraction(alpha_p, p.packing)
    e, rho = p.restitution, p.grain_density
    share = granular.streaming_share(a, e, g0, diameter, granular.STREAMING_MOMENTUM, p.h)
    shear = granular.gidaspow_viscosity(a, theta, e, g0, rho, diameter, share)
    return shear, granular.lun_bulk_viscosity(a, theta, e, g0, rho, diameter)


@serial
def fed(p, lost):
    """Part of what viscosity takes from the motion [W/kg] that feeds theta: all, where there is one; the rest heats."""
    return p.feeds * lost if len(p) else 0.0


@serial
def diffusivity(p, shear, bulk, density):
    """Diffusivity of momentum [m2/s], that of sound: 4/3 mu + lambda over the density [kg/m3]."""
    if len(p) == 0:
        return 0.0
    return (4.0 / 3.0 * shear + bulk) / density


@parallel
def largest(p, density, theta, diameter):
    """Largest diffusivity of momentum [m2/s] of particles of `density` (N,) [kg/m3]."""
    most = 0.0
    for i in prange(len(density)):
        if density[i] > 0.0:
            alpha_p = density[i] / p.grain_density
            shear, bulk = viscosities(p, alpha_p, theta[i], diameter[i], granular.crowding(alpha_p, p.packing))
            most = max(most, diffusivity(p, shear, bulk, density[i]))
    return most


def held(p, method) -> dict[str, float]:
    """Shares of the particles whose free path is at its limit, with the mean part of the kinetic viscosity that this
    takes away, and of those that neighbours do not enclose."""
    s, found = method.state, limiter.unenclosed(method)
    return found | limiter.streaming(p, s, granular.STREAMING_MOMENTUM, "viscosity") | limiter.capped(p, s)


def dt_limit(p, case, state) -> float:
    """Sub-step limit [s] by the largest viscosity."""
    most = found(state, EFFECT.name)
    if most is None:
        density = state.density * (p.grain_density / by_material(state.grain_density, p.grain_density))
        most = largest(p, density, state.theta, state.diameter)
    return diffusive_limit(p.h, most)


def call(scales) -> Judgement:
    """Reach of momentum by viscosity within the run over the width of the shear, squared."""
    if not scales.a_fluid or not scales.speed:
        return Judgement("nu t/L2", 0.0, 0.01, SOURCE, 0.0)
    grains = scales.grains
    mu = granular.gidaspow_viscosity(
        scales.capped, scales.theta, grains.restitution, scales.g0, grains.density, grains.diameter
    )
    spread = mu / (scales.alpha_p * grains.density) * scales.end / scales.shear_length**2
    return Judgement("nu t/L2", spread, 0.01, SOURCE, -math.expm1(-spread))


EFFECT = Effect(
    name="granular_viscosity",
    summary="shear and bulk viscosity of agitated grains (Gidaspow, Lun)",
    parameters=GranularViscosity,
    kernel=kernel,
    arrays=("theta", "diameter"),
    moves=True,
    dt_limit=dt_limit,
    held=held,
    call=call,
)
