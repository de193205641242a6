"""Gas among grains that begin hotter or colder than it: how fast it expands, or shrinks, as the run starts."""

from __future__ import annotations

from typing import NamedTuple

from sdph.laws.sound import FAST, of_ideal_gas


class Expansion(NamedTuple):
    """A region's name, its temperature over that of the gas [-], the time [s] in which the gas there takes it, and the
    speed [m/s] at which it then leaves or comes in."""

    region: str
    ratio: float
    time: float
    speed: float


def of(case, s) -> Expansion | None:
    """The fastest expansion of the start by the scales `s`, if it comes to Mach `FAST`; none at constant density."""
    if case.gas.equation_of_state == "constant" or "heat" not in case.effects or case.coupling.one_way:
        return None
    own, hotter = case.gas.temperature, lambda name: abs(1.0 - _ratio(case, name))
    name = max(case.particles, key=hotter, default=None)
    if name is None or not hotter(name):
        return None
    ratio = _ratio(case, name)
    speed = abs(1.0 - ratio) / max(1.0, ratio) * s.length / s.gas_heat_time
    fast = FAST * float(of_ideal_gas(own, case.gas.heat_capacity, case.gas.molar_mass))
    return Expansion(name, ratio, s.gas_heat_time, speed) if speed > fast else None


def _ratio(case, name: str) -> float:
    return case.particles[name].temperature / case.gas.temperature


def keys(case, found: Expansion) -> str:
    """Both temperatures, by their keys."""
    given = found.ratio * case.gas.temperature
    return f"gas.temperature_K ({case.gas.temperature:g}) and particles.{found.region}.temperature_K ({given:g})"


def warnings(case, s) -> list[str]:
    """A line on the start of a case of scales `s`, where gas bursts out of its grains or into them."""
    found = of(case, s)
    if not found:
        return []
    does, way = ("expands", "out of") if found.ratio > 1.0 else ("shrinks", "into")
    times = found.ratio if found.ratio > 1.0 else 1.0 / found.ratio
    return [
        f"{keys(case, found)} are apart: the gas among these grains takes their temperature in {found.time:.2g} s and "
        f"{does} {times:.3g} times (its density {1.0 / found.ratio:.3g} times), at up to {found.speed:.3g} m/s {way} "
        "the grains: the gas may fail there, or its pressure jump; begin both at one temperature, and let walls or "
        "inlets bring the other"
    ]


def told_by(case, s, time: float) -> str:
    """Words for a gas that failed at `time` [s], where it expands then; else none."""
    found = of(case, s)
    if not found or time > found.time:
        return ""
    return f"; gas among the grains takes their temperature in {found.time:.2g} s: begin with {keys(case, found)} alike"
