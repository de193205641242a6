"""Conduction of packed beds: Zehner & Schluender's cell against its integral, its limits, its split with the gas."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from sdph.laws import packed_beds

fractions, ratios = st.floats(1e-3, 0.74), st.floats(1.0, 1e5)


def by_integral(alpha_p, ratio):
    """The closed form as the integral that its logarithm comes from: 2 int_0^1 [(B - 1) x^2 + x]/(1 - N x) dx."""
    B = 1.25 * (alpha_p / (1.0 - alpha_p)) ** (10.0 / 9.0)
    N = 1.0 - B / ratio
    return 2.0 * quad(lambda x: ((B - 1.0) * x * x + x) / (1.0 - N * x), 0.0, 1.0, epsabs=0.0, epsrel=1e-11)[0]


@given(alpha_p=fractions, ratio=st.floats(1.0, 1e3))
def test_core_is_the_integral(alpha_p, ratio):
    assert packed_beds.zehner_schluender_core(alpha_p, ratio) == pytest.approx(by_integral(alpha_p, ratio), rel=1e-8)


@pytest.mark.parametrize("N", [-0.0301, -0.0299, -1e-6, 0.0, 1e-6, 0.0299, 0.0301])
def test_core_is_even_where_its_closed_form_is_not(N):
    """About N = 0, where it is 0/0, on both sides of where the series takes over."""
    ratio = 1.25 * 1.5 ** (10.0 / 9.0) / (1.0 - N)
    assert packed_beds.zehner_schluender_core(0.6, ratio) == pytest.approx(by_integral(0.6, ratio), rel=1e-11)


def test_packed_steel_by_hand():
    """B = 1.7898, 42/0.027: 15.4 times the air's, as was worked out on paper for Beaulieu's bed."""
    assert packed_beds.zehner_schluender(0.58, 42.0, 0.027) == pytest.approx(15.4 * 0.027, rel=2e-3)


@given(alpha_p=fractions, ratio=ratios)
def test_a_bed_conducts_between_layers_across_and_along(alpha_p, ratio):
    """Wiener's bounds, of thin clouds the gas in the place of the lower, which the law falls short of there by 0.2 %;
    with grains that are as the gas the bed is."""
    bed = packed_beds.zehner_schluender(alpha_p, 0.03 * ratio, 0.03) / 0.03
    across = 1.0 / (1.0 - alpha_p + alpha_p / ratio) if alpha_p > 0.4 else 1.0
    assert across * (1.0 - 1e-9) <= bed <= (1.0 - alpha_p + alpha_p * ratio) * (1.0 + 1e-9)
    assert packed_beds.zehner_schluender(alpha_p, 0.03, 0.03) == pytest.approx(0.03, rel=1e-9)


@given(alpha_p=fractions, ratio=ratios)
def test_grains_have_what_the_gas_has_not(alpha_p, ratio):
    own = packed_beds.beside_gas(alpha_p, 0.03 * ratio, 0.03)
    whole = packed_beds.zehner_schluender(alpha_p, 0.03 * ratio, 0.03)
    assert own + (1.0 - alpha_p) * 0.03 == pytest.approx(whole, rel=1e-12)
    assert own > 0.0


def test_few_grains_conduct_as_the_gas():
    """K/alpha_p -> k_g, and rises with alpha_p, which the limit of sub-steps takes for granted."""
    shares = [packed_beds.beside_gas(a, 42.0, 0.027) / a / 0.027 for a in (1e-12, 1e-4, 1e-2, 0.3, 0.6, 0.74)]
    assert shares[0] == pytest.approx(1.0, rel=1e-5)
    assert (np.diff(shares) > 0.0).all()
