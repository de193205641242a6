"""Evaporation of droplets: the vapour that a droplet's surface has, and what drives it off. What a window takes from
each particle follows in `sdph.exchange.droplets`."""

from __future__ import annotations

import math
from typing import NamedTuple

from sdph.effects.effect import Effect, Judgement
from sdph.effects.gas import film
from sdph.engine.ledger import Column
from sdph.laws import evaporation as law
from sdph.laws import grain_loss
from sdph.laws.compiled import serial
from sdph.schema import CaseError, choice, quantity, record, vector

LAWS = ("linear", "spalding")
LINEAR_FILM = len(LAWS)  # "linear" with both concentrations at the temperature of the film (coupling.film)
ONSETS = ("latched", "paper")
SATURATIONS = ("constant", "antoine", "clausius_clapeyron")
ALWAYS = 1.0  # K, a threshold that every droplet is above
NEVER = 1e9  # K, a boiling temperature that none reaches
# of the pressure: Spalding's ln(1 + B) has a pole at boiling and is evaluated at most this near; our choice
BOILING_MARGIN = 1e-3
SOURCE = "d2 law: Spalding 1953; Ranz & Marshall 1952"


@record
class Evaporation:
    latent_heat: float = quantity("J_kg", least=0.0)
    # that a fluid's is taken at (sdph.case.fluids); none: it is given
    latent_heat_temperature: float | None = quantity("K", None, above=0.0)
    law: str = choice(*LAWS)
    # "latched": once started it goes on below the onset (Fluent); "paper": above it only (Eq. 7)
    onset: str = choice(*ONSETS)
    onset_temperature: float | None = quantity("K", None, above=0.0)  # none: at any temperature
    # none: from the saturation law; a constant one never boils
    boiling_temperature: float | None = quantity("K", None, above=0.0)
    saturation: str = choice(*SATURATIONS)
    saturation_pressure: float | None = quantity("Pa", None, above=0.0)  # constant; or at saturation_temperature
    saturation_temperature: float | None = quantity("K", None, above=0.0)
    antoine: tuple | None = vector("", None, components=3)  # A, B, C of log10(p/Pa) = A - B/(C + T/K)


class EvaporationP(NamedTuple):
    """law, onset and saturation by their places; temperatures [K]; latent heat [J/kg]; vapour; gas; grains; feedback.

    first to fourth: the numbers of the saturation law, as sdph.laws.evaporation takes them. blowing: heat capacity
    [J/(kg K)] of the vapour that heat has to get past, 0 where the law has no Stefan flow.
    """

    law: int
    onset: int
    saturation: int
    first: float
    second: float
    third: float
    fourth: float
    onset_temperature: float
    boiling_temperature: float
    latent_heat: float
    molar_mass: float
    diffusivity: float
    gas_molar_mass: float
    gas_viscosity: float
    operating_pressure: float
    grain_density: float
    grain_heat_capacity: float
    blowing: float


def kernel(case) -> EvaporationP:
    own, gas, vapour, grains = case.parameters["evaporation"], case.gas, case.vapour, case.grains
    if vapour is None:
        raise CaseError("the effect evaporation needs [vapour]: molar_mass_kg_kmol, diffusivity_m2_s, ...; add it")
    if own.latent_heat > 0.0 and "heat" not in case.effects:
        raise CaseError(
            "evaporation.latent_heat_J_kg is above 0, but no heat comes from the gas; add heat to effects, or set it "
            "to 0"
        )
    p = _saturation(own, vapour)
    if case.coupling.film and own.law != "linear":
        raise CaseError(f"coupling.film: evaporation.law = {own.law!r} has no film; take 'linear'")
    chosen = LINEAR_FILM if case.coupling.film else LAWS.index(own.law)
    places = chosen, ONSETS.index(own.onset), SATURATIONS.index(own.saturation)
    boiling = own.boiling_temperature or _boiling(own, p, gas.operating_pressure)
    return EvaporationP(
        *places, *p, own.onset_temperature or ALWAYS, boiling, own.latent_heat, vapour.molar_mass, vapour.diffusivity,
        gas.molar_mass, gas.viscosity, gas.operating_pressure, grains.density, grains.heat_capacity,
        vapour.heat_capacity if own.law == "spalding" else 0.0,
    )  # fmt: skip


# saturation -> keys that it needs, and their units
NEEDS = {
    "constant": {"saturation_pressure": "_Pa"},
    "antoine": {"antoine": ""},
    "clausius_clapeyron": {"saturation_pressure": "_Pa", "saturation_temperature": "_K"},
}


def _saturation(own, vapour) -> tuple:
    """Four numbers for the saturation law that was chosen."""
    for name, unit in NEEDS[own.saturation].items():
        if getattr(own, name) is None:
            raise CaseError(f"evaporation.{name}{unit} is missing; saturation = {own.saturation!r} needs it")
    if own.saturation == "antoine":
        return (*own.antoine, 0.0)
    if own.saturation == "constant":
        return own.saturation_pressure, 0.0, 0.0, 0.0
    return own.saturation_pressure, own.saturation_temperature, own.latent_heat, vapour.molar_mass


def _boiling(own, p, pressure: float) -> float:
    if own.saturation == "constant":
        return NEVER
    if own.saturation == "antoine":
        return law.boiling_temperature_antoine(pressure, p)
    return law.boiling_temperature(pressure, p)


