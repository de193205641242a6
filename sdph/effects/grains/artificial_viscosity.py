"""Monaghan's artificial viscosity against ringing and interpenetration (paper section 4: 0.1 and 0.2)."""

from __future__ import annotations

from typing import NamedTuple

from sdph.effects import limiter
from sdph.effects.effect import NO_LIMIT, Effect, Judgement, found
from sdph.laws import viscosity
from sdph.laws.compiled import serial
from sdph.schema import quantity, record

# of h/(alpha c + beta mu): waves on a lattice decay at up to twice the inverse, so that no step turns them round; our
# choice (tests/effects/grains/test_artificial_viscosity.py)
STEP = 0.5


@record
class ArtificialViscosity:
    alpha: float = quantity("", 0.1, least=0.0, most=1e3)
    beta: float = quantity("", 0.2, least=0.0, most=1e3)


class ArtificialP(NamedTuple):
    alpha: float
    beta: float
    h: float  # m


def kernel(case) -> ArtificialP:
    own = case.parameters["artificial_viscosity"]
    return ArtificialP(own.alpha, own.beta, case.smoothing_length)


@serial
def pair(p, h, approach, r_squared, c_i, c_j, rho_i, rho_j):
    """Pi_ij [m5/(kg s2)]; approach = v_ij.r_ij [m2/s]."""
    if len(p) == 0:
        return 0.0
    return viscosity.monaghan(approach, r_squared, h, 0.5 * (c_i + c_j), 0.5 * (rho_i + rho_j), p.alpha, p.beta)


def dt_limit(p, case, state) -> float:
    """Sub-step limit [s] of grains whose pace, at least c + 2 v [m/s], is known."""
    pace = found(state, EFFECT.name)
    return STEP * p.h / (max(p.alpha, p.beta) * pace) if pace and (p.alpha or p.beta) else NO_LIMIT


def call(scales) -> Judgement:
    """Mach number of the grains: shocks and crossing particles from about 1 on; none where they are thin."""
    mach = scales.speed / scales.sound if scales.sound and scales.collides and not scales.thin else 0.0
    blur = scales.case.smoothing_length / scales.length  # what it does, it does over h
    return Judgement(
        "speed / sound of the grains", mach, 1.0, "Monaghan 1992, section 4", min(1.0, mach) * min(1.0, blur)
    )


EFFECT = Effect(
    name="artificial_viscosity",
    summary="Monaghan's artificial viscosity",
    parameters=ArtificialViscosity,
    kernel=kernel,
    moves=True,
    dt_limit=dt_limit,
    held=limiter.softened,
    call=call,
)
