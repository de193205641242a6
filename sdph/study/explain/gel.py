"""`sdph explain` of a gel droplet: when, where and at which pressure it tears, by the droplet without particles."""

from __future__ import annotations

import math

from sdph.case import usual
from sdph.effects.gas import gel
from sdph.laws import real_gas
from sdph.methods.liquids.liquid import SLOW
from sdph.study.gel_droplet import foretold

# p/(rho c^2) [-] from which on the gel is compressed by more than what the Mach number is told of, 4 %: as much as the
# band of D/D0 at the tear, 1.35 to 1.47, is wide
COMPRESSED = SLOW**2
CRITICAL = ("critical_temperature", "K"), ("critical_pressure", "Pa"), ("acentric_factor", "")  # of micro_explosion


def rows(case) -> list[dict]:
    """Rows of quantity, value, unit and what it is; none of a case that is no heated droplet in a shell."""
    if not foretold.heated(case):
        return []
    course, bubble = foretold.of(case), case.parameters["bubble"]
    boils = float(real_gas.saturation_temperature(gel.vapour(bubble), bubble.around))
    first = ("boiling temperature", boils, "K", f"of {fuel(bubble)}, at bubble.around_Pa = {bubble.around:g}")
    if isinstance(course, str):
        return _table([first, ("tear", math.nan, "s", f"not foretold: {course}")])
    return _table([first, *_growth(case, course)])


def _growth(case, course) -> list[tuple]:
    """Rows of the growth, and the settings of the model that foretells it."""
    own, numbers, end = foretold.growth(case, course), course.model.own.numerics, case.run.end_time
    tears = own.tear < math.inf
    settings = (
        f"sdph droplet, its largest bubble alone; layers = {numbers.layers}, rings = {numbers.rings}, "
        f"growth_step = {numbers.growth_step:g}, longest_step_ms = {1e3 * numbers.longest_step:g}"
    )
    return [
        ("tear", own.tear if tears else math.nan, "s", _tear(own.tear, end, numbers.end_time)),
        ("growth", own.lasts if tears else math.nan, "s", "the last 90 % of it before the tear"),
        ("largest pressure", own.pressure, "Pa", "gauge, over bubble.around_Pa, within the run"),
        ("p/(rho c2)", compression(case, own), "", f"what it compresses the gel by; {COMPRESSED:g} at most"),
        ("D/D0", own.ratio, "", "at the tear" if own.tear <= end else "at run.end_time_s"),
        ("reduced model", course.summary["steps"], "steps", settings),
    ]


def _table(told: list[tuple]) -> list[dict]:
    return [dict(zip(("quantity", "value", "unit", "how"), row)) for row in told]


def _tear(tear: float, end: float, followed: float) -> str:
    """Words on whether a run sees the tear."""
    if tear <= end:
        return "the shell tears within the run"
    when = f"it would at {tear:.4g} s" if tear < math.inf else f"nor within {followed:g} s"
    return f"it does not tear within run.end_time_s = {end:g}; {when}"


def compression(case, own: foretold.Growth) -> float:
    """p/(rho c^2) [-] of the largest pressure."""
    return own.pressure / (case.liquid.density * case.liquid.sound_speed**2)


def fuel(bubble) -> str:
    """Name of the fuel of a bubble: the one of the program, or which of its keys are the case's."""
    own, left = gel.whose(bubble)
    if not own:
        return "n-dodecane, 170.33 kg/kmol (none is given; NIST's webbook: [bubble] molar_mass_kg_kmol and its like)"
    rest = f", and n-dodecane's {', '.join(left)}" if left else ""
    return f"a fuel, {bubble.molar_mass:g} kg/kmol, with the case's own {', '.join(own)}{rest} ([bubble])"


def warnings(case) -> list[str]:
    """Lines where two fuels are mixed, outputs miss the growth, or pressure compresses the gel."""
    if not foretold.heated(case):
        return _of_spray(case)
    course, two = foretold.of(case), gel.mixed(case.parameters["bubble"], "bubble")
    if isinstance(course, str):
        return two
    own = foretold.growth(case, course)
    return [*two, *_missed(case, own), *_compressed(case, own)]


def _of_spray(case) -> list[str]:
    """A line where the vapour of gel droplets that tear has another molar mass than n-dodecane, and its critical point
    has not."""
    if "micro_explosion" not in case.effects:
        return []
    default, own, mass = gel.Fuel(), case.parameters["micro_explosion"], case.vapour.molar_mass
    left = [f"{name}_{unit}".rstrip("_") for name, unit in CRITICAL if getattr(own, name) == getattr(default, name)]
    if abs(mass - default.molar_mass) <= usual.OTHER * default.molar_mass or not left:
        return []
    return [
        f"vapour.molar_mass_kg_kmol = {mass:g}, and {', '.join(left)} of [micro_explosion] are those of n-dodecane, "
        f"{default.molar_mass:g} kg/kmol: two fuels in one; give all of the same fuel, unless that is meant"
    ]


def _missed(case, own: foretold.Growth) -> list[str]:
    """A line where outputs are further apart than the growth is long."""
    every = case.run.output_interval
    if own.tear > case.run.end_time or every <= own.lasts:
        return []
    return [
        f"the droplet grows within {own.lasts:.3g} s and tears at {own.tear:.3g} s (sdph droplet), and "
        f"run.output_interval_s = {every:g}: one picture of it at most; give {0.05 * own.lasts:.2g}"
    ]


def _compressed(case, own: foretold.Growth) -> list[str]:
    """A line where the pressure compresses the gel too far."""
    if (share := compression(case, own)) <= COMPRESSED:
        return []
    sound = 2.0 * math.sqrt(own.pressure / (case.liquid.density * COMPRESSED))
    return [
        f"the gel's pressure comes to {own.pressure:.3g} Pa, p/(rho c2) = {share:.2g}: it is compressed by more than "
        f"{COMPRESSED:g}; raise liquid.sound_speed_m_s from {case.liquid.sound_speed:g} to {sound:.3g}"
    ]
