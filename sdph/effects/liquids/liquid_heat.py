"""Heat in a liquid and in bodies in it: conduction, a constant power on the rim or inside, and vapour that takes it.

Between two particles of any matter the conductivity is 2 k_i k_j/(k_i + k_j): the flux through a face between unlike
ones is continuous (Cleary & Monaghan 1999, J. Comput. Phys. 148, 227). No heat goes through an open side or a tank.
"""

from __future__ import annotations

from typing import NamedTuple

from sdph.effects.effect import Effect, Judgement, diffusive_limit
from sdph.schema import CaseError, choice, quantity, record


@record
class LiquidHeat:
    """Heat of liquid and bodies, and the power that comes in: flux times the outermost face at the start."""

    conductivity: float = quantity("W_m_K", above=0.0)
    heat_capacity: float = quantity("J_kg_K", above=0.0)
    body_conductivity: float | None = quantity("W_m_K", None, above=0.0)  # None: that of the liquid
    body_heat_capacity: float | None = quantity("J_kg_K", None, above=0.0)  # the same
    temperature: float | None = quantity("K", None, above=0.0)  # at the start; None: that of the bubble
    flux: float = quantity("W_m2", 0.0, least=0.0)
    heated: str = choice("rim", "inside")  # the outermost circle alone, or all by their heat capacity


class LiquidHeatP(NamedTuple):
    """k [W/m/K] and c [J/kg/K] of the liquid, then of bodies; T at the start [K], 0: of the bubble; flux [W/m2]; 1:
    inside."""

    conductivity: float
    heat_capacity: float
    body_conductivity: float
    body_heat_capacity: float
    temperature: float
    flux: float
    inside: int


def kernel(case) -> LiquidHeatP:
    own = case.parameters["liquid_heat"]
    _check(case, own)
    return LiquidHeatP(
        own.conductivity, own.heat_capacity, own.body_conductivity or own.conductivity,
        own.body_heat_capacity or own.heat_capacity, own.temperature or 0.0, own.flux, int(own.heated == "inside"),
    )  # fmt: skip


def _check(case, own: LiquidHeat) -> None:
    """CaseError for what has no heat: it would be left out in silence."""
    given = {
        "dimensions = 3": case.dimensions == 3, "[gas_phase]": case.gas_phase is not None,
        "liquid.periodic": case.liquid is not None and any(case.liquid.periodic or ()),
    } | {f"the effect {name}": name in case.effects for name in ("inflow", "outflow", "drain")}  # fmt: skip
    if here := [name for name, found in given.items() if found]:
        raise CaseError(
            f"the case has {' and '.join(here)}, but liquid_heat is of one liquid in two dimensions that nothing comes "
            "to or leaves, without periodic sides; leave one out"
        )
    boils = "bubble" in case.effects and case.parameters["bubble"].content == "vapour"
    if own.temperature is None and not boils:
        raise CaseError("liquid_heat.temperature_K is missing; only a bubble of vapour has another one: give it")
    rings = [body for body in case.bodies.values() if body.shape == "ring"]
    round_ones = [pool for pool in case.pools.values() if pool.shape in ("disc", "ring")]
    if own.flux and not rings and (len(round_ones) != 1 or len(case.pools) != 1):
        raise CaseError(
            f"liquid_heat.flux_W_m2 = {own.flux:g} goes through the rim of a body that is a ring, or of one pool that "
            "is a disc or a ring, alone in the case; give one of these, or leave it out"
        )


def longest(p: LiquidHeatP, h: float, density: float, body_density: float) -> float:
    """Longest step [s] of time as it is: 0.125 h^2 over the larger diffusivity; steps of motion are cut to it."""
    ratios = p.conductivity / (density * p.heat_capacity), p.body_conductivity / (body_density * p.body_heat_capacity)
    return diffusive_limit(h, max(ratios))


def call(scales) -> Judgement:
    """Power that comes in: what is heated stays as it is without the effect."""
    heated = 1.0 if scales.case.parameters["liquid_heat"].flux > 0.0 else 0.0
    return Judgement("heat that comes in (1: some)", heated, 1.0, "by definition: nothing else brings heat", heated)


EFFECT = Effect(
    name="liquid_heat",
    summary="heat in a liquid and in bodies in it",
    parameters=LiquidHeat,
    kernel=kernel,
    arrays=("temperature",),
    matter=("liquid",),
    call=call,
)
