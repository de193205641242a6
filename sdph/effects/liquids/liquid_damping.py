"""Artificial viscosity of a liquid: alpha c h, or with a limiter the dissipation of a Riemann solver."""

from __future__ import annotations

import math
from typing import NamedTuple

from sdph.effects.effect import NO_LIMIT, Effect, Judgement
from sdph.laws.compiled import serial
from sdph.laws.constants import SOFTENING
from sdph.schema import choice, quantity, record

MODELS = ("linear", "riemann")
# of h/(alpha c): waves on a lattice decay at up to 2.2 times its inverse, so that no step turns them round; our choice
# (tests/effects/liquids/test_liquid_damping.py)
STEP = 0.45
LIMITER = 3.0  # eta of Zhang, Hu & Adams 2017, J. Comput. Phys. 335, 605, Eq. 18


@record
class LiquidDamping:
    model: str = choice(*MODELS)
    alpha: float = quantity("", 0.02, least=0.0, most=1e3)  # Marrone et al. 2011; of `linear` alone


class LinearP(NamedTuple):
    """alpha h c rho_0 [Pa s], eta^2 [m2]."""

    strength: float
    softening: float


class RiemannP(NamedTuple):
    """rho_0 [kg/m3], c_0 [m/s], LIMITER."""

    density: float
    sound: float
    limiter: float


def kernel(case) -> LinearP | RiemannP:
    own, liquid = case.parameters["liquid_damping"], case.liquid
    if own.model == "riemann":
        return RiemannP(liquid.density, liquid.sound_speed, LIMITER)
    return LinearP(
        own.alpha * case.smoothing_length * liquid.sound_speed * liquid.density, SOFTENING * case.smoothing_length**2
    )


def dt_limit(p, case, state) -> float:
    """Step limit [s] of the linear form, of a light particle among heavy ones: they pull at it by the harmonic mean of
    their densities; Riemann's solver is bounded by sound."""
    if isinstance(p, RiemannP) or not p.strength:
        return NO_LIMIT
    own = [phase.density for phase in (case.liquid, case.gas_phase) if phase]
    among = 2.0 * max(own) / (max(own) + min(own))  # sdph.methods.liquids.phases.harmonic, over the lighter density
    return STEP * case.smoothing_length**2 * case.liquid.density / (among * p.strength)


@serial
def pair(p, closing, r2, inverse_r):
    """Pressure [Pa] added to p_i + p_j of a pair; closing = v_ij.r_ij [m2/s].

    linear: -alpha h c rho_0 v.r/r^2, pi_ij of Marrone et al. 2011, CMAME 200, 1526, Eq. 2, on approach and on parting.
    riemann: rho beta (U_R - U_L), beta = min(eta max(U_L - U_R, 0), c): Zhang, Hu & Adams 2017, Eq. 16-18; P* is the
    mean of both, so that twice its dissipation is added.
    """
    if len(p) == 0:
        return 0.0
    if len(p) == 2:
        return -p.strength * closing / (r2 + p.softening)
    speed = -closing * inverse_r
    return p.density * min(p.limiter * max(speed, 0.0), p.sound) * speed


# of the answer, where nothing damps single particles: 0.003 to 0.12 in three scenes, validation/<scene>/cost.csv; our
# choice
SCATTER = 0.02


def call(scales) -> Judgement:
    """Reynolds number of the spacing of particles: above 1 viscosity does not hold them together. Walls and free fall
    drive them."""
    h, driven = scales.case.smoothing_length, scales.pull[0] + scales.shaken
    cell = scales.speed * h / scales.viscosity if scales.viscosity else math.inf
    return Judgement(
        "U h/nu, of the particles",
        cell if driven else 0.0,
        1.0,
        "Monaghan 1992",
        SCATTER if driven and cell > 1.0 else 0.0,
    )


EFFECT = Effect(
    name="liquid_damping",
    summary="artificial viscosity of a liquid (linear, or of a Riemann solver)",
    parameters=LiquidDamping,
    kernel=kernel,
    moves=True,
    dt_limit=dt_limit,
    matter=("liquid",),
    call=call,
)
