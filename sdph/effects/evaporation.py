"""Evaporation of droplets: how much vapour leaves a particle in a window, what it carries, what becomes of the grains.

Over a window the heat of evaporation L is held, so that heat exchange integrates in closed form (`exchange.py`). The
rate is that of the mean temperature in the window, from the linearised balance of heat with the gas as it is; grains
shrink exactly by their law (sdph.laws.grain_loss). So a window may be longer than a droplet lives.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit, prange

from sdph.effects import heat, sizes
from sdph.effects.effect import Effect, Judgement
from sdph.laws import evaporation as law
from sdph.laws import grain_loss
from sdph.laws.constants import GAS_CONSTANT
from sdph.particles import GRAIN
from sdph.schema import CaseError, choice, quantity, record, vector

LAWS = ("linear", "spalding")
ONSETS = ("latched", "paper")
SATURATIONS = ("constant", "antoine", "clausius_clapeyron")
ALWAYS = 1.0  # K, a threshold that every droplet is above
NEVER = 1e9  # K, a boiling temperature that none reaches
PROBE = 1e-3  # K, step of the slope of the rate with temperature
BOILING_MARGIN = 1e-3  # of the pressure: Spalding's ln(1 + B) has a pole at boiling and is evaluated at most this near; our choice
SOURCE = "d2 law: Spalding 1953; Ranz & Marshall 1952"
FINISHED = 1e-9  # of the mass at birth, below which a particle has evaporated; our choice
SHORT = 1e-8  # relaxation times in a window below which the mean rise is its limit


@record
class Evaporation:
    latent_heat: float = quantity("J_kg", least=0.0)
    law: str = choice(*LAWS)
    onset: str = choice(*ONSETS)  # "latched": once started it goes on below the onset (Fluent); "paper": above it only (Eq. 7)
    onset_temperature: float | None = quantity("K", None, above=0.0)  # none: at any temperature
    boiling_temperature: float | None = quantity("K", None, above=0.0)  # none: from the saturation law; a constant one never boils
    saturation: str = choice(*SATURATIONS)
    saturation_pressure: float | None = quantity("Pa", None, above=0.0)  # constant; or at saturation_temperature
    saturation_temperature: float | None = quantity("K", None, above=0.0)
    antoine: tuple | None = vector("", None, components=3)  # A, B, C of log10(p/Pa) = A - B/(C + T/K)


class EvaporationP(NamedTuple):
    """law, onset and saturation by their places; temperatures [K]; latent heat [J/kg]; vapour; gas; grains; feedback.

    first to fourth: the numbers of the saturation law, as sdph.laws.evaporation takes them.
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


def kernel(case) -> EvaporationP:
    own, gas, vapour, grains = case.parameters["evaporation"], case.gas, case.vapour, case.grains
    if vapour is None:
        raise CaseError("the effect evaporation needs [vapour]: molar_mass_kg_kmol, diffusivity_m2_s, ...; add it")
    if own.latent_heat > 0.0 and "heat" not in case.effects:
        raise CaseError("evaporation.latent_heat_J_kg is above 0, but no heat comes from the gas; add heat to effects, or set it to 0")
    p = _saturation(own, vapour)
    places = LAWS.index(own.law), ONSETS.index(own.onset), SATURATIONS.index(own.saturation)
    boiling = own.boiling_temperature or _boiling(own, p, gas.operating_pressure)
    return EvaporationP(
        *places, *p, own.onset_temperature or ALWAYS, boiling, own.latent_heat, vapour.molar_mass, vapour.diffusivity,
        gas.molar_mass, gas.viscosity, gas.operating_pressure, grains.density, grains.heat_capacity,
    )  # fmt: skip


def _saturation(own, vapour) -> tuple:
    """Four numbers for the saturation law that was chosen."""
    needs = {
        "constant": ("saturation_pressure",),
        "antoine": ("antoine",),
        "clausius_clapeyron": ("saturation_pressure", "saturation_temperature"),
    }[own.saturation]
    for name in needs:
        if getattr(own, name) is None:
            units = {"saturation_pressure": "_Pa", "saturation_temperature": "_K", "antoine": ""}
            raise CaseError(f"evaporation.{name}{units[name]} is missing; saturation = {own.saturation!r} needs it")
    if own.saturation == "antoine":
        return (*own.antoine, 0.0)
    if own.saturation == "constant":
        return own.saturation_pressure, 0.0, 0.0, 0.0
    return own.saturation_pressure, own.saturation_temperature, own.latent_heat, vapour.molar_mass


