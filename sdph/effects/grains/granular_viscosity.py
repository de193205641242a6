"""Collisional, kinetic and bulk viscosity of agitated grains, Gidaspow 1994 and Lun et al. 1984 (paper section 2.1)."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from sdph.effects.effect import Effect, Judgement, diffusive_limit
from sdph.laws import granular, viscosity
from sdph.laws.constants import TINY
from sdph.schema import record

SOURCE = "diffusion of momentum, Gidaspow 1994 viscosity"


@record
class GranularViscosity:
    """Has no input of its own."""


class ViscosityP(NamedTuple):
    """Restitution [-], packing limit [-], grain density [kg/m3], smoothing length [m]."""

    restitution: float
    packing: float
    grain_density: float
    h: float


def kernel(case) -> ViscosityP:
    return ViscosityP(case.grains.restitution, case.grains.packing_limit, case.grains.density, case.smoothing_length)


class Viscous(NamedTuple):
    """On where any effect gives a viscosity."""

    dimensions: float


@njit(cache=True, error_model="numpy")
def harmonic(a, b):
    return 2.0 * a * b / max(a + b, TINY)


@njit(cache=True, error_model="numpy")
def viscosities(p, alpha_p, theta, diameter):
    """Total shear and bulk viscosity [Pa s].

    A free path longer than h is not seen: the kinematic viscosity is held at h sqrt(theta) (Knudsen limit, our
    choice), which Gidaspow's kinetic part passes where grains are few.
    """
    if len(p) == 0:
        return 0.0, 0.0
    a = granular.capped_fraction(alpha_p, p.packing)
    g0 = granular.sinclair_jackson(a, p.packing)
    shear = granular.gidaspow_viscosity(a, theta, p.restitution, g0, p.grain_density, diameter)
    most = alpha_p * p.grain_density * p.h * np.sqrt(theta)
    return min(shear, most), granular.lun_bulk_viscosity(a, theta, p.restitution, g0, p.grain_density, diameter)


@njit(cache=True, error_model="numpy")
def pair(viscous, stress, i, j, r_squared, closing, scale):
    """Viscous force per mass of i by j: `along` r_ij and `across`, along v_ij. Off where `viscous` is ().

    scale = m_j (dW/dr)/r / (rho_i rho_j); closing = v_ij.r_ij.
    """
    if len(viscous) == 0:
        return 0.0, 0.0
    mu, bulk = harmonic(stress.shear[i], stress.shear[j]), harmonic(stress.bulk[i], stress.bulk[j])
    return viscosity.espanol_revenga(viscous.dimensions, mu, bulk, r_squared, closing, scale)


def dt_limit(p, case, state) -> float:
    """The viscosity is at most h sqrt(theta)."""
    return diffusive_limit(p.h, p.h * math.sqrt(state.theta.max(initial=0.0)))


def call(scales) -> Judgement:
    """Reach of momentum by viscosity within the run over the width of the shear, squared."""
    if not scales.collides or not scales.speed:
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
    call=call,
)
