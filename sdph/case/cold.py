"""Cases of what is cold by nature: of it temperatures are usual that are slips of anything else (sdph.case.usual)."""

from __future__ import annotations

import math

from sdph.case import fluids
from sdph.case.ranges import TEMPERATURE
from sdph.laws.constants import GAS_CONSTANT
from sdph.schema import CaseError

UNLIKE = 0.1  # of the density that a gas has by its equation of state: vapour in it changes it by less; our choice


def is_cold(case) -> bool:
    """True where a case is of what is cold by nature: of a gas that is as dense as it is cold, or of a liquid, by its
    name, that boils below what is usual."""
    gas, least = case.gas, TEMPERATURE.least
    if gas and not gas.fluid and gas.temperature < least and abs(gas.density / by_state(gas) - 1.0) <= UNLIKE:
        return True
    pressure = gas.operating_pressure if gas else fluids.ATMOSPHERE
    return any(_boils(own.fluid, pressure) < least for own in (case.grains, case.liquid) if own and own.fluid)


def _boils(name: str, pressure: float) -> float:
    """Temperature [K] at which a fluid boils; inf where nobody knows it."""
    try:
        return fluids.Fluid(name, "grains").at("T", P=pressure, Q=0.0)
    except CaseError:  # no library, or no line of boiling at that pressure
        return math.inf


def by_state(gas) -> float:
    """Density [kg/m3] that a gas has by its pressure and temperature."""
    return gas.operating_pressure * gas.molar_mass / (GAS_CONSTANT * gas.temperature)
