import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sdph.laws import eos, viscosity


def stiffness(exponent, sound_speed=30.0, density=1000.0):
    return density * sound_speed**2 / exponent


@given(ratio=st.floats(0.9, 1.2), exponent=st.sampled_from([1.0, 1.4, 7.0]), background=st.floats(0.0, 1e5))
def test_tait_and_its_inverse(ratio, exponent, background):
    p = eos.tait_pressure(ratio, stiffness(exponent), exponent, background)
    assert eos.tait_density(p, 1000.0, 30.0, exponent, background) == pytest.approx(1000.0 * ratio, rel=1e-11)


@given(ratio=st.floats(0.9, 1.2), exponent=st.sampled_from([1.0, 1.4, 7.0]))
def test_tait_is_its_power(ratio, exponent):
    expected = stiffness(exponent) * (ratio**exponent - 1.0) + 5.0
    assert eos.tait_pressure(ratio, stiffness(exponent), exponent, 5.0) == pytest.approx(expected, rel=1e-12, abs=1e-9)


def test_tait_at_reference():
    """The background; and the speed of sound as the slope of the pressure."""
    assert eos.tait_pressure(1.0, stiffness(7.0), 7.0, 5.0) == 5.0
    high, low = (eos.tait_pressure(1.0 + step, stiffness(7.0), 7.0, 0.0) for step in (1e-5, -1e-5))
    assert (high - low) / (2e-5 * 1000.0) == pytest.approx(30.0**2, rel=1e-8)


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
