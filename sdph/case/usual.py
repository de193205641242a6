"""Values that are possible, and far outside of what the matter of their key ever has: slips of a unit, as a rule.

They are warned of and not refused: `sdph.schema.PLAUSIBLE` refuses what no case means. Benchmarks of liquids and solids
are often given in numbers without units: theirs are judged where `_in_units` says so.
"""

from __future__ import annotations

import math

import numpy as np

from sdph.case import cold, fluids
from sdph.case.ranges import (
    CELSIUS,
    DENSE,
    OF_COLD,
    OF_DENSE,
    OF_LIQUIDS,
    RATIOS,
    TEMPERATURE,
    USUAL,
    Range,
)
from sdph.case.read import to_table
from sdph.effects.around import sizes
from sdph.effects.gas import film
from sdph.effects.solids import inflation
from sdph.laws import size_classes, solids
from sdph.laws.constants import ROUND_OFF
from sdph.schema import CaseError

CONDUCTIVITY = "conductivity_W_m_K"
AGAIN = 0.8, 1.25  # of the level of the pressure: an outlet there is likely given absolute; our choice
MOSTLY = 0.5  # of the mass of drops: with more of it cut away, sizes are those of the bound; our choice
OTHER = 0.02  # of a number of a fluid: what differs by less is another source's, or another temperature's; our choice
EARTH = 9.7, 9.9  # m/s2, of gravity wherever there are people


def _in_units(case) -> bool:
    """True where numbers of liquids and solids are of matter: under Earth's gravity, or under none with a density that
    is not 1. Benchmarks choose a density, or a gravity, that makes their numbers round."""
    gravity = float(np.linalg.norm(case.domain.gravity))
    if gravity:
        return EARTH[0] < gravity < EARTH[1]
    return all(own.density != 1.0 for own in (case.liquid, case.solid) if own)


def _ranges(case) -> dict[str, Range]:
    """Ranges by which a case is judged; what flows is as viscous by the density that it is likely meant to have."""
    usual = {key: OF_COLD if own is TEMPERATURE else own for key, own in USUAL.items()} if cold.is_cold(case) else USUAL
    if not _in_units(case):
        return usual
    found = usual | OF_LIQUIDS
    for section, least in (("liquid", 2e-6), ("gas_phase", 1e-6)):
        if own := getattr(case, section):
            slips = ("m2/s", own.density), ("mPa s", 1e-3), ("uPa s", 1e-6)
            found |= {f"{section}.viscosity_Pa_s": Range(least, 1e4, "from liquid helium, or gas, to lava", slips)}
    if case.solid and case.solid.density > DENSE:
        found["solid.youngs_modulus_Pa"] = OF_DENSE
    return found


def warnings(case) -> list[str]:
    """A line for each value of a case that is 0 in no component and far outside of its range: what was given, the
    range, and the unit that was likely meant; and for numbers that are not those of a fluid that is named."""
    table = to_table(case)
    told = far(table, _ranges(case)) or _ratios(table) or _unlike_its_state(case)  # a slip explains a density too
    told += _absolute(case) + _wider_than_their_mouth(case) + _cut_away(case) + _never_followed(case)
    told += _never_open(case) + _bursting(case)
    return told + _hotter_than_their_film(case, table) + _overruled(table)


def far(table: dict, ranges: dict[str, Range]) -> list[str]:
    """The first of these of the numbers of a table, by ranges of its keys."""
    told = []
    for pattern, usual in ranges.items():
        for key, value in _found(table, pattern.split(".")):
            size = float(np.linalg.norm(value))
            if size and not _within(size, usual):
                bounds = f"{usual.least:g} to {usual.most:g} ({usual.what})"
                told.append(f"{key} = {_shown(value)} is far from usual, {bounds}{_likely(value, usual)}")
    return told


def _ratios(table: dict) -> list[str]:
    """A line for each number that is 0 in no case and far from usual beside another one."""
    told = []
    for (key, other), usual in RATIOS.items():
        pairs = [dict(_found(table, name.split("."))).get(name) for name in (key, other)]
        if all(pairs) and not _within(ratio := pairs[0] / pairs[1], usual):
            told.append(
                f"{key} = {pairs[0]:g} is {ratio:.3g} of {other} = {pairs[1]:g}; usual is {usual.least:g} to "
                f"{usual.most:g} ({usual.what}); {_meant_of_both(key, other, pairs, usual)}"
            )
    return told


