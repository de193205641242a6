"""Mach number of the gas before a run: of what comes in, and of what a mesh of its own makes of it."""

from __future__ import annotations

import math

from sdph.case.turbulent import fastest_inlet
from sdph.laws import sound
from sdph.laws.sound import FAST

LOW = "the equations are those of low Mach numbers, without shocks, and from {:g} on its {} wrong"
WRONG = {
    "constant": "density and pressure are",
    "operating": "density, pressure and temperature are",
    "ideal": "temperature is",
}  # by the equation of state: docs/theory/gas.md, "Fast gas"


def speed_of_sound(gas) -> float:
    """Speed [m/s] of sound in the gas at the start."""
    return float(sound.of_ideal_gas(gas.temperature, gas.heat_capacity, gas.molar_mass))


def number(s, fastest: float = 0.0) -> float:
    """Mach number of the gas of a case of scales `s`, the largest of what comes in, what grains make of it, and the
    `fastest` [m/s] in a mesh; nan where pressures alone drive it: how fast, friction and grains decide."""
    known = max(s.slip, fastest_inlet(s.case), fastest)
    return known / speed_of_sound(s.gas) if known or not head(s.case) else math.nan


def head(case) -> float:
    """Largest difference [Pa] of the pressures that drive gas: of outlets, and of `ideal` gas that of the start, which
    is the operating pressure; of other gas one outlet alone is but the level."""
    given = [own.pressure or 0.0 for own in case.boundaries.values() if own.kind == "pressure_outlet"]
    begins = [0.0] if given and case.gas.equation_of_state == "ideal" else []
    return max(given + begins, default=0.0) - min(given + begins, default=0.0)


def warnings(case, fastest: float = 0.0) -> list[str]:
    """Note on gas so fast that a flow at low Mach numbers is not what it does: as it enters, else the `fastest` [m/s]
    in a mesh; and where pressures may drive it so."""
    own, unit = LOW.format(FAST, WRONG[case.gas.equation_of_state]), speed_of_sound(case.gas)
    enters, driven = fastest_inlet(case), math.sqrt(2.0 * head(case) / case.gas.density)
    told = []
    if enters > FAST * unit:
        told.append(f"gas enters at Mach {enters / unit:.3g}: {own}; let it in slower, through a wider inlet")
    elif fastest > FAST * unit:
        told.append(
            f"gas comes to Mach {fastest / unit:.2g} ({fastest:.3g} m/s) where the mesh is narrow, by its flow without "
            f"eddies and at one density from inlets to outlets: {own}; let less in, or widen the mesh there"
        )
    if driven > FAST * unit:
        told.append(
            f"pressures that are {head(case):.3g} Pa apart (pressure_outlet; the start of ideal gas) drive the gas: "
            f"how fast is not known before the run, which tells; without losses Mach {driven / unit:.2g} by Bernoulli, "
            f"more where density falls with pressure; {own}"
        )
    return told
