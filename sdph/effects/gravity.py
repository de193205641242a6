"""Gravity, `domain.gravity_m_s2`."""

from __future__ import annotations

from typing import NamedTuple

from numba import njit

from sdph.effects.effect import Effect
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


@njit(cache=True, error_model="numpy")
def acceleration(p):
    if len(p) == 0:
        return 0.0, 0.0, 0.0
    return p.x, p.y, p.z


EFFECT = Effect(name="gravity", summary="gravity on the grains", parameters=Gravity, kernel=kernel, moves=True)
