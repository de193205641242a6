import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sdph.laws import eos, viscosity

WATER = 1000.0, 30.0, 7.0  # kg/m3, m/s, -


@given(ratio=st.floats(0.9, 1.2), exponent=st.sampled_from([1.0, 7.0]), background=st.floats(0.0, 1e5))
def test_tait_and_its_inverse(ratio, exponent, background):
    rho = 1000.0 * ratio
    p = eos.tait_pressure(rho, 1000.0, 30.0, exponent, background)
    assert eos.tait_density(p, 1000.0, 30.0, exponent, background) == pytest.approx(rho, rel=1e-11)


@given(ratio=st.floats(0.9, 1.2))
def test_sound_speed_is_the_slope_of_the_pressure(ratio):
    rho, step = 1000.0 * ratio, 1e-2
    high, low = (eos.tait_pressure(rho + s, *WATER, 0.0) for s in (step, -step))
    assert eos.tait_sound_speed(rho, *WATER) ** 2 == pytest.approx((high - low) / (2.0 * step), rel=1e-6)


def test_tait_at_reference():
    assert eos.tait_pressure(1000.0, *WATER, 5.0) == 5.0
    assert eos.tait_sound_speed(1000.0, *WATER) == 30.0


@given(p=st.floats(1e4, 1e7), t=st.floats(200.0, 2000.0), w=st.floats(2.0, 300.0))
def test_ideal_gas_and_its_inverse(p, t, w):
    assert eos.ideal_gas_pressure(eos.ideal_gas_density(p, t, w), t, w) == pytest.approx(p, rel=1e-13)


def test_density_of_air():
    assert eos.ideal_gas_density(101325.0, 288.15, 28.9647) == pytest.approx(1.225, abs=5e-5)  # ISO 2533 sea level


@given(approach=st.floats(-1.0, 1.0), r=st.floats(0.0, 0.02))
def test_artificial_viscosity_resists_approach_only(approach, r):
    pi = viscosity.monaghan(approach, r * r, 0.01, 5.0, 1836.0, 0.1, 0.2)
    assert math.isfinite(pi) and (pi > 0.0) == (approach < 0.0)
    assert pi >= 0.0


@given(approach=st.floats(-1.0, -1e-6))
def test_quadratic_part_is_twice_the_whole_at_twice_the_speed(approach):
    """Without the linear term Pi grows as the square of the speed of approach."""
    once, twice = (viscosity.monaghan(f * approach, 1e-4, 0.01, 5.0, 1836.0, 0.0, 0.2) for f in (1.0, 2.0))
    assert twice == pytest.approx(4.0 * once, rel=1e-12)
