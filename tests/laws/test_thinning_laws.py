"""Laws of liquids that thin, by published points, limits, and by numbers worked out by hand."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sdph.laws import liquids, thinning


def test_carreau_by_the_fit_of_bird_armstrong_and_hassager():
    """2 % polyisobutylene in Primol 355 (their Table 4.1-2): mu_0 923 Pa s, mu_inf 0.150 Pa s, lambda 191 s, n
    0.358."""
    own = 923.0, 0.358, 191.0, 0.150
    assert thinning.carreau(0.0, *own) == 923.0
    assert thinning.carreau(1.0 / 191.0, *own) == pytest.approx(0.150 + (923.0 - 0.150) * 2.0**-0.321, rel=1e-12)
    steep = math.log(thinning.carreau(1e2, *own[:3], 0.0) / thinning.carreau(1e1, *own[:3], 0.0)) / math.log(10.0)
    assert steep == pytest.approx(0.358 - 1.0, abs=1e-5)
    assert thinning.carreau(1e12, *own) == pytest.approx(0.150, rel=1e-3)


def test_herschel_and_bulkley_by_hand():
    """tau = tau_y + K gamma^n where it flows; tau_y m at rest."""
    K, n, m, tau = 2.0, 0.6, 1e3, 5.0
    assert thinning.herschel_bulkley(3.0, K, n, m, tau) * 3.0 == pytest.approx(5.0 + 2.0 * 1.933182045, rel=1e-9)
    assert thinning.herschel_bulkley(0.0, K, 1.0, m, tau) == 2.0 + 5e3
    assert thinning.herschel_bulkley(1e-9, K, 1.0, m, tau) == pytest.approx(5002.0, rel=1e-6)


@given(rate=st.floats(1e-6, 1e6), viscosity=st.floats(1e-4, 1e3))
def test_of_index_one_all_are_newtonian(rate, viscosity):
    assert thinning.power_law(rate, viscosity, 1.0) == viscosity
    assert thinning.carreau(rate, viscosity, 1.0, 2.0, 0.1) == pytest.approx(viscosity, rel=1e-12)
    assert thinning.herschel_bulkley(rate, viscosity, 1.0, 2.0, 0.0) == viscosity


def test_the_flow_between_plates_balances_the_pull():
    """Of index 1 the parabola; of others the stress of its slope is that of the pull at every place."""
    y = np.linspace(0.0, 1.0, 41)
    np.testing.assert_allclose(
        thinning.between_plates(y, 1.0, 0.8, 0.1, 1.0), liquids.poiseuille(y, 1e3, 1.0, 0.8, 0.1), atol=1e-12
    )
    for index in (0.5, 1.5):
        low, high = (thinning.between_plates(np.array([0.1 + d]), 1.0, 0.8, 0.2, index)[0] for d in (-1e-6, 1e-6))
        slope = (high - low) / 2e-6
        assert thinning.power_law(slope, 0.2, index) * slope == pytest.approx(0.8 * 0.4, rel=1e-6)
