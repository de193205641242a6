"""Bubbles in a liquid, each a cavity without inside: a gas, or saturated vapour that boils off its wall.

Gas: p = p_0 (A_0/A)^kappa. Vapour: mass m in a void A is saturated, rho_v(p_sat(T), T) = m/A, and a heat flux q on the
wall, of a length S, boils L dm = q S dt - m c_sat dT. The liquid's own pressure is over that around, so that
p - p_around - sigma/R presses on the wall (gel-droplet.md, section 2).
"""

from __future__ import annotations

import math
from typing import NamedTuple

from sdph.effects.effect import Effect, Judgement
from sdph.effects.gas import gel
from sdph.laws.constants import ROUND_OFF
from sdph.laws.real_gas import Vapour
from sdph.schema import CaseError, choice, quantity, record, vector

SMALLEST = 2.0  # spacings: radius of a hole that a kernel sees; our choice
STEADY = 0.1  # of 1/w of the bubble in the liquid: longest step; our choice


@record
class Bubble(gel.Fuel):
    """The hole of a pool that is a ring (`centre`), or holes of a disc (`centres`, `radii`); fuel as n-dodecane."""

    centre: tuple | None = vector("m", None)
    centres: tuple = vector("m", ())  # [[x, y], ...]: of one hole or several in a pool of shape "disc"
    radii: tuple = vector("m", ())  # as many
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


class Hole(NamedTuple):
    """Centre and radius [m] of a bubble at the start."""

    centre: tuple
    radius: float


def pool_of(case):
    """The pool around the bubbles of a case, its only one: all liquid is taken to be around them."""
    own = case.parameters["bubble"]
    if len(case.pools) > 1:
        raise CaseError(f"bubbles are in a case of one pool; pools hold {', '.join(case.pools)}: leave the others out")
    if own.centres or own.radii:
        return _disc_of(case, own)
    if own.centre is None:
        raise CaseError(
            'no bubbles: give bubble.centre_m, that of a pool of shape "ring", or bubble.centres_m and radii_m in discs'
        )
    for pool in case.pools.values():
        if pool.shape == "ring" and tuple(pool.centre) == tuple(own.centre):
            return pool
    raise CaseError(f'bubble.centre_m = {own.centre}; it must be that of a pool of shape "ring", whose hole it is')


def _disc_of(case, own):
    if own.centre is not None:
        raise CaseError("bubble.centre_m and bubble.centres_m: give one of them")
    discs = [pool for pool in case.pools.values() if pool.shape == "disc"]
    if not discs:
        raise CaseError('bubble.centres_m: they are of one pool of shape "disc", and there is none')
    return discs[0]


def holes_of(case) -> list[Hole]:
    """Bubbles of a case at the start."""
    own, pool = case.parameters["bubble"], pool_of(case)
    if not own.centres and not own.radii:
        return [Hole(tuple(pool.centre), pool.inner_radius)]
    if len(own.centres) != len(own.radii) or any(not isinstance(c, tuple) or len(c) != 2 for c in own.centres):
        given = f"bubble.centres_m = {list(own.centres)}, radii_m = {list(own.radii)}"
        raise CaseError(f"{given}; give one centre [x, y] and one radius for each bubble")
    found = [Hole(centre, radius) for centre, radius in zip(own.centres, own.radii)]
    for number, hole in enumerate(found):
        _check_hole(case, pool, found[:number], hole)
    return found


def _check_hole(case, pool, before: list[Hole], hole: Hole) -> None:
    """CaseError of a hole too small for the particles, not in the pool, or in one before it."""
    told, spacing = f"a bubble of radius {hole.radius:g} m at {list(hole.centre)}", case.resolution.spacing
    if not hole.radius >= SMALLEST * spacing:
        raise CaseError(f"{told} is below {SMALLEST:g} resolution.spacing_mm: enlarge it or give a finer spacing")
    if math.dist(hole.centre, pool.centre) + hole.radius + spacing > pool.radius * (1.0 + ROUND_OFF):
        raise CaseError(f"{told} is not a spacing within the pool (bubble.centres_m, radii_m): move it or shrink it")
    for other in before:
        if math.dist(hole.centre, other.centre) < (hole.radius + other.radius) * (1.0 - ROUND_OFF):
            raise CaseError(f"{told} overlaps the one at {list(other.centre)}: give one bubble, or move them apart")


def check_shell(case) -> None:
    """CaseError of a pool that goes through the shell around its bubbles; both have their lengths."""
    pool = pool_of(case)
    rings = {name: body for name, body in case.bodies.items() if body.shape == "ring"}
    for name, body in rings.items():
        apart = math.dist(pool.centre, body.centre)
        reach = apart + pool.radius
        if apart < body.radius and reach > body.radius * (1.0 + ROUND_OFF):
            raise CaseError(
                f"the pool around the bubbles reaches {reach:g} m from the middle of bodies.{name}, whose radius_m is "
                f"{body.radius:g}: liquid would stand outside its shell; give it the shell's inner_radius_m, "
                f"{body.inner_radius:g}, as its radius_m"
            )


def kernel(case) -> BubbleP:
    own = case.parameters["bubble"]
    if case.dimensions != 2 or case.gas_phase:
        raise CaseError("a bubble is that of a liquid of one phase in two dimensions: leave it out of effects")
    if moving := [name for name in ("inflow", "outflow", "drain") if name in case.effects]:
        raise CaseError(
            f"effects holds bubble and {moving[0]}: a bubble is what the liquid of the start leaves free, and nothing "
            "may come to that or leave; leave one of the two out"
        )
    holes_of(case)
    boils = own.content == "vapour"
    if own.excess if boils else own.flux:
        given, of = ("excess_Pa", "gas") if boils else ("flux_W_m2", "vapour")
        raise CaseError(f'bubble.{given} is of a bubble of {of}, and bubble.content = "{own.content}"; leave it out')
    if boils:
        gel.refuse_above_critical(own, own.around, "bubble.around_Pa")
    vapour = gel.vapour(own) if boils else ()
    return BubbleP(own.around, own.excess, own.exponent, own.surface_tension, own.flux, vapour)


def dt_limit(p: BubbleP, case, state) -> float:
    """Longest step [s]: a share of 1/w of the smallest bubble as it was at the start, w^2 = 2 kappa p/(rho R^2)."""
    stiff = 2.0 * p.exponent * (p.around + abs(p.excess))
    return STEADY * min(hole.radius for hole in holes_of(case)) * math.sqrt(case.liquid.density / stiff)


def call(scales) -> Judgement:
    """Holes of a pool that the section names: without the effect such a hole is empty and closes."""
    own = scales.case.parameters["bubble"]
    holes = len(own.radii) if own.centre is None else 1
    return Judgement("bubbles in the liquid", holes, 1, "by definition: nothing else holds a hole open", float(holes))


EFFECT = Effect(
    name="bubble",
    summary="bubbles of gas or of saturated vapour in a liquid",
    parameters=Bubble,
    kernel=kernel,
    moves=True,
    matter=("liquid",),
    dt_limit=dt_limit,
    call=call,
)
