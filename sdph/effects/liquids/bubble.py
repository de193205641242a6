"""A bubble in a liquid as a cavity without inside: a gas, or saturated vapour that boils off its wall.

Gas: p = p_0 (A_0/A)^kappa. Vapour: mass m in a void A is saturated, rho_v(p_sat(T), T) = m/A, and a heat flux q on the
wall, of a length S, boils L dm = q S dt - m c_sat dT. The liquid's own pressure is over that around, so that
p - p_around - sigma/R presses on the wall (gel-droplet.md, section 2).
"""

from __future__ import annotations

import math
from typing import NamedTuple

from sdph.effects.effect import Effect, Judgement
from sdph.effects.gas import gel
from sdph.laws.real_gas import Vapour
from sdph.schema import CaseError, choice, quantity, record, vector

STEADY = 0.1  # of 1/w of the bubble in the liquid: longest step; our choice


@record
class Bubble(gel.Fuel):
    """The hole of a pool that is a ring; fuel as n-dodecane."""

    centre: tuple | None = vector("m", None)
    content: str = choice("gas", "vapour")
    around: float = quantity("Pa", 101325.0, above=0.0)  # pressure outside the liquid
    excess: float = quantity("Pa", 0.0)  # of a gas at the start, over what holds it
    exponent: float = quantity("", 1.4, least=1.0, most=2.0)  # kappa of a gas
    surface_tension: float = quantity("N_m", 0.0, least=0.0)
    flux: float = quantity("W_m2", 0.0, least=0.0)  # of heat on the wall of a vapour's bubble


class BubbleP(NamedTuple):
    """Pressure around and excess [Pa], kappa, sigma [N/m], q [W/m2], vapour (`()` of a gas)."""

    around: float
    excess: float
    exponent: float
    tension: float
    flux: float
    vapour: Vapour | tuple


def pool_of(case):
    """The pool around the bubble of a case."""
    own = case.parameters["bubble"]
    for pool in case.pools.values():
        if pool.shape == "ring" and own.centre is not None and tuple(pool.centre) == tuple(own.centre):
            return pool
    raise CaseError(f'bubble.centre_m = {own.centre}; it must be that of a pool of shape "ring", whose hole it is')


def kernel(case) -> BubbleP:
    own = case.parameters["bubble"]
    if case.dimensions != 2 or case.gas_phase:
        raise CaseError("a bubble is that of a liquid of one phase in two dimensions: leave it out of effects")
    pool_of(case)
    if own.content == "vapour":
        gel.refuse_above_critical(own, own.around, "bubble.around_Pa")
    vapour = gel.vapour(own) if own.content == "vapour" else ()
    return BubbleP(own.around, own.excess, own.exponent, own.surface_tension, own.flux, vapour)


def dt_limit(p: BubbleP, case, state) -> float:
    """Longest step [s]: a share of 1/w of the bubble as it was at the start, w^2 = 2 kappa p/(rho R^2)."""
    stiff = 2.0 * p.exponent * (p.around + abs(p.excess))
    return STEADY * pool_of(case).inner_radius * math.sqrt(case.liquid.density / stiff)


def call(scales) -> Judgement:
    """Holes of a pool that the section names: without the effect such a hole is empty and closes."""
    holes = 0 if scales.case.parameters["bubble"].centre is None else 1
    return Judgement("bubbles in the liquid", holes, 1, "by definition: nothing else holds a hole open", float(holes))


EFFECT = Effect(
    name="bubble",
    summary="a bubble of gas or of saturated vapour in a liquid",
    parameters=Bubble,
    kernel=kernel,
    moves=True,
    matter=("liquid",),
    dt_limit=dt_limit,
    call=call,
)