def _meant_of_both(key: str, other: str, values: list[float], usual: Range) -> str:
    """Units by which one of two values brings their ratio into its range."""
    ratio = values[0] / values[1]
    meant = [
        f"if {unit} was meant, give {one} = {value * factor:g}"
        for unit, factor in usual.slips
        for one, value, moved in ((key, values[0], ratio * factor), (other, values[1], ratio / factor))
        if _within(moved, usual)
    ]
    return "; ".join(meant) or "look at the units of both"


def _bursting(case) -> list[str]:
    """A line where an elastic ring bears no such pressure: it grows until the run ends. A blast may mean that."""
    body, solid = inflation.pressed(case), case.solid
    if body is None:
        return []
    own = case.parameters["inflation"]
    thick = body.radius - body.inner_radius
    most = solids.ring_pressure(body.radius - 0.5 * thick, thick, solid.youngs_modulus, solid.poisson_ratio)
    if own.pressure <= most:
        return []
    return [
        f"inflation.pressure_Pa = {own.pressure:g} is more than the ring bears at any size, about {most:.3g} Pa with "
        f"solid.youngs_modulus_Pa = {solid.youngs_modulus:g}: it grows until it fails or the run ends; look at the "
        "units of both, unless a blast is meant"
    ]


def _unlike_its_state(case) -> list[str]:
    """A line where the gas's density is not that which a run computes from its pressure and temperature: numbers before
    a run, and `ergun_Pa` and `weight_Pa` after it, go by the one that was given."""
    gas = case.gas
    if gas is None or gas.equation_of_state == "constant":
        return []
    own = cold.by_state(gas)
    if abs(gas.density / own - 1.0) <= cold.UNLIKE:
        return []
    state = (
        f"equation_of_state = {gas.equation_of_state!r} with {gas.operating_pressure:g} Pa and {gas.temperature:g} K"
    )
    return [
        f"gas.density_kg_m3 = {gas.density:g}, but the gas of the run has {own:.4g} kg/m3 ({state}): U_mf, "
        f"Ergun's pressure and the bed's go by the first; give {own:.4g}"
    ]


def _absolute(case) -> list[str]:
    """A line for each outlet whose pressure is that of the gas again: it is told over it."""
    level = case.gas.operating_pressure if case.gas else 0.0
    return [
        f"boundaries.{name}.pressure_Pa = {outlet.pressure:g} comes on top of gas.operating_pressure_Pa = {level:g}; "
        f"if it is absolute, give {outlet.pressure - level:g}"
        for name, outlet in case.boundaries.items()
        if outlet.pressure and AGAIN[0] * level <= outlet.pressure <= AGAIN[1] * level
    ]


def _wider_than_their_mouth(case) -> list[str]:
    """A line for each nozzle whose grains do not fit through it."""
    told = []
    for name, nozzle in case.nozzles.items() if case.grains else ():
        mouth = nozzle.width or 2.0 * (nozzle.radius or 0.0)
        largest = float(sizes.of_nozzle(case, nozzle).diameter.max()) if nozzle.shape != "table" else 0.0
        if 0.0 < mouth < largest:
            told.append(
                f"nozzles.{name} lets grains of {1e3 * largest:.3g} mm through a mouth of {1e3 * mouth:.3g} mm: look "
                "at the units of its sizes"
            )
    return told


def _never_open(case) -> list[str]:
    """A line for each nozzle that opens when the run is over."""
    return [
        f"nozzles.{name} opens at start_s = {own.start:g}; the run ends at {case.run.end_time:g} s: it gives nothing"
        for name, own in case.nozzles.items()
        if own.start >= case.run.end_time
    ]


def _cut_away(case) -> list[str]:
    """A line for each nozzle whose smallest or largest drop leaves out most of the mass of Rosin & Rammler's law."""
    told = []
    for name, own in case.nozzles.items():
        if own.sizes != "rosin_rammler":
            continue
        ends = {"least": own.least_diameter, "most": own.most_diameter or math.inf}
        shares = size_classes.cut_away(own.size_parameter, own.size_exponent, *ends.values())
        told += [
            f"nozzles.{name}.{end}_diameter_mm = {1e3 * ends[end]:g} cuts {100.0 * share:.3g} % of the mass away that "
            f"size_parameter_mm = {1e3 * own.size_parameter:g} means, and sizes are all but that bound's: look at the "
            "units of both"
            for end, share in zip(ends, shares)
            if share > MOSTLY
        ]
    return told