def _boiling(own, p, pressure: float) -> float:
    if own.saturation == "constant":
        return NEVER
    if own.saturation == "antoine":
        return p[1] / (p[0] - math.log10(pressure)) - p[2]
    return law.boiling_temperature(pressure, p)


@njit(cache=True, error_model="numpy")
def saturation_pressure(p, temperature):
    """p_sat [Pa]."""
    own = (p.first, p.second, p.third, p.fourth)
    if p.saturation == 0:
        return law.saturation_constant(temperature, own)
    if p.saturation == 1:
        return law.saturation_antoine(temperature, own)
    return law.saturation_clausius_clapeyron(temperature, own)


@njit(cache=True, error_model="numpy")
def driving_force(p, temperature, concentration, gas_temperature, gas_density):
    """Mass flux over k_c [kg/m3], negative where vapour would condense; concentration [kmol/m3] in the gas."""
    pressure = saturation_pressure(p, temperature)
    if p.law == 0:
        return p.molar_mass * (law.vapour_concentration(pressure, temperature) - concentration)
    surface = min(pressure / p.operating_pressure, 1.0 - BOILING_MARGIN)
    y_s = law.vapour_mass_fraction(surface, p.molar_mass, p.gas_molar_mass)
    mole_fraction = concentration * GAS_CONSTANT * gas_temperature / p.operating_pressure
    y_g = law.vapour_mass_fraction(mole_fraction, p.molar_mass, p.gas_molar_mass)
    return gas_density * math.log1p(law.spalding_number(y_s, y_g))


@njit(cache=True, error_model="numpy")
def ventilation(p, slip, gas_density):
    """c [m^-1/2] of sdph.laws.grain_loss."""
    schmidt = law.schmidt_number(gas_density, p.gas_viscosity, p.diffusivity)
    return grain_loss.ventilation(gas_density * slip / p.gas_viscosity, schmidt)


@njit(cache=True, error_model="numpy")
def transfer(p, sizes_p, s, i, c):
    """k_c A of all grains [m3/s]: flow of gas that they exchange. 6 k_c/d per volume of grains, k_c = Sh D/d (Eq. 11)."""
    total = whole = 0.0
    own = sizes.birth(sizes_p, s, i)
    for q in range(sizes.classes(sizes_p)):
        d, mass = sizes.grain(sizes_p, s, i, own, q)
        if mass == 0.0:  # gone; what comes after is smaller still
            break
        total += mass * 12.0 * (1.0 + c * math.sqrt(d)) * p.diffusivity / (d * d)
        whole += mass
    return s.mass[i] / p.grain_density * total / whole


@njit(cache=True, error_model="numpy")
def kept_share(sizes_p, s, i, still, moving):
    """Share of its mass that particle i keeps when `still` = integral of a dt [m2], `moving` of a c dt [m^3/2] are lost."""
    if still <= 0.0:
        return 1.0
    if len(sizes_p) == 0:
        square = s.diameter[i] ** 2
        return (grain_loss.square_after(square, still, moving / still) / square) ** 1.5
    before = sizes.remaining(sizes.birth(sizes_p, s, i))[0]
    lost = s.lost_still[i] + still, s.lost_moving[i] + moving
    return sizes.remaining(sizes.birth_of(s.born_diameter[i], s.born_variance[i], *lost))[0] / before


@njit(cache=True, error_model="numpy")
def mean_rise(power, conductance, capacity, dt):
    """Mean over dt [s] of the rise [K] of a body of `capacity` [J/K] heated with power - conductance * rise [W]."""
    if conductance * dt <= SHORT * capacity:
        return 0.5 * power * dt / capacity if capacity > 0.0 else 0.0
    x = conductance * dt / capacity
    return power / conductance * (1.0 + math.expm1(-x) / x)


