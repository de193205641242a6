"""Burn-off of grains: a reaction of first order between their solid and one species of the gas, that of [vapour].

For each kilogram of solid `oxidant_ratio` kilograms of that species leave the gas, and all of both comes back as
products, which are of the carrier, the rest of the gas. What a window takes follows in `sdph.exchange.burning`, the
diameters in `sdph.laws.burn_off`. The heat goes to the grains, at whose surface it is set free, but for `gas_share`:
where part of it burns in the gas around (CO to CO2), that part is the gas's.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from sdph.effects.effect import NO_LIMIT, Effect, Judgement
from sdph.effects.gas import sizes
from sdph.engine.ledger import Column
from sdph.laws import burn_off as law
from sdph.laws import evaporation, grain_loss
from sdph.laws.compiled import serial
from sdph.laws.constants import TINY
from sdph.schema import CaseError, flag, quantity, record

# effects that it does not go with, and why
STRANGE = {"evaporation": "[vapour] is one species, given off or used up", "break_up": "grains that burn are solid"}
PART = 0.1  # of k_s, most that it changes by in a window; our choice
SPENT, SOURCE = "run / burn-out time", "Levenspiel 1999, ch. 25"


@record
class Reaction:
    oxidant_ratio: float = quantity("", above=0.0)  # kg of the gas's species for each kg of solid
    rate: float = quantity("m_s", above=0.0)  # k_0
    activation_temperature: float = quantity("K", 0.0, least=0.0)
    heat: float = quantity("J_kg")  # set free for each kg of solid, at the temperature of the grain
    gas_share: float = quantity("", 0.0, least=0.0, most=1.0)  # of that heat
    film: bool = flag(True)  # the gas around a grain hinders too, by Ranz & Marshall's number


class ReactionP(NamedTuple):
    """Oxidant ratio [-], k_0 [m/s], T_a [K], film 1.0 or 0.0; diffusivity [m2/s]; gas viscosity [Pa s]; density of
    grains [kg/m3]. Heat [J/kg] to grains, and to the gas; heat capacities [J/(kg K)] of grains, carrier, oxidant."""

    ratio: float
    rate: float
    activation_temperature: float
    film: float
    diffusivity: float
    gas_viscosity: float
    grain_density: float
    heat_to_grains: float
    heat_to_gas: float
    grain_heat_capacity: float
    carrier_heat_capacity: float
    oxidant_heat_capacity: float

    @property
    def carried(self) -> float:
        """Enthalpy [J/(kg K)] that a kilogram of solid brings to the gas by its products, less that of the oxidant."""
        return (1.0 + self.ratio) * self.carrier_heat_capacity - self.ratio * self.oxidant_heat_capacity


def kernel(case) -> ReactionP:
    own, gas, vapour, grains = case.parameters["reaction"], case.gas, case.vapour, case.grains
    _refuse(case, own)
    return ReactionP(
        own.oxidant_ratio, own.rate, own.activation_temperature, float(own.film), vapour.diffusivity, gas.viscosity,
        grains.density, (1.0 - own.gas_share) * own.heat, own.gas_share * own.heat, grains.heat_capacity,
        gas.heat_capacity, vapour.heat_capacity,
    )  # fmt: skip


def _refuse(case, own: Reaction) -> None:
    """`CaseError` where the case lacks what a reaction needs, or has what it does not go with."""
    if case.vapour is None:
        raise CaseError("the effect reaction needs [vapour], its oxidant: mass_fraction, diffusivity_m2_s, ...; add it")
    for name, why in STRANGE.items():
        if name in case.effects:
            raise CaseError(f"effects holds reaction and {name}: {why}; leave one of the two out")
    if own.heat and "heat" not in case.effects:
        given = f"reaction.heat_J_kg is {own.heat:g}"
        raise CaseError(f"{given}, but grains give no heat to the gas; add heat to effects, or set it to 0")
    if case.coupling.film:
        raise CaseError(
            "coupling.film takes no part in reaction, whose film has the gas's own diffusivity; set it false"
        )


@serial
def surface(p, temperature):
    """Length l [m] by which the surface is slow, D/k_s; temperature [K] of the grain."""
    return p.diffusivity / law.surface_velocity(p.rate, p.activation_temperature, temperature)


@serial
def stripped(p, sizes_p, s, i, kinetic, c):
    """k A of all grains [m3/s] of particle i: gas that they strip of its oxidant, by mass over their sizes; kinetic l
    [m], c [m^-1/2]."""
    total = whole = 0.0
    own = sizes.birth(sizes_p, s, i)
    for q in range(sizes.classes(sizes_p)):
        d, mass = sizes.grain(sizes_p, s, i, own, q)
        if mass == 0.0:  # gone; what comes after is smaller still
            break
        total += law.gas_stripped(mass, d, kinetic, c, p.diffusivity, p.film)
        whole += mass
    return s.mass[i] / p.grain_density * total / whole


@serial
def remaining(p, sizes_p, s, i, still, moving, slow):
    """Share of its mass that particle i keeps, number mean [m] and variance [m2] of the diameters left, when the
    integrals over a window of a dt [m2], a c dt [m^(3/2)] and a l dt [m3] are lost."""
    if len(sizes_p) == 0:
        d = law.diameter_after(s.diameter[i], still, slow / still, moving / still, p.film)
        return (d / s.diameter[i]) ** 3, d, 0.0
    before = sizes.remaining(sizes.birth(sizes_p, s, i))[0]
    lost = s.lost_still[i] + still, s.lost_moving[i] + moving, s.lost_kinetic[i] + slow
    born = sizes.birth_of_burnt(s.born_diameter[i], s.born_variance[i], *lost, p.film)
    mass, mean, variance = sizes.remaining(born)
    return mass / before, mean, variance


def richest(case) -> float:
    """Largest mass fraction of the oxidant that the case gives: at its start, or by what comes in."""
    return max(case.vapour.mass_fraction, *(b.vapour_mass_fraction or 0.0 for b in case.boundaries.values()), 0.0)


def rise(case) -> float:
    """Most [K] that the reaction warms gas or grains beyond what the case gives: all oxidant burnt in its own gas, or
    grains that give their heat off through the film through which the oxidant comes; 0 where it is off."""
    if "reaction" not in case.effects or case.vapour is None:
        return 0.0
    own, gas = case.parameters["reaction"], case.gas
    through_film = case.vapour.diffusivity * gas.density / gas.conductivity
    return abs(own.heat) / own.oxidant_ratio * richest(case) * max(1.0 / gas.heat_capacity, through_film)


def window_limit(p, case, state) -> float:
    """Time [s] in which the grain whose reaction runs away fastest, or dies out, changes its k_s by PART, by the
    warming of the last window: the exchange holds k_s over a window."""
    sensitive = p.activation_temperature * np.abs(state.warming)
    if not sensitive.any():
        return NO_LIMIT
    return PART * float((state.temperature**2 / np.maximum(sensitive, TINY)).min())


def blown(s, p, slip: float) -> float:
    """c [m^-1/2] of grains past which gas flows at `slip` [m/s]."""
    schmidt = evaporation.schmidt_number(s.gas.density, s.gas.viscosity, p.diffusivity)
    return grain_loss.ventilation(s.gas.density * slip / s.gas.viscosity, schmidt)


def stripping(s, temperature: float, slip: float) -> float:
    """Rate [1/s] at which grains of `temperature` [K], past which gas flows at `slip` [m/s], strip it of its oxidant
    where they are densest."""
    p = kernel(s.case)
    c = blown(s, p, slip)
    of_grains = law.gas_stripped(s.alpha_p, s.grains.diameter, surface(p, temperature), c, p.diffusivity, p.film)
    return of_grains / (1.0 - s.alpha_p)


def spent(s, temperature: float) -> float:
    """Run over the time in which a grain of `temperature` [K] burns out in the richest gas of the case."""
    p, d = kernel(s.case), s.grains.diameter
    c = blown(s, p, s.slip)
    fall = evaporation.regression_rate(s.gas.density * richest(s.case) / p.ratio, p.diffusivity, p.grain_density)
    return fall * s.end / law.scale(d, surface(p, temperature), c, p.film)


def call(scales) -> Judgement:
    """Share of the grains that burns within the run, at the hottest temperature of the case."""
    if scales.case.vapour is None or not scales.patches:
        return Judgement(SPENT, 0.0, 0.01, SOURCE, 0.0)
    number = spent(scales, max(scales.case.temperatures))
    return Judgement(SPENT, number, 0.01, SOURCE, -math.expm1(3.0 * math.log1p(-number)) if number < 1.0 else 1.0)


EFFECT = Effect(
    name="reaction",
    summary="burn-off of grains by a species of the gas, a reaction of first order",
    parameters=Reaction,
    kernel=kernel,
    arrays=(
        "temperature", "begun_temperature", "warming", "diameter", "diameter_variance", "born_mass", "born_diameter",
        "born_variance", "lost_still", "lost_moving", "lost_kinetic",
    ),
    sources=("alpha_g", "vapour", "carrier", "momentum", "heat"),
    window_limit=window_limit,
    columns=(Column("reaction_heat_J", heat=1),),
    sums=("reacted_kg", "finished_kg", "reaction_heat_J", "capacity_heat_J"),
    call=call,
)  # fmt: skip
