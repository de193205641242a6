"""Gel droplets of a spray that burst: a shell seals each, a bubble of vapour swells it, the shell tears.

Droplets of a particle are alike: one of its Sauter diameter stands for all. As long as its shell is whole nothing
evaporates. When the middle of the gel boils a bubble grows by the laws of `sdph.laws.gel_droplet`, with one layer of
shell; the heat to it follows from the gel's mean temperature (sdph.laws.bursting). A torn droplet becomes smaller ones,
and throws the vapour that its superheat boils (sdph.exchange.bursts).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import prange

from sdph.effects.effect import NO_LIMIT, Effect, Judgement
from sdph.effects.gas import gel
from sdph.engine.ledger import Column
from sdph.engine.state import GRAIN
from sdph.laws import bursting, cavities, gel_droplet, real_gas, shells, strength, swelling
from sdph.laws.compiled import parallel, serial
from sdph.schema import CaseError, quantity, record

SHELL = ("shell_flow", "shell_hard", "shell_harm", "shell_swell")
SPOT = ("spot_flow", "spot_hard", "spot_harm", "spot_swell")
RATE = 1.0  # 1/s, of strain, for the pressure that a shell bears in `call`: ten times as fast adds 17 %
PART = 0.05  # of the time from the first bubble to the tear, most that a window takes; our choice
NOTHING_TORN = {"torn_droplets": 0.0, "made_droplets": 0.0}  # ledger columns
SOURCE = "gel-droplet.md; Qiang et al. 2017"


@record
class MicroExplosion(gel.Shell):
    """Shell of `gel.Shell`, and what a droplet has in it. Fuel: that of [vapour] and [evaporation], critical
    point of n-dodecane.

    Shell and first bubble are a share of the diameter, as those of Qiang et al. 2017. What a tear throws off is not
    known: `thrown_share` has no default.
    """

    shell_ratio: float = quantity("", 0.05, above=0.0, most=0.4)
    bubble_ratio: float = quantity("", 0.3, above=0.0, most=0.9)
    thrown_share: float = quantity("", least=0.0, most=1.0)  # of the liquid, which becomes small droplets
    fragment_ratio: float | None = quantity("", None, above=0.0, most=1.0)  # small droplet over droplet; none: by film
    critical_temperature: float = quantity("K", 658.1, above=0.0)
    critical_pressure: float = quantity("Pa", 1.817e6, above=0.0)
    acentric_factor: float = quantity("", 0.574, least=-1.0, most=2.0)
    saturated_heat_capacity: float = quantity("J_kg_K", 2000.0, above=0.0)


class Own(NamedTuple):
    """Ratios of shell, bubble, flaw, thrown liquid and small droplets (0: by film); gel: density, heat capacity,
    conductivity; what boils: latent heat, boiling temperature. SI."""

    shell: float
    bubble: float
    flaw: float
    thrown: float
    fragment: float
    density: float
    heat_capacity: float
    conductivity: float
    latent_heat: float
    boiling: float


class MicroExplosionP(NamedTuple):
    """Ratios and gel; vapour (sdph.laws.real_gas), shell (sdph.laws.strength), surroundings (sdph.laws.gel_droplet)."""

    own: Own
    vapour: real_gas.Vapour
    plastic: strength.Plastic
    damage: strength.Damage
    around: gel_droplet.Around


def kernel(case) -> MicroExplosionP:
    own, grains, pressure = case.parameters["micro_explosion"], case.grains, case.gas.operating_pressure
    _refuse(case, own)
    fuel = fuel_of(case)
    gel.refuse_above_critical(fuel, pressure, "gas.operating_pressure_Pa")
    vapour = gel.vapour(fuel)
    ratios = own.shell_ratio, own.bubble_ratio, own.flaw, own.thrown_share, own.fragment_ratio or 0.0
    material = grains.density, grains.heat_capacity, grains.conductivity, fuel.latent_heat
    around = gel_droplet.Around(swelling.SPHERE, pressure, grains.surface_tension, *gel.moduli(own))
    boiling = real_gas.saturation_temperature(vapour, pressure)
    made = MicroExplosionP(Own(*ratios, *material, boiling), vapour, gel.plastic(own), gel.damage(own), around)
    gel.refuse_above_critical(fuel, tearing_pressure(made), "gas.operating_pressure_Pa with what the shell bears")
    return made


def fuel_of(case) -> gel.Fuel:
    """The fuel that boils in a droplet is the one that evaporates from it."""
    own, boils = case.parameters["micro_explosion"], case.parameters["evaporation"]
    critical = {name: getattr(own, name) for name in ("critical_temperature", "critical_pressure", "acentric_factor")}
    return gel.Fuel(
        molar_mass=case.vapour.molar_mass, antoine=boils.antoine, latent_heat=boils.latent_heat,
        saturated_heat_capacity=own.saturated_heat_capacity, **critical,
    )  # fmt: skip


def _refuse(case, own: MicroExplosion) -> None:
    """`CaseError` where the case lacks what a bubble needs."""
    for name in ("heat", "evaporation"):
        if name not in case.effects:
            raise CaseError(f"micro_explosion: no droplet boils without {name}; add it to effects")
    if "break_up" in case.effects:
        raise CaseError(
            "micro_explosion: how gas breaks a droplet in a shell is not known; leave break_up out of effects"
        )
    boils = case.parameters["evaporation"]
    if boils.saturation != "antoine" or boils.latent_heat == 0.0:
        given = f"evaporation.saturation = {boils.saturation!r}, latent_heat_J_kg = {boils.latent_heat:g}"
        raise CaseError(f"micro_explosion: {given}; a bubble needs 'antoine' and a heat above 0")
    if case.grains.surface_tension is None:
        raise CaseError("micro_explosion: grains.surface_tension_N_m is missing; a bubble has one: give it")
    inside = (1.0 + own.bubble_ratio**swelling.SPHERE) ** (1.0 / swelling.SPHERE) - 2.0 * own.shell_ratio
    if not own.bubble_ratio < inside:
        given = f"micro_explosion.bubble_ratio = {own.bubble_ratio:g}"
        raise CaseError(f"{given}; inside the shell there is {inside:.3g} of the diameter: less bubble or less shell")


@parallel
def advance(own, vapour, plastic, damage, around, s, dt, torn, made):
    """All through dt [s] of the heat that came to them in it: droplets that tear (N,) and droplets made of them (N,).

    `temperature` is that of the window's end as if no bubble took heat.
    """
    for i in prange(len(s.x)):
        torn[i] = made[i] = 0.0
        if s.kind[i] == GRAIN and s.sealed[i] > 0.0 and s.throwing[i] == 0.0:
            wall = grow(own, vapour, plastic, damage, around, s, i, dt)
            if wall > 0.0:
                torn[i], made[i] = tear(own, around.tension, s, i, wall)


@serial
def tear(own, tension, s, i, wall):
    """Turn the droplets of particle i, whose walls [m] tear, into smaller ones; their number, and how many more there
    are. What their bubbles hold becomes superheat."""
    mean, variance = s.diameter[i], s.diameter_variance[i]
    size = bursting.sauter(mean, variance)
    number = s.mass[i] / (own.density * math.pi / 6.0 * bursting.raw_moments(mean, variance)[1])
    ratio = own.fragment if own.fragment > 0.0 else bursting.film_droplet(wall) / size
    more, mean, variance = bursting.torn_sizes(mean, variance, own.thrown, ratio)
    s.diameter[i] = s.born_diameter[i] = mean
    s.diameter_variance[i] = s.born_variance[i] = variance
    s.temperature[i] += s.bubble_heat[i] / (s.mass[i] * own.heat_capacity)
    s.bubble_heat[i] = s.bubble_void[i] = 0.0
    s.throwing[i] = bursting.opening_time(0.5 * size, wall, tension, own.density)
    return number, number * (more - 1.0)


@serial
def grow(own, v, plastic, damage, around, s, i, dt):
    """Grow the bubbles of particle i through dt [s]; the wall of its droplets [m] where they tear, else 0."""
    diameter = bursting.sauter(s.diameter[i], s.diameter_variance[i])
    gel = own.density, own.heat_capacity, own.conductivity
    d = swelling.droplet(v, around, own.bubble, own.shell, diameter, *gel, own.flaw)
    number = s.mass[i] * own.heat_capacity / d.capacity
    power = s.warming[i] * d.capacity
    left = begin(v, around, s, i, d, power, dt) if s.bubble_void[i] == 0.0 else dt
    if left == 0.0:
        return 0.0
    shell, spot = np.empty((4, 1)), np.empty(4)
    take_up(s, i, shell, spot)
    void, now = s.bubble_void[i], s.bubble_temperature[i]
    bubble = gel_droplet.Bubble(real_gas.saturated_density(v, now) * void, void, now)
    there = swelling.Swollen(bubble, s.temperature[i] - power * left / d.capacity, 0.0, s.spot_hoop[i])
    there, wall = swelling.swell(d, v, plastic, damage, around, power, there, left, shell, spot)
    put_back(s, i, shell, spot)
    taken = there.taken * number if there.bubble.void > 0.0 else -s.bubble_heat[i]  # one that is gone gives all back
    s.temperature[i] -= taken / (s.mass[i] * own.heat_capacity)
    s.bubble_heat[i] += taken
    s.bubble_void[i], s.bubble_temperature[i], s.spot_hoop[i] = there.bubble.void, there.bubble.temperature, there.hoop
    return wall


@serial
def begin(v, around, s, i, d, power, dt):
    """Time [s] that is left of dt when the middle of the gel boils, which makes the first bubble; 0 if it does not."""
    boiling = swelling.nucleus(v, around, d.first)
    warming, _ = bursting.lags(d.first, d.outer, d.conductivity)
    beyond = s.temperature[i] - power * warming - boiling
    if beyond <= 0.0:
        return 0.0
    s.bubble_void[i], s.bubble_temperature[i] = cavities.void(d.first, swelling.SPHERE), boiling
    return min(dt, d.capacity * beyond / power) if power > 0.0 else dt


@serial
def take_up(s, i, shell, spot):
    """Rows of shell (4, 1) and spot (4,) of particle i, in the order of `sdph.laws.shells`."""
    shell[shells.FLOW, 0], spot[shells.FLOW] = s.shell_flow[i], s.spot_flow[i]
    shell[shells.HARD, 0], spot[shells.HARD] = s.shell_hard[i], s.spot_hard[i]
    shell[shells.HARM, 0], spot[shells.HARM] = s.shell_harm[i], s.spot_harm[i]
    shell[shells.SWELL, 0], spot[shells.SWELL] = s.shell_swell[i], s.spot_swell[i]


@serial
def put_back(s, i, shell, spot):
    """The reverse of `take_up`."""
    s.shell_flow[i], s.spot_flow[i] = shell[shells.FLOW, 0], spot[shells.FLOW]
    s.shell_hard[i], s.spot_hard[i] = shell[shells.HARD, 0], spot[shells.HARD]
    s.shell_harm[i], s.spot_harm[i] = shell[shells.HARM, 0], spot[shells.HARM]
    s.shell_swell[i], s.spot_swell[i] = shell[shells.SWELL, 0], spot[shells.SWELL]


def swollen(p, state, dt) -> dict[str, float]:
    """Grow the bubbles of the particles through a window of dt [s]; ledger columns of what tears: droplets, and
    droplets made of them."""
    torn, made = np.empty(len(state.x)), np.empty(len(state.x))
    advance(*p, state, dt, torn, made)
    return {"torn_droplets": float(torn.sum()), "made_droplets": float(made.sum())}


def window_limit(p, case, state) -> float:
    """A part of the time in which a bubble grows to the tear, by the heat of now, and as long again as a droplet takes
    to boil; no limit where none warms."""
    warms = (state.sealed > 0.0) & (state.warming > 0.0)
    if not warms.any():
        return NO_LIMIT
    first, *_ = swelling.radii(p.own.bubble, p.own.shell, float(state.diameter[warms].min()))
    curved = cavities.capillary_pressure(p.around.tension, first, swelling.SPHERE)
    torn = real_gas.saturation_temperature(p.vapour, tearing_pressure(p) + curved)
    boiling = swelling.nucleus(p.vapour, p.around, first)
    missing = np.maximum(0.0, boiling - state.temperature) * (state.bubble_void == 0.0)  # K
    return float(((missing + PART * (torn - boiling))[warms] / state.warming[warms]).min())


def tearing_temperature(p) -> float:
    """Temperature [K] of a bubble that a shell bears as it flows."""
    return real_gas.saturation_temperature(p.vapour, tearing_pressure(p))


def tearing_pressure(p) -> float:
    """Pressure [Pa] in a bubble that a shell bears as it flows, less surface tension's: p + k sigma_y ln(ro/ri)."""
    _, inner, outer = swelling.radii(p.own.bubble, p.own.shell, 1.0)
    flow = strength.flow_stress(p.plastic, 0.0, RATE, 0.0)
    return p.around.ambient + shells.layer_pressure(flow, inner, outer, swelling.SPHERE)


