"""Gas of a run that is so fast that equations of low Mach number leave something out."""

from __future__ import annotations

import numpy as np

from sdph.laws import sound
from sdph.laws.evaporation import mixture_molar_mass
from sdph.laws.sound import FAST

MACH, SPEED = "gas_mach", "gas_fastest_m_s"  # columns of history.csv, the largest of the run in the summary
LEFT_OUT = {
    "constant": "which gas of constant density does not follow; its pressure and forces on walls are rough there",
    "operating": "which gas at the operating pressure does not follow, and it does not cool as it speeds up: "
    "U^2/(2 c_p) = {:.3g} K are missing there",
    "ideal": "which ideal gas follows, but it does not cool as it speeds up: U^2/(2 c_p) = {:.3g} K are missing there, "
    "and its density is too low by the same share",
}  # by the equation of state: docs/theory/gas.md, "Fast gas"


def columns(case, fields: dict[str, np.ndarray]) -> dict[str, float]:
    """Largest Mach number and speed [m/s] of the gas by its fields in cells."""
    squared = np.einsum("ij,ij->i", fields["velocity"], fields["velocity"])
    own = sound.of_ideal_gas(fields["temperature"], *_mixed(case, fields))
    return {MACH: float((np.sqrt(squared) / own).max()), SPEED: float(np.sqrt(squared.max()))}


def _mixed(case, fields: dict[str, np.ndarray]) -> tuple:
    """c_p [J/(kg K)] and molar mass [kg/kmol] of the gas with what vapour there is in it, one for all cells or
    (C,)."""
    gas, share = case.gas, fields.get("vapour_mass_fraction")
    if case.vapour is None or share is None:
        return gas.heat_capacity, gas.molar_mass
    capacity = share * case.vapour.heat_capacity + (1.0 - share) * gas.heat_capacity
    return capacity, mixture_molar_mass(share, case.vapour.molar_mass, gas.molar_mass)


def warnings(case, largest: dict[str, float]) -> list[str]:
    """A line where the gas came to more than Mach `FAST`, by the `largest` of each column in the run."""
    mach, speed = largest.get(MACH, 0.0), largest.get(SPEED, 0.0)
    if mach <= FAST:
        return []
    missing = LEFT_OUT[case.gas.equation_of_state].format(speed**2 / (2.0 * case.gas.heat_capacity))
    return [
        f"the gas came to Mach {mach:.2g} ({speed:.3g} m/s): from {FAST:g} on motion changes its density by 5 %, "
        f"{missing} (docs/theory/gas.md, Fast gas); let less through, widen where it is narrow, or take it as rough"
    ]
