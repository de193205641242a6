"""Particles of a liquid are shifted towards where they are few, so that they stay evenly spread.

Away from the free surface the shift follows the gradient of concentration; at the surface only its part along the
surface is kept. Where the pressure is negative, p_j - p_i takes the place of p_i + p_j (tensile instability control).
"""

from __future__ import annotations

import math
from typing import NamedTuple

from sdph.effects.around import tank
from sdph.effects.effect import Effect, Judgement
from sdph.engine import kernels as smoothing
from sdph.laws.compiled import serial
from sdph.schema import CaseError, choice, flag, quantity, record

CROWDING, POWER_OF = 0.2, 4  # R and n of the term that separates pairs, Monaghan 2000, J. Comput. Phys. 159, 290
INTERIOR = 0.75  # of the smallest eigenvalue of the renormalisation matrix, Sun et al. 2017
# of the answer, of vortices whose particles line up: all of it in taylor_green, 0.012 in square_patch; our choice
DISORDER = 0.3
FULL = 0.9  # share of its room that two phases fill, from which on they leave no free surface; our choice
DISORDER_OF_TWO = 0.03  # the same between two phases: 0.023 in bubble_rise, 0.012 in dam_break_gas; our choice
SPRAY = 0.4  # the same, Sun et al. 2017: below it a particle is not shifted


FORMS = ("concentration", "transport_velocity")


@record
class Shifting:
    """`tension_control` acts in a single phase; two phases have liquid.background_pressure_Pa against tension.

    transport_velocity: the shift by a background pressure rho c^2 times `strength`, for two phases that fill the space.
    """

    form: str = choice(*FORMS)
    # of the cited; with h = 1.5 dx 1 is too weak: Taylor-Green's vortices fall apart
    strength: float = quantity("", 3.0, above=0.0, most=1e3)
    tension_control: bool = flag(True)
    phases: str = choice("both", "gas")  # which are shifted


class ShiftingP(NamedTuple):
    """Displacement for a gradient of concentration of 1/m and a second [m2/s]; largest speed of a shift [m/s]; 1/W(dx);
    1 with tension control; 1 where the liquid is shifted too, 0 where the gas alone is."""

    strength: float
    largest: float
    inverse: float
    tension: float
    liquid: float


def kernel(case) -> ShiftingP:
    """-Ma CFL (2h)^2 sum ... V_j/2 a step, Sun et al. 2017, CMAME 315, 25, Eq. 8, as a speed: CFL h/c = dt, Ma c =
    v_max.

    transport_velocity: dt 2 p_b/rho sum V_j grad W of Adami, Hu & Adams 2013, J. Comput. Phys. 241, 292, Eq. 8, with
    the dt of the sound limit and p_b = strength rho c^2.
    """
    own, h = case.parameters["shifting"], case.smoothing_length
    if case.gas_phase is not None and (share := filled(case)) < FULL:
        given = f"pools fill {100.0 * share:.0f} % of the {'tank' if 'tank' in case.effects else 'domain'}"
        raise CaseError(
            f"shifting of two phases is for phases that fill their room, and {given}: the empty part would draw them "
            "up; leave shifting out of effects, or give the rest to a pool"
        )
    liquid = float(own.phases == "both")
    if not liquid and case.gas_phase is None:
        given = f"shifting.phases = {own.phases!r}, but the case has no [gas_phase]"
        raise CaseError(f"{given}; give it, or leave phases out")
    if own.form == "transport_velocity":
        return ShiftingP(
            2.0 * own.strength * case.liquid.courant * h * case.liquid.sound_speed,
            case.liquid.fastest,
            0.0,
            0.0,
            liquid,
        )
    kernel_ = smoothing.smoothing(case.liquid.kernel, case.dimensions, h)
    speed = case.liquid.fastest
    peak = smoothing.value.py_func(kernel_, case.resolution.spacing)
    return ShiftingP(
        own.strength * 2.0 * h * speed,
        0.5 * speed,
        1.0 / peak,
        float(own.tension_control and case.gas_phase is None),
        liquid,
    )


def filled(case) -> float:
    """Share of the tank, or of the domain, that pools of both phases fill; what overlaps counts twice."""
    d, given = case.dimensions, case.domain.size
    room = float(tank.shape_of(case).volume) if "tank" in case.effects else math.prod(given)
    round_ = math.pi * (4.0 / 3.0 if d == 3 else 1.0)
    total = 0.0
    for pool in case.pools.values():
        if pool.shape == "box":
            total += math.prod(b - a for a, b in zip(pool.lower, pool.upper))
        elif pool.shape != "tank":
            total += round_ * (pool.radius**d - (pool.inner_radius or 0.0) ** d)
    return total / room + max((pool.fill for pool in case.pools.values() if pool.shape == "tank"), default=0.0)


@serial
def weight(p, value):
    """1 + R (W/W(dx))^n; value = W_ij."""
    if len(p) == 0:
        return 0.0
    q = value * p.inverse
    return 1.0 + CROWDING * (q * q) * (q * q)


@serial
def sign(p, pressure, least):
    """Factor of p_i in p_j + p_i: -1 under tension inside the liquid, else 1."""
    if len(p) == 0:
        return 1.0
    return -1.0 if p.tension > 0.0 and pressure < 0.0 and least > INTERIOR else 1.0


def call(scales) -> Judgement:
    """Particles of a flow that turns over line up and part; gravity presses those of one phase together again, and
    along a channel they stay in line. Two phases that leave room have a free surface, which shifting does not see."""
    two = scales.case.gas_phase is not None
    held = filled(scales.case) < FULL if two else any(scales.pull) or scales.shaken
    strain = 0.0 if held else scales.turns
    error = (DISORDER_OF_TWO if two else DISORDER) * -math.expm1(-strain)
    return Judgement("U t/L, unless gravity holds", strain, 1.0, "Sun et al. 2017, CMAME 315, 25", error)


EFFECT = Effect(
    name="shifting",
    summary="particle shifting in a liquid",
    parameters=Shifting,
    kernel=kernel,
    arrays=("enclosure",),
    moves=True,
    matter=("liquid",),
    call=call,
)
