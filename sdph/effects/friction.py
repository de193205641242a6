"""Lasting contacts: Johnson-Jackson frictional pressure and Schaeffer's frictional viscosity."""

from __future__ import annotations

import math
from typing import NamedTuple

from numba import njit

from sdph.effects.effect import Effect, Judgement
from sdph.laws import constants, granular
from sdph.laws import friction as law
from sdph.schema import quantity, record

DIFFUSIVE = 0.125  # largest nu dt/h^2 of an explicit step, Morris et al. 1997 (sdph-notes, section 3)
NEAR = 0.95  # of the onset: grains that close get there when they settle; our choice


@record
class Friction:
    onset: float = quantity("", 0.60, above=0.0, most=1.0)  # alpha_p where contacts begin to last (sdph-notes, section 2)
    angle: float = quantity("deg", 28.5, least=0.0, most=60.0)  # OpenFOAM tutorials
    fr: float = quantity("Pa", constants.FRICTION_FR, least=0.0)  # Johnson & Jackson 1987, OpenFOAM tutorials


class FrictionP(NamedTuple):
    """Onset [-], packing limit [-], Fr [Pa], sine of the friction angle, grain density [kg/m3], h [m]."""

    onset: float
    packing: float
    fr: float
    sine: float
    grain_density: float
    h: float


def kernel(case) -> FrictionP:
    chosen = case.parameters["friction"]
    packing, density = case.grains.packing_limit, case.grains.density
    return FrictionP(chosen.onset, packing, chosen.fr, math.sin(chosen.angle), density, case.smoothing_length)


@njit(cache=True, error_model="numpy")
def pressure(p, alpha_p):
    """p_fr [Pa] and its slope [Pa]; goes on along its tangent past PACKING_MARGIN below the limit, where it has a pole."""
    if len(p) == 0:
        return 0.0, 0.0
    a = granular.capped_fraction(alpha_p, p.packing)
    slope = law.johnson_jackson_slope(a, p.onset, p.packing, p.fr, constants.FRICTION_ETA, constants.FRICTION_P)
    own = law.johnson_jackson_pressure(a, p.onset, p.packing, p.fr, constants.FRICTION_ETA, constants.FRICTION_P)
    return own + slope * (alpha_p - a), slope


@njit(cache=True, error_model="numpy")
def viscosity(p, frictional_pressure, density, shear_squared, dt):
    """mu_fr [Pa s], regularised so that at rest it is the largest that an explicit step of `dt` bears."""
    if len(p) == 0 or frictional_pressure == 0.0:
        return 0.0
    largest = DIFFUSIVE * p.h * p.h / dt * density
    least_rate = 0.5 * frictional_pressure * p.sine / largest
    return law.schaeffer_viscosity(frictional_pressure, p.sine, shear_squared, least_rate)


def call(scales) -> Judgement:
    """Whether grains lie closer than where contacts begin to last, and what presses them on each other: their weight on a
    wall, or the gas that holds up the foremost."""
    onset = scales.case.parameters["friction"].onset
    ratio = scales.alpha_p / onset
    fall = scales.gravity * scales.end
    weight = fall / (fall + scales.speed) if fall and scales.to_walls.over_gap >= 1.0 else 0.0
    held_up = scales.rim * -math.expm1(-scales.end / scales.drag_time) if scales.thrown else 0.0
    source = "Johnson & Jackson 1987: contacts last from the onset on; grains at 95 % of it get there"
    return Judgement("alpha_p / onset", ratio, NEAR, source, max(weight, held_up) if ratio >= NEAR else 0.0)


EFFECT = Effect(
    name="friction",
    summary="lasting contacts of grains (Johnson-Jackson pressure, Schaeffer viscosity)",
    parameters=Friction,
    kernel=kernel,
    arrays=("theta",),
    moves=True,
    call=call,
)
