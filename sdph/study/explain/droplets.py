"""Numbers of droplets: whether they stay whole and round, and how they evaporate."""

from __future__ import annotations

import math

from sdph.effects.gas import evaporation
from sdph.laws import evaporation as law
from sdph.laws import heat
from sdph.laws.constants import GAS_CONSTANT
from sdph.study.explain import weber

# law of evaporation -> what B of heat above its threshold means
OF_HEAT = {
    "linear": "vapour would hold back heat, which law = 'linear' leaves out; take 'spalding'",
    "spalding": "vapour holds back some of the heat on its way",
}
# vapour goes by Ranz & Marshall's Sherwood number whatever the law of heat is
WARM = "more heat than fits to the vapour: the wet bulb is too hot; heat.law = 'ranz_marshall' for few droplets"
# what makes a fluid of grains, that pushes and rubs as one; friction is of grains that touch
OF_A_FLUID = "granular_pressure", "granular_viscosity", "granular_temperature", "artificial_viscosity"


def numbers(s, heated: bool) -> list[tuple]:
    """Rows, as in `sdph.study.explain.tables.numbers`, of what has a surface tension, and of what evaporates."""
    rows, grains, gas = [], s.grains, s.gas
    if grains.surface_tension:
        pull = grains.surface_tension / grains.diameter
        weight = abs(grains.density - gas.density) * s.gravity * grains.diameter
        rows += weber.rows(s)
        rows.append(("Bond", weight / pull, 0.4, "droplets are no spheres", "Clift, Grace & Weber 1978, fig. 2.5"))
    if "evaporation" in s.case.parameters and s.case.vapour and s.patches:
        (mass, heat_number, spent), own = spalding(s), s.case.parameters["evaporation"]
        rows.append(("Spalding B of mass", mass, 0.1, "the vapour's own outflow slows evaporation", "Spalding 1953"))
        rows.append(("Spalding B of heat", heat_number, 0.1, OF_HEAT[own.law], "Spalding 1953"))
        if heated:
            ratio = s.nusselt / heat.ranz_marshall(1.0 - s.alpha_p, s.reynolds, s.prandtl)
            rows.append(("Nusselt / Ranz & Marshall's", ratio, 1.1, WARM, "Ranz & Marshall 1952"))
        rows.append(("run / evaporation time", spent, 1.0, "droplets are gone", "d2 law, Spalding 1953"))
        dry = "those that meet a wall stay droplets: there is no film, splash or sticking"
        rows.append(("way of droplets / gap to a wall", s.to_walls.over_gap, 1.0, dry, "geometry"))
    return rows


def flying(s, on: tuple[str, ...]) -> list[str]:
    """A line where effects of a fluid of grains are `on`, and grains with scales `s` fly past all their neighbours
    before they meet another (Knudsen number above 1, where no gas is a continuum: Bird 1994, ch. 1)."""
    own = [name for name in OF_A_FLUID if name in on]
    if not own or s.free_path <= s.case.smoothing_length:
        return []
    return [
        f"grains fly {s.free_path:.2g} m between collisions, {s.free_path / s.case.smoothing_length:.2g} smoothing "
        f"lengths, and are no fluid; {', '.join(own)} make one of them, which holds streams back and drives them "
        "apart: leave out of effects what is not called for"
    ]


def boiling(case) -> list[str]:
    """A line for each region and nozzle whose droplets are hotter than they boil at; gel is sealed by its shell."""
    if "evaporation" not in case.effects or case.vapour is None or "micro_explosion" in case.effects:
        return []
    boils = evaporation.kernel(case).boiling_temperature
    given = [("particles", own) for own in case.particles.items()] + [("nozzles", own) for own in case.nozzles.items()]
    return [
        f"{section}.{name}.temperature_K = {own.temperature:g}: droplets boil from {boils:.5g} K on, so that what they "
        "have beyond that goes off in the first windows; lower it, unless that is meant"
        for section, (name, own) in given
        if own.temperature > boils
    ]


def spalding(s) -> tuple[float, float, float]:
    """B of mass (Y_s - Y)/(1 - Y_s) in gas without vapour, B of heat c_pv (T - T_s)/L, and the run over the evaporation
    time."""
    surface, own = evaporation.at_surface(s), s.case.parameters["evaporation"]
    coldest = min(patch.temperature for patch in s.patches)
    vapour_mole = surface / s.case.vapour.molar_mass * GAS_CONSTANT * coldest / s.gas.operating_pressure
    fraction = law.vapour_mass_fraction(
        min(vapour_mole, 1.0 - evaporation.BOILING_MARGIN), s.case.vapour.molar_mass, s.gas.molar_mass
    )
    heat_number = (
        s.case.vapour.heat_capacity * (s.gas.temperature - coldest) / own.latent_heat if own.latent_heat else math.inf
    )
    return law.spalding_number(fraction, 0.0), heat_number, evaporation.shrinking(s, surface)[1]
