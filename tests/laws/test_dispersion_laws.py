"""Eddies as a process of chance: moments over one window, and many of them, against closed forms."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sdph.laws import dispersion as law


def test_size_and_memory_of_eddies():
    assert law.fluctuation(1.5) == pytest.approx(1.0)
    assert law.memory(1.5, 0.3, 0.0, 0.15) == pytest.approx(0.75)
    assert law.memory(1.5, 0.3, 2.0, 0.15) == pytest.approx(0.75 / math.sqrt(1.0 + 0.45 * 4.0))


@pytest.mark.parametrize("x", [1e-6, 0.02, 0.0999, 0.1001, 1.0, 30.0])
def test_moments_of_the_mean(x):
    """Variance and covariance of Gillespie 1996, in long numbers where differences lose digits."""
    along, apart = law.spreads_of_mean(x)
    a = math.exp(-x)
    covariance = (-math.expm1(-x)) ** 2 / x
    assert along * law.spread(x) == pytest.approx(covariance, rel=1e-9)
    series = 2.0 / 3.0 * x - x**2 / 2.0 + 7.0 / 30.0 * x**3 - x**4 / 12.0 + 31.0 / 1260.0 * x**5
    variance = series if x < 0.05 else (2.0 * x - 3.0 + 4.0 * a - a * a) / x**2
    assert along**2 + apart**2 == pytest.approx(variance, rel=1e-8)


@given(x=st.floats(1e-9, 700.0))
def test_a_mean_is_less_spread_than_what_it_is_of(x):
    along, apart = law.spreads_of_mean(x)
    assert along >= 0.0 and apart >= 0.0 and along**2 + apart**2 <= 1.0
    assert 0.0 <= law.kept(x) <= law.kept_in_mean(x) <= 1.0


def test_numbers_of_chance_are_normal_and_apart():
    words = [np.uint64(law.scrambled(np.uint64(3 * n))) for n in range(100_000)]
    drawn = np.array([law.two_normal(word) for word in words])
    assert np.abs(drawn.mean(axis=0)).max() < 0.015
    assert drawn.var(axis=0) == pytest.approx(1.0, abs=0.02)
    assert (drawn**4).mean(axis=0) == pytest.approx(3.0, abs=0.12)
    assert abs(np.corrcoef(drawn.T)[0, 1]) < 0.015 and abs(np.corrcoef(drawn[:-1, 0], drawn[1:, 0])[0, 1]) < 0.015
