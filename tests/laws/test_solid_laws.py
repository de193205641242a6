"""Rings under pressure against what is integrated apart from the laws."""

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import minimize_scalar

from sdph.laws import solids


def borne(inner: float) -> float:
    """Largest pressure of a ring with outer radius 1, shear modulus 1, that keeps its volume: the integral of
    4 G ln(r/R) R/r^2 dR over its wall, r^2 = R^2 + c, largest over c."""

    def pressure(c):
        return 4.0 * quad(lambda r: 0.5 * math.log((r * r + c) / r**2) * r / (r * r + c), inner, 1.0)[0]

    return -minimize_scalar(lambda c: -pressure(c), bounds=(0.0, 50.0), method="bounded").fun


@pytest.mark.parametrize(("inner", "bar"), [(0.9, 1e-3), (0.5, 0.01), (0.2, 0.04), (0.05, 0.08)])
def test_the_largest_pressure_of_a_ring(inner, bar):
    own = solids.ring_pressure(0.5 * (1.0 + inner), 1.0 - inner, 3.0, 0.5)  # E = 3 G
    assert own == pytest.approx(borne(inner), rel=bar)


@pytest.mark.parametrize("periods", [0.5, 1.0, 1.7, 3.0, 9.0])
def test_the_swing_after_a_rise_is_that_of_an_undamped_one(periods):
    """x'' + w^2 (x - load) = 0, by the load's rate: never more than the law, and as much for some rise nearby."""
    s = np.linspace(0.0, 1.0, 20001)
    waves = periods + np.linspace(-0.5, 0.5, 201)
    swings = [abs(np.trapezoid(6.0 * s * (1.0 - s) * np.exp(2j * np.pi * own * s), s)) for own in waves]
    laws = [min(1.0, solids.ring_swing(own, 1.0)) for own in waves]
    assert (np.array(swings) <= np.array(laws) + 1e-6).all()
    if periods >= 1.7:
        assert max(np.array(swings) / laws) == pytest.approx(1.0, abs=1e-3)


def test_a_load_that_is_there_at_once_swings_by_all_of_it():
    assert solids.ring_swing(0.0, 1.0) > 1.0
