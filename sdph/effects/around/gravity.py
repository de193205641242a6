"""Gravity, `domain.gravity_m_s2`."""

from __future__ import annotations

from typing import NamedTuple

from sdph.effects.effect import Effect, Judgement
from sdph.laws.compiled import serial
from sdph.schema import record


@record
class Gravity:
    """Has no input of its own."""


class GravityP(NamedTuple):
    """Components [m/s2]; the last 0 in two dimensions."""

    x: float
    y: float
    z: float


def kernel(case) -> GravityP:
    return GravityP(*(*case.domain.gravity, 0.0)[:3])


@serial
def acceleration(p):
    if len(p) == 0:
        return 0.0, 0.0, 0.0
    return p.x, p.y, p.z


def call(scales) -> Judgement:
    """Way of free fall within the run over that way and that of jet or throw, g t^2/2 and U t: of the inverse Froude
    number."""
    fall, other = 0.5 * scales.gravity * scales.end, max(scales.jet, scales.thrown)
    share = fall / (fall + other) if fall else 0.0
    return Judgement("g t/(g t + 2 U), of the Froude number", share, 0.01, "Froude number of the run", share)


EFFECT = Effect(
    name="gravity",
    summary="gravity",
    parameters=Gravity,
    kernel=kernel,
    moves=True,
    matter=("grains", "liquid", "solid"),
    call=call,
)