@serial
def saturation_pressure(p, temperature):
    """p_sat [Pa]."""
    own = (p.first, p.second, p.third, p.fourth)
    if p.saturation == 0:
        return law.saturation_constant(temperature, own)
    if p.saturation == 1:
        return law.saturation_antoine(temperature, own)
    return law.saturation_clausius_clapeyron(temperature, own)


@serial
def driving_force(p, temperature, concentration, gas_temperature, gas_density):
    """Mass flux over k_c [kg/m3], negative where vapour would condense; concentration [kmol/m3] in the gas."""
    pressure = saturation_pressure(p, temperature)
    if p.law == 0:
        return law.driving_force_linear(law.vapour_concentration(pressure, temperature), concentration, p.molar_mass)
    if p.law == LINEAR_FILM:
        around = film.temperature(gas_temperature, temperature)
        surface, gas = law.vapour_concentration(pressure, around), concentration * (gas_temperature / around)
        return law.driving_force_linear(surface, gas, p.molar_mass)
    surface = min(pressure / p.operating_pressure, 1.0 - BOILING_MARGIN)
    y_s = law.vapour_mass_fraction(surface, p.molar_mass, p.gas_molar_mass)
    mole_fraction = law.partial_pressure(concentration, gas_temperature) / p.operating_pressure
    y_g = law.vapour_mass_fraction(mole_fraction, p.molar_mass, p.gas_molar_mass)
    return law.driving_force_spalding(y_s, y_g, gas_density)


@serial
def saturated(p, temperature, gas_temperature):
    """Vapour [kmol/m3] in the gas at which a droplet gives no more; of Spalding's law that at its surface."""
    return law.vapour_concentration(
        saturation_pressure(p, temperature), gas_temperature if p.law == LINEAR_FILM else temperature
    )


@serial
def past_boiling(p, temperature):
    """True where the mole fraction of vapour at the surface is held below 1, short of the pole of Spalding's law."""
    return p.law == 1 and saturation_pressure(p, temperature) / p.operating_pressure > 1.0 - BOILING_MARGIN


@serial
def ventilation(p, slip, gas_density):
    """c [m^-1/2] of sdph.laws.grain_loss."""
    schmidt = law.schmidt_number(gas_density, p.gas_viscosity, p.diffusivity)
    return grain_loss.ventilation(gas_density * slip / p.gas_viscosity, schmidt)


def at_surface(s) -> float:
    """Density of the vapour [kg/m3] at the coldest droplets."""
    p, coldest = kernel(s.case), min(patch.temperature for patch in s.patches)
    return p.molar_mass * law.vapour_concentration(saturation_pressure(p, coldest), coldest)


def shrinking(s, surface: float) -> tuple[float, float]:
    """Sherwood number, and the run over the time in which a droplet evaporates (d2 law)."""
    diffusivity = s.case.vapour.diffusivity
    sherwood = law.sherwood_ranz_marshall(s.reynolds, law.schmidt_number(s.gas.density, s.gas.viscosity, diffusivity))
    rate = 0.5 * sherwood * law.regression_rate(surface, diffusivity, s.grains.density)
    return sherwood, rate * s.end / s.grains.diameter**2


def filling(s) -> tuple[float, float]:
    """Rate [1/s] at which the gas among the droplets fills with vapour, and the vapour that it takes, over its mass."""
    surface = at_surface(s)
    area = 6.0 * s.alpha_p / (1.0 - s.alpha_p) / s.grains.diameter**2  # over the volume of gas and the diameter
    return area * shrinking(s, surface)[0] * s.case.vapour.diffusivity, surface / s.gas.density


def to_gas(handed, case) -> dict:
    """Vapour, with the velocity and the temperature of its droplet; what torn droplets throw is among it."""
    rate = handed.loss.vapour / handed.dt
    return {
        "vapour": rate,
        "momentum": rate[:, None] * handed.velocity,
        "heat": case.vapour.heat_capacity / handed.dt * handed.loss.warmth(handed.temperature),
    }


def call(scales) -> Judgement:
    """Share of the mass that evaporates within the run (d2 law), of the heat that evaporation takes, and of the vapour
    that the gas among the droplets can take up, the largest."""
    case, s = scales.case, scales
    if case.vapour is None or not s.patches:
        return Judgement("K t/d2", 0.0, 0.01, SOURCE, 0.0)
    p, surface = kernel(case), at_surface(s)
    sherwood, spent = shrinking(s, surface)
    warmth = s.nusselt * s.gas.conductivity * s.span
    cooling = sherwood * p.diffusivity * surface * p.latent_heat / warmth if warmth else 0.0
    filled = 0.0 if case.coupling.one_way else -math.expm1(-filling(s)[0] * s.end)
    return Judgement("K t/d2", spent, 0.01, SOURCE, min(1.0, max(1.0 - max(0.0, 1.0 - spent) ** 1.5, cooling, filled)))


EFFECT = Effect(
    name="evaporation",
    summary="evaporation of droplets into the gas",
    parameters=Evaporation,
    kernel=kernel,
    arrays=(
        "temperature", "diameter", "diameter_variance", "evaporating",
        "born_mass", "born_diameter", "born_variance", "lost_still", "lost_moving",
    ),
    sources=("alpha_g", "vapour", "momentum", "heat"),
    to_gas=to_gas,
    columns=(
        Column("condensation_refused_kg"), Column("finished_kg"), Column("latent_heat_J", heat=-1),
        Column("capacity_heat_J", heat=-1),
    ),
    sums=("evaporated_kg", "condensation_refused_kg", "finished_kg", "latent_heat_J", "capacity_heat_J"),
    call=call,
)  # fmt: skip