def _never_followed(case) -> list[str]:
    """A line where particles are to be followed that are neither grains nor bodies without a liquid."""
    if not case.track or case.grains or case.matters == ("solid",):
        return []
    return [
        f"track.particles = {list(case.track)} follows nothing: grains are followed, and bodies that no liquid is "
        "beside; give [probes.NAME] instead, or leave [track] out"
    ]


def _hotter_than_their_film(case, table: dict) -> list[str]:
    """A line where drops have their vapour by name, at the film's temperature, and Spalding's law takes beside it a gas
    by name, which is at its own."""
    by_name = all(table.get(name, {}).get("fluid") for name in ("gas", "grains"))
    if not by_name or "evaporation" not in case.effects or case.parameters["evaporation"].law != "spalding":
        return []
    hot, drops = case.gas.temperature, (*case.particles.values(), *case.nozzles.values())
    around = film.temperature(hot, min((own.temperature for own in drops), default=hot))
    bare = table | {"gas": {key: value for key, value in table["gas"].items() if key != CONDUCTIVITY}}
    try:
        named = fluids.filled(bare)["gas"][CONDUCTIVITY]
    except CaseError:  # no library: nothing to compare with
        return []
    if hot - around <= OTHER * around or abs(case.gas.conductivity - named) > OTHER * named:
        return []
    return [
        f"evaporation.law = 'spalding' takes the gas as [gas] has it, at {hot:g} K, and the vapour of grains.fluid is "
        f"that of the film, {around:.4g} K: drops come out too hot and too slow; give {CONDUCTIVITY}, density_kg_m3 "
        f"and heat_capacity_J_kg_K of [gas] at {around:.4g} K, or take law = 'linear'"
    ]


def _overruled(table: dict) -> list[str]:
    """A line for each section that names a fluid while the case gives other numbers than it has: these stand."""
    told = []
    for name, sections in fluids.FILLS.items():
        fluid = table.get(name, {}).get("fluid")
        if not fluid:
            continue
        bare = table | {
            section: {key: value for key, value in table[section].items() if key not in keys}
            for section, keys in sections.items()
            if section in table
        }
        try:
            by_name = fluids.filled(bare)
        except CaseError:  # no library, or no such number: nothing to compare with
            continue
        other = [
            f"{section}.{key} = {given:g} ({own:g})"
            for section, keys in sections.items()
            for key in keys
            if isinstance(own := by_name.get(section, {}).get(key), float)
            and isinstance(given := table.get(section, {}).get(key), float)
            and abs(given - own) > OTHER * abs(own)
        ]
        if other:
            told.append(
                f"numbers that the case gives stand, and are not those of {name}.fluid = {fluid!r}: "
                f"{', '.join(other)}; leave them out to have its own"
            )
    return told


def _within(value: float, usual: Range) -> bool:
    """True from the least to the most, both among them, as the line says."""
    return (1.0 - ROUND_OFF) * usual.least <= value <= (1.0 + ROUND_OFF) * usual.most


def _found(table, path: list[str], before: str = ""):
    """(key, value) of all that a pattern finds in a table."""
    name, *rest = path
    for each in table if name == "*" and isinstance(table, dict) else [name]:
        value = table.get(each) if isinstance(table, dict) else None
        if not rest and isinstance(value, (int, float, list)):
            yield f"{before}{each}", value
        elif rest and isinstance(value, dict):
            yield from _found(value, rest, f"{before}{each}.")


def _likely(value, usual: Range) -> str:
    """Units by which a value is in its range, and what it is in that of the key."""
    told = []
    for unit, factor in usual.slips:
        meant = value + factor if unit == CELSIUS else np.multiply(value, factor).tolist()
        if _within(float(np.linalg.norm(meant)), usual):
            told.append(f"if {unit} was meant, give {_shown(meant)}")
    return "; " + ("; ".join(told) or "look at its unit, unless that is meant")


def _shown(value) -> str:
    return f"[{', '.join(f'{each:g}' for each in value)}]" if isinstance(value, list) else f"{value:g}"