def call(scales) -> Judgement:
    """Run over the time in which a droplet warms, in the hottest gas, to where its shell tears."""
    s, name = scales, "run / time to tear"
    p = kernel(s.case)
    tearing, hottest = tearing_temperature(p), max(s.case.temperatures)
    coldest = min((patch.temperature for patch in s.patches), default=hottest)
    if hottest <= tearing or not s.patches:
        return Judgement(name, 0.0, 1.0, SOURCE, 0.0)
    time = s.heat_time * math.log((hottest - coldest) / (hottest - tearing)) if coldest < tearing else 0.0
    number = s.end / time if time else math.inf
    thrown = bursting.flashed_share(p.own.heat_capacity, tearing - p.own.boiling, p.own.latent_heat)
    return Judgement(name, number, 1.0, SOURCE, float(thrown) if number >= 1.0 else 0.0)


EFFECT = Effect(
    name="micro_explosion",
    summary="gel droplets whose shell tears: vapour and small droplets",
    parameters=MicroExplosion,
    kernel=kernel,
    arrays=(
        "temperature", "begun_temperature", "warming", "diameter", "diameter_variance", "born_mass", "born_diameter",
        "born_variance", "sealed", "throwing", "bubble_void", "bubble_temperature", "bubble_heat", *SHELL, *SPOT,
        "spot_hoop",
    ),
    sources=("alpha_g", "vapour", "momentum", "heat"),
    window_limit=window_limit,
    columns=(Column("thrown_kg"), *map(Column, NOTHING_TORN)),
    sums=("thrown_kg", *NOTHING_TORN),
    call=call,
)  # fmt: skip
