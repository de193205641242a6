"""Gas through the openings of a vessel: how much comes in and leaves, how warm, with how much vapour."""

from __future__ import annotations

import numpy as np

from coupling.gas import Budget

OPEN = ("velocity_inlet", "pressure_outlet")


def names(case) -> list[str]:
    """Names of the openings."""
    return [name for name, own in case.boundaries.items() if own.kind in OPEN]


def mean(case, depth: float, first: Budget | None, now: Budget, time: float) -> dict[str, float]:
    """Mean over `time` [s] between two budgets (first None: since the start) by column, of each opening: mass of gas
    that came in through it and that left [kg/s], per metre of depth in two dimensions; of what left the mean
    temperature, by its enthalpy (of the mixing cup), and the mass fraction of vapour; nan of nothing."""
    found = {}
    for name in names(case):
        passed = np.array(now.crossed[name]) - (np.array(first.crossed[name]) if first else 0.0)
        came, left, warmth, vapour = (passed / (time * depth) if time else np.full(4, np.nan)).tolist()
        capacity = case.gas.heat_capacity * left
        found |= {f"{name}_gas_in_kg_s": came, f"{name}_gas_out_kg_s": left}
        if case.vapour:
            capacity += (case.vapour.heat_capacity - case.gas.heat_capacity) * vapour
            found[f"{name}_gas_out_vapour_mass_fraction"] = vapour / left if left else np.nan
        found[f"{name}_gas_out_temperature_K"] = warmth / capacity if capacity else np.nan
    return found