@njit(cache=True, error_model="numpy")
def active_time(p, s, i, conductance, gas_temperature, dt):
    """Time [s] of the window in which particle i evaporates: from when it reaches the onset, as it warms up."""
    if s.temperature[i] >= p.onset_temperature or (p.onset == 0 and s.evaporating[i] > 0.0):
        return dt
    if gas_temperature <= p.onset_temperature or conductance == 0.0:
        return 0.0
    capacity = s.mass[i] * p.grain_heat_capacity
    missing = (gas_temperature - s.temperature[i]) / (gas_temperature - p.onset_temperature)
    return max(0.0, dt - capacity / conductance * math.log(missing))


@njit(cache=True, parallel=True, error_model="numpy")
def survey(p, heat_p, sizes_p, s, slip, gas_density, gas_temperature, dt, conductance, flow, surface):
    """Before the rates: heat conductance [W/K]; gas [m3/s] that the particle exchanges vapour with, averaged over the
    window, and vapour concentration at its surface [kmol/m3]."""
    for i in prange(len(s.x)):
        conductance[i] = flow[i] = surface[i] = 0.0
        if s.kind[i] == GRAIN:
            alpha_p = s.density[i] / p.grain_density
            conductance[i] = heat.conductance(heat_p, sizes_p, s, i, alpha_p, slip[i], gas_density[i])
            time = active_time(p, s, i, conductance[i], gas_temperature[i], dt)
            flow[i] = transfer(p, sizes_p, s, i, ventilation(p, slip[i], gas_density[i])) * time / dt
            surface[i] = law.vapour_concentration(saturation_pressure(p, s.temperature[i]), s.temperature[i])


@njit(cache=True, parallel=True, error_model="numpy")
def losses(p, sizes_p, s, slip, gas_density, gas_temperature, concentration, dt, conductance, loss, still, moving, refused):
    """Of each particle in dt: mass lost [kg]; its integrals of a dt [m2], a c dt [m^3/2]; condensation refused [kg].

    `conductance` becomes the mean over the window: it shrinks with the grains as evaporation does.
    """
    for i in prange(len(s.x)):
        loss[i] = still[i] = moving[i] = refused[i] = 0.0
        time = active_time(p, s, i, conductance[i], gas_temperature[i], dt) if s.kind[i] == GRAIN else 0.0
        if time > 0.0:
            c = ventilation(p, slip[i], gas_density[i])
            rate = transfer(p, sizes_p, s, i, c)
            force = window_force(p, sizes_p, s, i, rate, c, gas_density[i], gas_temperature[i], concentration[i], time, dt, conductance[i])
            refused[i] = max(0.0, -force) * rate * time
            still[i] = 8.0 * p.diffusivity * max(0.0, force) / p.grain_density * time  # d(d^2)/dt = -4 Sh D force/rho_p
            moving[i] = c * still[i]
            left = s.mass[i] * kept_share(sizes_p, s, i, still[i], moving[i])
            loss[i] = s.mass[i] - (left if left > FINISHED * s.born_mass[i] else 0.0)
            if force > 0.0:
                conductance[i] *= shrinkage(loss[i], rate * force * time)


@njit(cache=True, error_model="numpy")
def shrinkage(loss, unshrunk):
    """Mean over the window of the grains' exchange over that at its start: what was lost over what the start would lose."""
    return min(1.0, loss / unshrunk)


@njit(cache=True, error_model="numpy")
def window_force(p, sizes_p, s, i, rate, c, gas_density, gas_temperature, concentration, time, dt, conductance):
    """Driving force [kg/m3] at the mean temperature of the window; at boiling what the heat that comes in evaporates."""
    temperature = s.temperature[i]
    now = driving_force(p, temperature, concentration, gas_temperature, gas_density)
    below = driving_force(p, temperature - PROBE, concentration, gas_temperature, gas_density)
    slope = max(0.0, (now - below) / PROBE)
    still = 8.0 * p.diffusivity * max(0.0, now) / p.grain_density * time
    kept = kept_share(sizes_p, s, i, still, c * still)
    share = shrinkage(s.mass[i] * (1.0 - kept), rate * now * time) if now > 0.0 else 1.0
    capacity = s.mass[i] * kept * p.grain_heat_capacity
    latent = p.latent_heat * rate * share * time / dt  # W per unit of force
    warmth = conductance * share
    rise = mean_rise(warmth * (gas_temperature - temperature) - latent * max(0.0, now), warmth + latent * slope, capacity, dt)
    force = now + slope * rise
    return max(force, boiling_force(p, temperature, gas_temperature, warmth, capacity, latent, force, dt))


