"""TAB: exact solution against the differential equation, critical Weber number, times and products of the source."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import expm
from scipy.optimize import brentq

from sdph.laws import break_up as law
from sdph.laws import grain_sizes

RADIUS, DENSITY, SIGMA, GAS = 50e-6, 700.0, 0.024, 1.2  # m, kg/m3, N/m, kg/m3


def coefficients(number, viscosity):
    return law.rest(number), law.decay(RADIUS, DENSITY, viscosity), law.stiffness(RADIUS, DENSITY, SIGMA)


def swung(number, viscosity, start, time):
    """(y, rate) (..., 2) after times (...) [s] by O'Rourke & Amsden 1987, Eq. 4, with the slip of a Weber number: the
    exponential of its matrix, which no step errs in."""
    slip = math.sqrt(number * SIGMA / (GAS * RADIUS))
    force = (1 / 3) / (1 / 2) * GAS * slip**2 / (DENSITY * RADIUS**2)
    spring, damping = 8.0 * SIGMA / (DENSITY * RADIUS**3), 5.0 * viscosity / (DENSITY * RADIUS**2)
    matrix = np.array([[0.0, 1.0, 0.0], [-spring, -damping, force], [0.0, 0.0, 0.0]])
    return (expm(matrix * np.asarray(time)[..., None, None]) @ (*start, 1.0))[..., :2]


VISCOUS = st.one_of(st.floats(1e-6, 1e-2), st.floats(2e-2, 3e-1))  # Pa s: swings below 0.033, creeps above


@settings(max_examples=40, deadline=None)
@given(number=st.floats(0.0, 40.0), viscosity=VISCOUS, y=st.floats(-0.5, 0.99), speed=st.floats(-1.0, 1.0))
def test_the_exact_solution_is_that_of_the_equation(number, viscosity, y, speed):
    """Value, rate, first top and time to break, swinging or creeping."""
    own = coefficients(number, viscosity)
    swing = math.sqrt(own[2])
    start, end = (y, speed * swing), 8.0 / swing

    for time in np.linspace(0.0, end, 7):
        there = swung(number, viscosity, start, time)
        np.testing.assert_allclose(law.after(*start, *own, time), there, rtol=1e-9, atol=1e-10 * swing)
    times = np.linspace(0.0, end, 4001)
    there = swung(number, viscosity, start, times)[:, 0]
    if abs(there.max() - 1.0) > 1e-6:  # neither grazes 1
        past = int(np.argmax(there > 1.0))
        first = math.inf
        if past:
            first = brentq(lambda t: swung(number, viscosity, start, t)[0] - 1.0, *times[past - 1 : past + 1])
        assert law.time_to_break(*start, *own, end) == pytest.approx(first, rel=1e-6)


@pytest.mark.parametrize(("number", "breaks"), [(5.999, False), (6.001, True)])
def test_critical_weber_number(number, breaks):
    """6 of the radius, from rest, without viscosity: O'Rourke & Amsden 1987."""
    assert pytest.approx(6.0) == law.CRITICAL_WEBER
    time = law.time_to_break(0.0, 0.0, *coefficients(number, 0.0), 1.0)
    assert math.isfinite(time) == breaks
    if breaks:  # at the top of the first swing
        assert time == pytest.approx(math.pi / math.sqrt(law.stiffness(RADIUS, DENSITY, SIGMA)), rel=0.02)


def test_fast_drops_break_as_the_source_says():
    """sqrt(3) r/u sqrt(rho/rho_g) and rate 2/time, for large Weber numbers; radius by the energy of both."""
    number = 1e6
    slip = math.sqrt(number * SIGMA / (GAS * RADIUS))
    own = coefficients(number, 0.0)
    time = law.time_to_break(0.0, 0.0, *own, 1.0)
    assert time == pytest.approx(math.sqrt(3.0) * RADIUS / slip * math.sqrt(DENSITY / GAS), rel=1e-5)
    rate = law.after(0.0, 0.0, *own, time)[1]
    assert rate == pytest.approx(2.0 / time, rel=1e-5)


@given(st.floats(0.0, 1e7))
def test_products_have_the_energy_of_the_swing(rate):
    """Surface, swing of K times the lowest mode before; surface of the products and their parting after."""
    product, w2 = law.product_radius(RADIUS, rate, DENSITY, SIGMA), law.stiffness(RADIUS, DENSITY, SIGMA)
    before = 4.0 * math.pi * RADIUS**2 * SIGMA
    before += law.ENERGY * math.pi / 5.0 * DENSITY * RADIUS**5 * (rate**2 + w2)
    mass = 4.0 / 3.0 * math.pi * RADIUS**3 * DENSITY
    after = 4.0 * math.pi * RADIUS**3 * SIGMA / product + 0.5 * mass * law.parting_speed(RADIUS, rate) ** 2
    assert after == pytest.approx(before, rel=1e-12)


def test_products_of_the_source_keep_their_moments():
    """Number by r exp(-r/mean): <d^2> = 2, <d^3> = 6 of the mean's powers; Sauter mean three times the mean."""
    second, third = 2.0 / 9.0, 6.0 / 27.0
    assert grain_sizes.of_moments(second, third) == (law.CHI_MEAN, law.CHI_VARIANCE)
    assert pytest.approx(second, rel=1e-13) == law.CHI_MEAN**2 + law.CHI_VARIANCE
    assert law.sauter_diameter(law.CHI_MEAN, law.CHI_VARIANCE) == pytest.approx(third / second, rel=1e-13)
