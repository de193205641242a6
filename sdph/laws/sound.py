"""Sound of ideal gases, and the speed from which on it matters to their flow."""

from __future__ import annotations

import numpy as np

from sdph.laws.constants import GAS_CONSTANT

FAST = 0.3  # -, Mach number from which on gas is compressed by its own motion: density is 5 % off, Anderson 2003
LEAST = 2.5  # -, c_p over R/M of a gas of one atom, the least of all: 3/2 of its motion (equipartition) and 1


def adiabatic(heat_capacity, molar_mass):
    """gamma [-] = c_p/(c_p - R/M) of an ideal gas, heat_capacity c_p [J/(kg K)], molar_mass M [kg/kmol]; 5/3, the
    largest of all, where c_p is less than that of a gas of one atom. Anderson 2003, Modern Compressible Flow."""
    share = GAS_CONSTANT / molar_mass
    held = np.where(heat_capacity < LEAST * share, LEAST * share, heat_capacity)
    return held / (held - share)


def of_ideal_gas(temperature, heat_capacity, molar_mass):
    """c [m/s] = sqrt(gamma R T/M) of an ideal gas of temperature T [K], gamma as of `adiabatic`. Anderson 2003,
    Modern Compressible Flow."""
    return np.sqrt(adiabatic(heat_capacity, molar_mass) * GAS_CONSTANT * temperature / molar_mass)
