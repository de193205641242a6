"""Pressure of agitated grains, Lun et al. 1984: p_p = a rho theta + 2 rho (1+e) a^2 g0 theta."""

from __future__ import annotations

from typing import NamedTuple

from sdph.effects import limiter
from sdph.effects.effect import Effect, Judgement
from sdph.laws import granular
from sdph.laws.compiled import serial
from sdph.schema import record

SOURCE = "Elghobashi 1994: collisions matter where a grain meets others within the time looked at"


@record
class GranularPressure:
    """Has no input of its own: restitution and packing limit are those of the grains."""


class PressureP(NamedTuple):
    """Restitution [-], packing limit [-], grain density [kg/m3], 1 where compression heats the grains and 0 where theta
    stands."""

    restitution: float
    packing: float
    grain_density: float
    isentropic: float


def kernel(case) -> PressureP:
    isentropic = float("granular_temperature" in case.effects)
    return PressureP(case.grains.restitution, case.grains.packing_limit, case.grains.density, isentropic)


@serial
def pressure(p, alpha_p, theta, g0):
    """p_p [Pa]; the pole of g0 (sdph.laws.granular.crowding) is met at most PACKING_MARGIN below the packing limit."""
    if len(p) == 0:
        return 0.0
    return granular.lun_pressure(alpha_p, theta, p.restitution, g0, p.grain_density)


@serial
def sound_squared(p, alpha_p, theta, g0):
    """c^2 [m2/s2] of the agitated grains, their heating by compression included where theta follows it."""
    if len(p) == 0:
        return 0.0
    a = granular.capped_fraction(alpha_p, p.packing)
    slope = granular.crowding_slope(a, g0)
    if p.isentropic == 0.0:
        return granular.lun_pressure_slope(a, theta, p.restitution, g0, slope, p.grain_density) / p.grain_density
    return granular.sound_speed_squared(a, theta, p.restitution, g0, slope, p.grain_density, 0.0)


def held(p, method) -> dict[str, float]:
    """Share of the particles beyond the packing at which g0 is held."""
    return limiter.capped(p, method.state)


def call(scales) -> Judgement:
    """Collisions of a grain within the run; what they push with, over the momentum flux of the grains."""
    collisions = scales.end / scales.collision_time if scales.a_fluid and scales.speed else 0.0
    if not collisions:
        return Judgement("collisions of a grain in the run", 0.0, 1.0, SOURCE, 0.0)
    stiffness = 1.0 + 2.0 * (1.0 + scales.grains.restitution) * scales.alpha_p * scales.g0
    push = scales.theta * stiffness / scales.speed**2
    return Judgement("collisions of a grain in the run", collisions, 1.0, SOURCE, min(1.0, collisions) * min(1.0, push))


EFFECT = Effect(
    name="granular_pressure",
    summary="pressure of agitated grains (Lun)",
    parameters=GranularPressure,
    kernel=kernel,
    arrays=("theta", "diameter"),
    moves=True,
    held=held,
    call=call,
)