@njit(cache=True, error_model="numpy")
def boiling_force(p, temperature, gas_temperature, warmth, capacity, latent, force, dt):
    """Driving force [kg/m3] that holds the end of the window at the boiling temperature; `force` if it stays below."""
    if warmth == 0.0 or latent == 0.0 or gas_temperature <= p.boiling_temperature:
        return force
    fraction = -math.expm1(-warmth * dt / capacity)
    cooling = latent * max(0.0, force) / warmth
    end = temperature + (gas_temperature - temperature - cooling) * fraction
    if end <= p.boiling_temperature:
        return force
    return warmth / latent * (gas_temperature - temperature - (p.boiling_temperature - temperature) / fraction)


@njit(cache=True, parallel=True, error_model="numpy")
def shrink(p, sizes_p, s, still, moving, latched, diameter, variance):
    """What the sizes of each particle are after its loss: latch, mean [m] and variance [m2] of the diameters left."""
    for i in prange(len(s.x)):
        latched[i] = max(s.evaporating[i], 1.0 * (still[i] > 0.0))
        if still[i] > 0.0:
            if len(sizes_p) == 0:
                square = grain_loss.square_after(s.diameter[i] ** 2, still[i], moving[i] / still[i])
                diameter[i], variance[i] = math.sqrt(square), 0.0
            else:
                lost = s.lost_still[i] + still[i], s.lost_moving[i] + moving[i]
                left = sizes.remaining(sizes.birth_of(s.born_diameter[i], s.born_variance[i], *lost))
                diameter[i], variance[i] = left[1], left[2]
        else:
            diameter[i], variance[i] = s.diameter[i], s.diameter_variance[i]


def apply(p, sizes_p, s, loss, still, moving) -> None:
    """Take the losses from the state."""
    latched, diameter, variance = (np.empty(len(s.x)) for _ in range(3))
    shrink(p, sizes_p, s, still, moving, latched, diameter, variance)
    s.mass[:] -= loss
    s.lost_still[:] += still
    s.lost_moving[:] += moving
    s.evaporating[:], s.diameter[:], s.diameter_variance[:] = latched, diameter, variance


def at_surface(s) -> float:
    """Density of the vapour [kg/m3] at the coldest droplets."""
    p, coldest = kernel(s.case), min(patch.temperature for patch in s.patches)
    return p.molar_mass * law.vapour_concentration(saturation_pressure(p, coldest), coldest)


def shrinking(s, surface: float) -> tuple[float, float]:
    """Sherwood number, and the run over the time in which a droplet evaporates (d2 law)."""
    diffusivity = s.case.vapour.diffusivity
    sherwood = law.sherwood_ranz_marshall(s.reynolds, law.schmidt_number(s.gas.density, s.gas.viscosity, diffusivity))
    return sherwood, 4.0 * sherwood * diffusivity * surface / s.grains.density * s.end / s.grains.diameter**2


def call(scales) -> Judgement:
    """Share of the mass that evaporates within the run (d2 law), of the heat that evaporation takes, and of the vapour that the
    gas among the droplets can take up, the largest."""
    case, s = scales.case, scales
    if case.vapour is None or not s.patches:
        return Judgement("K t/d2", 0.0, 0.01, SOURCE, 0.0)
    p, surface = kernel(case), at_surface(s)
    sherwood, spent = shrinking(s, surface)
    warmth = s.nusselt * s.gas.conductivity * s.span
    cooling = sherwood * p.diffusivity * surface * p.latent_heat / warmth if warmth else 0.0
    filling = 6.0 * s.alpha_p / (1.0 - s.alpha_p) * sherwood * p.diffusivity / s.grains.diameter**2  # 1/s
    filled = 0.0 if case.coupling.one_way else -math.expm1(-filling * s.end)
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
    sources=("alpha_g", "vapour", "vapour_momentum", "vapour_enthalpy"),
    call=call,
)  # fmt: skip
