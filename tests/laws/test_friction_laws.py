import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sdph.laws import exact, friction
from sdph.laws.constants import FRICTION_ETA, FRICTION_FR, FRICTION_P, FRICTION_SCHAEFFER, FRICTION_SCHAEFFER_POWER

JOHNSON_JACKSON = 0.6, 0.63, FRICTION_FR, FRICTION_ETA, FRICTION_P
SCHAEFFER = 0.6, FRICTION_SCHAEFFER, FRICTION_SCHAEFFER_POWER
LAWS = [
    (friction.johnson_jackson_pressure, friction.johnson_jackson_slope, JOHNSON_JACKSON),
    (friction.schaeffer_pressure, friction.schaeffer_slope, SCHAEFFER),
]
rates = st.floats(-100.0, 100.0)


@pytest.mark.parametrize("pressure, slope, p", LAWS)
@given(alpha_p=st.floats(0.6005, 0.625))
def test_slope_of_the_frictional_pressure(pressure, slope, p, alpha_p):
    step = 1e-7
    difference = (pressure(alpha_p + step, *p) - pressure(alpha_p - step, *p)) / (2.0 * step)
    assert pressure(alpha_p, *p) > 0.0
    assert slope(alpha_p, *p) == pytest.approx(difference, rel=1e-5)


@pytest.mark.parametrize("pressure, slope, p", LAWS)
@given(alpha_p=st.floats(0.0, 0.6))
def test_no_friction_below_the_threshold_and_a_smooth_start(pressure, slope, p, alpha_p):
    assert pressure(alpha_p, *p) == slope(alpha_p, *p) == 0.0
    assert 0.0 <= pressure(0.6 + 1e-9, *p) < 1e-9
    assert 0.0 <= slope(0.6 + 1e-9, *p) < 1.0


@given(rate=st.floats(1e-2, 1e4), pressure=st.floats(0.0, 1e6), degrees=st.floats(5.0, 45.0))
def test_grains_yield_at_pressure_times_sine_of_the_angle(rate, pressure, degrees):
    sine = math.sin(math.radians(degrees))
    invariant = friction.second_invariant(0.0, 0.0, 0.0, 0.5 * rate, 0.0, 0.0)
    assert friction.schaeffer_viscosity(pressure, sine, invariant, 0.0) * rate == pytest.approx(
        pressure * sine, rel=1e-12
    )


def test_viscosity_of_grains_at_rest_is_finite():
    assert friction.schaeffer_viscosity(1000.0, 0.5, 0.0, 0.1) == pytest.approx(2500.0, rel=1e-13)


@given(d=st.lists(rates, min_size=6, max_size=6), squeeze=rates)
def test_second_invariant_is_half_the_square_of_the_deviator(d, squeeze):
    tensor = np.array([[d[0], d[3], d[5]], [d[3], d[1], d[4]], [d[5], d[4], d[2]]])
    deviator = tensor - np.trace(tensor) / 3.0 * np.eye(3)
    computed = friction.second_invariant(*d)
    assert computed == pytest.approx(0.5 * np.sum(deviator**2), rel=1e-12, abs=1e-10)
    swollen = friction.second_invariant(d[0] + squeeze, d[1] + squeeze, d[2] + squeeze, *d[3:])
    assert swollen == pytest.approx(computed, rel=1e-9, abs=1e-9)


def test_slope_starts_at_the_yield_angle():
    angle = math.radians(28.5)
    start = exact.yield_slope(angle)
    assert exact.slope_acceleration(start - 1e-6, angle, 9.81) == 0.0
    assert exact.slope_acceleration(start + 1e-6, angle, 9.81) > 0.0
    assert exact.slope_acceleration(math.pi / 2.0, angle, 9.81) == pytest.approx(9.81, rel=1e-12)
