"""Pressure of saturation as OpenFOAM's liquids have it, exp(a + b/T + c ln T + d T), fitted to the law of a case.

A constant and Clausius & Clapeyron's law are of that form; Antoine's is fitted, from well below the coldest droplet to
a little above boiling, as OpenFOAM finds the temperature of boiling by it too.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from sdph.case.sections import Case
from sdph.effects.gas import evaporation
from sdph.schema import CaseError

POINTS = 200  # of the fit, evenly in 1/T, in which all three laws are nearly straight
COLDEST = 0.8  # of the lowest temperature given: droplets cool by what evaporates; our choice
ABOVE = 1.02  # of the temperature of boiling
EXACT = 1e-9  # relative: the form has the law
# Relative. The rate goes as the difference of this pressure and that of the vapour around: a hundredth of it is a
# fifteenth of the bar for the evaporated mass (sdph.study.droplets).
LARGEST = 0.01
FORMS = (np.ones_like, np.reciprocal, np.log, np.positive)  # of T over a mean, those of ln p
NOT_SO_HOT = 1e4  # K: where a liquid never boils


class Fit(NamedTuple):
    """a, b, c, d with p in Pa and T in K; largest relative error of p between `low` and `high` [K]; temperature of
    boiling, and the largest that OpenFOAM looks for it at [K]."""

    numbers: tuple[float, float, float, float]
    error: float
    low: float
    high: float
    boiling: float
    end: float


def fitted(case: Case) -> Fit:
    """The fit of a case; where nothing evaporates one that no model reads. `CaseError` above LARGEST."""
    coldest, warmest = min(case.temperatures), max(case.temperatures)
    if "evaporation" not in case.effects:
        return Fit((0.0, 0.0, 0.0, 0.0), 0.0, coldest, warmest, NOT_SO_HOT, NOT_SO_HOT)
    p = evaporation.kernel(case)
    boils = p.boiling_temperature < evaporation.NEVER
    boiling, end = (p.boiling_temperature, ABOVE * p.boiling_temperature) if boils else (NOT_SO_HOT, NOT_SO_HOT)
    low, high = COLDEST * coldest, end if boils else warmest
    temperature = 1.0 / np.linspace(1.0 / high, 1.0 / low, POINTS)
    numbers, error = least_squares(temperature, [evaporation.saturation_pressure(p, T) for T in temperature.tolist()])
    if error > LARGEST:
        raise CaseError(
            f"evaporation.saturation = {case.parameters['evaporation'].saturation!r}: OpenFOAM's form of it is "
            f"{100.0 * error:.2g} % off between {low:.0f} and {high:.0f} K, above {100.0 * LARGEST:g} %; take a law "
            "that is nearer to ln p = a + b/T + c ln T + d T"
        )
    return Fit(numbers, error, low, high, boiling, end)


def least_squares(temperature, pressure) -> tuple[tuple[float, float, float, float], float]:
    """(a, b, c, d) with the fewest terms that have the law, and the largest relative error of the pressure.

    temperature (n,) [K], pressure (n,) [Pa].
    """
    middle, wanted = float(np.mean(temperature)), np.log(pressure)
    terms = np.stack([form(temperature / middle) for form in FORMS], axis=1)
    for count in range(1, 5):
        found = np.zeros(4)
        found[:count] = np.linalg.lstsq(terms[:, :count], wanted, rcond=None)[0]
        error = float(np.abs(np.expm1(terms @ found - wanted)).max())
        if error < EXACT:
            break
    a, b, c, d = found.tolist()
    return (a - c * float(np.log(middle)), b * middle, c, d / middle), error
