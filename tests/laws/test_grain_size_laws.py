import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from lognormal import mass_moment, raw_moment

from sdph.laws import grain_sizes

means = st.floats(1e-5, 1e-2)
ratios = st.floats(0.0, 0.6)  # std/mean
BROAD = 3e-4, 1.2e-4  # m


@given(mean=means, ratio=ratios, order=st.integers(-3, 6))
def test_mean_and_spread_of_the_logarithm_make_the_moments(mean, ratio, order):
    """<d^k> = exp(k m + k^2 s^2/2) of a normal ln d: the first is what was asked for, the second has its variance."""
    m, s = grain_sizes.log_mean(mean, ratio * mean), grain_sizes.log_std(mean, ratio * mean)
    assert math.exp(order * m + 0.5 * order**2 * s**2) == pytest.approx(raw_moment(order, mean, ratio * mean), rel=1e-9)
    assert math.exp(m + 0.5 * s**2) == pytest.approx(mean, rel=1e-12)
    assert math.exp(2.0 * m + s**2) * math.expm1(s**2) == pytest.approx((ratio * mean) ** 2, rel=1e-9, abs=1e-300)


@given(mean=means, ratio=ratios, order=st.floats(-2.0, 3.0))
def test_by_mass_the_mean_of_the_logarithm_is_larger_by_three_variances(mean, ratio, order):
    """Hatch & Choate 1929."""
    m, s = grain_sizes.log_mean(mean, ratio * mean), grain_sizes.log_std(mean, ratio * mean)
    expected = math.exp(order * (m + 3.0 * s**2) + 0.5 * order**2 * s**2)
    assert mass_moment(order, mean, ratio * mean) == pytest.approx(expected, rel=1e-9)


def test_moments_agree_with_a_sample():
    sample = np.random.default_rng(7).lognormal(grain_sizes.log_mean(*BROAD), grain_sizes.log_std(*BROAD), 400_000)
    assert sample.mean() == pytest.approx(BROAD[0], rel=2e-3)
    assert sample.std() == pytest.approx(BROAD[1], rel=1e-2)
    assert (sample**3).mean() == pytest.approx(raw_moment(3.0, *BROAD), rel=1e-2)
    assert (sample**4).sum() / (sample**3).sum() == pytest.approx(mass_moment(1.0, *BROAD), rel=2e-2)
