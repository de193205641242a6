import math

import exact_solutions as exact
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sdph.laws import friction
from sdph.laws.constants import FRICTION_ETA, FRICTION_FR, FRICTION_P

JOHNSON_JACKSON = 0.6, 0.63, FRICTION_FR, FRICTION_ETA, FRICTION_P
rates = st.floats(-100.0, 100.0)


@given(alpha_p=st.floats(0.6005, 0.625))
def test_slope_of_the_frictional_pressure(alpha_p):
    step = 1e-7
    high, low = (friction.johnson_jackson_pressure(alpha_p + s, *JOHNSON_JACKSON) for s in (step, -step))
    assert low > 0.0
    slope = friction.johnson_jackson_slope(alpha_p, *JOHNSON_JACKSON)
    assert slope == pytest.approx((high - low) / (2.0 * step), rel=1e-5)


@given(alpha_p=st.floats(0.0, 0.6))
def test_no_friction_below_the_threshold_and_a_smooth_start(alpha_p):
    pressure, slope = friction.johnson_jackson_pressure, friction.johnson_jackson_slope
    assert pressure(alpha_p, *JOHNSON_JACKSON) == slope(alpha_p, *JOHNSON_JACKSON) == 0.0
    assert 0.0 <= pressure(0.6 + 1e-9, *JOHNSON_JACKSON) < 1e-9
    assert 0.0 <= slope(0.6 + 1e-9, *JOHNSON_JACKSON) < 1.0


@given(stress=st.floats(1e-2, 1e7), pressure=st.floats(0.0, 1e6), degrees=st.floats(5.0, 45.0))
def test_grains_yield_at_pressure_times_sine_of_the_angle(stress, pressure, degrees):
    most = pressure * math.sin(math.radians(degrees))
    share = friction.yield_share(pressure, math.sin(math.radians(degrees)), stress * stress)
    assert share * stress == pytest.approx(min(stress, most), rel=1e-12, abs=1e-300)
    assert share == 1.0 or stress > most


def test_grains_at_rest_bear_what_they_have():
    assert friction.yield_share(1000.0, 0.5, 0.0) == friction.yield_share(0.0, 0.5, 0.0) == 1.0


@pytest.mark.parametrize(("poisson", "ratio"), [(0.0, 1.5), (0.2, 0.75), (0.4, 3.0 / 14.0), (0.5, 0.0)])
def test_shear_over_bulk_modulus(poisson, ratio):
    """By G = E/(2 (1 + nu)) and K = E/(3 (1 - 2 nu)) of numbers written down."""
    assert friction.shear_over_bulk(poisson) == pytest.approx(ratio, rel=1e-14)


@given(d=st.lists(rates, min_size=6, max_size=6), squeeze=rates)
def test_second_invariant_is_half_the_square_of_the_deviator(d, squeeze):
    tensor = np.array([[d[0], d[3], d[5]], [d[3], d[1], d[4]], [d[5], d[4], d[2]]])
    deviator = tensor - np.trace(tensor) / 3.0 * np.eye(3)
    computed = friction.second_invariant(*d)
    assert computed == pytest.approx(0.5 * np.sum(deviator**2), rel=1e-12, abs=1e-10)
    swollen = friction.second_invariant(d[0] + squeeze, d[1] + squeeze, d[2] + squeeze, *d[3:])
    assert swollen == pytest.approx(computed, rel=1e-9, abs=1e-9)


def test_stress_on_a_wall_by_hand():
    """phi 0.5, rho_p 2000, alpha_p 0.3 of 0.6, g0 4, theta 0.0012: 0.5 pi 2000 0.3 4 0.06/3.6 = 20 pi."""
    assert friction.johnson_jackson_wall(0.5, 0.3, 0.0012, 4.0, 2000.0, 0.6) == pytest.approx(20.0 * math.pi, rel=1e-12)


def test_slope_starts_at_the_yield_angle():
    angle = math.radians(28.5)
    start = exact.yield_slope(angle)
    assert exact.slope_acceleration(start - 1e-6, angle, 9.81) == 0.0
    assert exact.slope_acceleration(start + 1e-6, angle, 9.81) > 0.0
    assert exact.slope_acceleration(math.pi / 2.0, angle, 9.81) == pytest.approx(9.81, rel=1e-12)
