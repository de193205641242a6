"""Viscosity of a Newtonian liquid, `liquid.viscosity_Pa_s`."""

from __future__ import annotations

import math
from typing import NamedTuple

from sdph.effects.effect import Effect, Judgement, diffusive_limit
from sdph.engine.state import LIQUID
from sdph.laws.compiled import serial
from sdph.laws.constants import TINY
from sdph.laws.exchange import harmonic_mean
from sdph.schema import record


@record
class LaminarViscosity:
    """Has no input of its own."""


class LaminarP(NamedTuple):
    """Twice the viscosity [Pa s]."""

    twice: float


class LaminarOfTwoP(NamedTuple):
    """2 (d + 2) times the viscosity [Pa s]: of the liquid, of the gas, and between both."""

    liquid: float
    gas: float
    between: float


def kernel(case) -> LaminarP | LaminarOfTwoP:
    mu = case.liquid.viscosity
    if case.gas_phase is None:
        return LaminarP(2.0 * mu)
    other = case.gas_phase.viscosity
    factor = 2.0 * (case.dimensions + 2.0)
    return LaminarOfTwoP(factor * mu, factor * other, factor * harmonic_mean(mu, other))


def dt_limit(p, case, state) -> float:
    phases = [case.liquid, case.gas_phase] if case.gas_phase else [case.liquid]
    nu = max(phase.viscosity / phase.density for phase in phases)
    # moving particles have no smoothing length: equations.rub bears 0.49 l0^2/nu
    return diffusive_limit(case.resolution.spacing if case.incompressible else case.smoothing_length, nu)


@serial
def pair(p, s, i, j):
    """Over V_j (dW/dr)/r v_ij/rho_i: 2 mu [Pa s]; of a wall j is i. Morris, Fox & Zhu 1997, Eq. 22; of equal densities
    the form of Lo & Shao 2002, Appl. Ocean Res. 24, 275, which the sloshing paper takes (Eq. 8).

    Without their eta^2 in r^2 + eta^2: (dW/dr)/r is finite at r = 0, and eta = 0.1 h takes 2 % off the viscosity.
    """
    if len(p) == 1:
        return p.twice
    if len(p) > 3:  # viscosities of their own (shear_thinning): the harmonic mean
        return 4.0 * s.viscosity[i] * s.viscosity[j] / (s.viscosity[i] + s.viscosity[j])
    return 0.0


@serial
def central(p, s, i, j, kind_i, kind_j, closing, r2):
    """Pressure [Pa] added to p_i + p_j of a pair of two phases; closing = v_ij.r_ij [m2/s]. Of a wall j is i, what it
    takes over.

    2 (d + 2) mu v.r/r^2 sums up to div mu (grad v + grad v^T) also where mu jumps, of which Morris' form has the first
    half alone: a bubble would slip through the liquid too easily. Monaghan 2005, Rep. Prog. Phys. 68, 1703, section 4;
    between phases the harmonic mean of mu: Hu & Adams 2006, J. Comput. Phys. 213, 844, Eq. 20.
    """
    if len(p) != 3:
        return 0.0
    strength = (p.liquid if kind_i == LIQUID else p.gas) if kind_i == kind_j else p.between
    return -strength * closing / (r2 + TINY)


def call(scales) -> Judgement:
    """Decay of the largest vortex within the run, nu (2 pi/L)^2 t; where there are walls, at least their layer's
    share."""
    if "shear_thinning" in scales.case.effects:  # takes its place
        return Judgement("nu (2 pi/L)^2 t", 0.0, 0.01, "shear_thinning", 0.0)
    decay = scales.viscosity * scales.end * (2.0 * math.pi / scales.length) ** 2
    own = scales.case.parameters.get("tank") if "tank" in scales.case.effects else None
    share = scales.layer if own and own.slip == "no_slip" else 0.0
    error = max(-math.expm1(-decay), min(1.0, share))
    return Judgement("nu (2 pi/L)^2 t", decay, 0.01, "Landau & Lifshitz, Fluid Mechanics, section 24", error)


EFFECT = Effect(
    name="laminar_viscosity",
    summary="viscosity of a liquid (Morris)",
    parameters=LaminarViscosity,
    kernel=kernel,
    moves=True,
    matter=("liquid",),
    dt_limit=dt_limit,
    call=call,
)
