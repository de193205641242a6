import math

import exact_solutions as exact
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sdph.laws import friction, granular
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


@pytest.mark.parametrize(("friction_of_wall", "restitution", "phi"), [(0.1, 0.9, 0.0532), (0.2, 0.7, 0.0789)])
def test_specularity_of_a_wall_that_grains_stick_to(friction_of_wall, restitution, phi):
    """Li & Benyahia's polynomial of k = 7/2 mu (1 + e), 0.665 and 1.19, written out by hand to four digits."""
    assert friction.sliding(friction_of_wall, restitution) == pytest.approx(
        3.5 * friction_of_wall * (1.0 + restitution)
    )
    assert friction.sticking_specularity(friction_of_wall, restitution) == pytest.approx(phi, abs=1e-4)


def test_smooth_walls_begin_straight():
    """From no friction on; at k = 0.2 the fit goes on within 2 %."""
    assert friction.sticking_specularity(0.0, 0.9) == 0.0
    below, above = (friction.sticking_specularity((0.2 + s) / 7.0, 1.0) for s in (-1e-9, 1e-9))
    assert below == pytest.approx(0.2 * 0.0909457, rel=1e-6) and above == pytest.approx(below, rel=0.02)


@given(alpha_p=st.floats(0.01, 0.6), mu=st.floats(0.01, 1.0), e=st.floats(0.1, 1.0), slip=st.floats(50.0, 1e3))
def test_grains_that_all_slide_rub_by_coulombs_part_of_the_pressure(alpha_p, mu, e, slip):
    theta, density, most = 0.01, 2500.0, 0.63
    g0 = granular.sinclair_jackson(alpha_p, most)
    phi = friction.sliding_specularity(friction.sticking_specularity(mu, e), friction.sliding(mu, e), slip, theta)
    k = friction.johnson_jackson_wall(phi, alpha_p, theta, g0, density, most)
    stress = k * friction.load_of_pressure(alpha_p, e, g0, most) * slip
    assert stress == pytest.approx(mu * granular.lun_pressure(alpha_p, theta, e, g0, density), rel=1e-9)


@given(mu=st.floats(0.01, 1.0), theta=st.floats(1e-6, 1.0), fast=st.floats(1.0, 100.0))
def test_the_stress_of_grains_that_all_slide_does_not_grow(mu, theta, fast):
    """phi falls as one over the slip beyond the turn, where it is half of what it is without, and meets there."""
    k, phi = friction.sliding(mu, 0.9), friction.sticking_specularity(mu, 0.9)
    turn = 4.0 * k / (7.0 * math.sqrt(6.0 * math.pi) * phi) * math.sqrt(3.0 * theta)
    before, beyond = (friction.sliding_specularity(phi, k, turn * s, theta) for s in (1.0 - 1e-9, 1.0 + 1e-9))
    assert before == pytest.approx(0.5 * phi, rel=1e-6) and beyond == pytest.approx(before, rel=1e-6)
    assert friction.sliding_specularity(phi, k, turn * fast, theta) * fast == pytest.approx(0.5 * phi, rel=1e-6)
    assert friction.sliding_specularity(phi, k, 0.5 * turn, theta) == pytest.approx(0.75 * phi, rel=1e-9)
    assert [friction.sliding_specularity(phi, k, slip, 0.0) for slip in (0.0, fast)] == [phi, 0.0]
