"""Grains that radiate to cold surroundings against the closed form, T (1 + 3 k T^3 t)^(-1/3)."""

from __future__ import annotations

import numpy as np

from sdph.laws.constants import STEFAN_BOLTZMANN
from sdph.study.compare import check

# of the temperature at the start, and of the heat: each window is solved exactly, what is left is round-off
SAME = 1e-9


def curve(case, time: np.ndarray) -> np.ndarray:
    """Temperature (T,) [K] at times (T,) [s]; k = epsilon sigma (6/d)/(rho c). Stefan 1879, Boltzmann 1884."""
    own, start = case.grains, case.particles["cloud"].temperature
    power = case.parameters["radiation"].emissivity * STEFAN_BOLTZMANN * 6.0 / own.diameter
    k = power / (own.density * own.heat_capacity)
    return start * (1.0 + 3.0 * k * start**3 * time) ** (-1.0 / 3.0)


def exact(run) -> list[dict]:
    """The worst of all windows, and the heat that the surroundings got against that of the curve."""
    time, found, ledger = run.history["time_s"], run.history["particle_1_temperature_K"], run.ledger
    expected = curve(run.case, time)
    whole = ledger["particle_mass_kg"][0] * run.case.grains.heat_capacity * (expected[0] - expected[-1])
    return [
        check("temperature, worst over that at the start", np.abs(found - expected).max() / found[0], 0.0, SAME),
        check("heat to the surroundings [J]", ledger["heat_to_surroundings_J"].sum(), whole, SAME, True),
    ]
