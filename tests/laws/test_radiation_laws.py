"""Cooling by radiation: the closed forms themselves, their limits, and the law of exchange."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sdph.laws import radiation
from sdph.laws.constants import STEFAN_BOLTZMANN


def test_a_black_body_at_1000_k():
    """56.70 kW/m2 (CODATA 2018)."""
    assert pytest.approx(56703.74419, rel=1e-10) == STEFAN_BOLTZMANN * 1000.0**4
    assert radiation.exchange_coefficient(1000.0, 300.0) * 700.0 == pytest.approx(
        STEFAN_BOLTZMANN * (1000.0**4 - 300.0**4), rel=1e-14
    )


def time_to(end, start, surroundings):
    """k t [1/K3] of Incropera & DeWitt, Eq. 5.18, in which ln and arctan are those of the temperatures."""
    s = surroundings
    logs = math.log(abs((s + end) / (s - end))) - math.log(abs((s + start) / (s - start)))
    return (logs + 2.0 * (math.atan(end / s) - math.atan(start / s))) / (4.0 * s**3)


@pytest.mark.parametrize(
    ("start", "surroundings"), [(1500.0, 300.0), (800.0, 500.0), (300.0, 1500.0), (1.0, 1500.0), (310.0, 300.0)]
)
@pytest.mark.parametrize("way", [0.01, 0.3, 0.9, 0.999])
def test_cooling_and_warming_against_the_closed_form(start, surroundings, way):
    end = start + way * (surroundings - start)
    found = radiation.cooled(start, surroundings, 1e-11, time_to(end, start, surroundings) / 1e-11)
    assert found - surroundings == pytest.approx(end - surroundings, rel=1e-9)


def test_cold_surroundings_are_those_at_zero():
    for time in (1e-3, 1.0, 1e3):
        at_zero = radiation.cooled(1200.0, 0.0, 1e-10, time)
        assert at_zero == pytest.approx((1200.0**-3 + 3e-10 * time) ** (-1.0 / 3.0), rel=1e-14)
        assert radiation.cooled(1200.0, 1e-3, 1e-10, time) == pytest.approx(at_zero, rel=1e-12)


@given(start=st.floats(0.1, 5000.0), surroundings=st.floats(0.0, 5000.0), lam=st.floats(1e-12, 1e12))
def test_never_beyond_the_surroundings_and_a_flow(start, surroundings, lam):
    """Two halves make the whole, nobody passes the surroundings, in 1e-12 to 1e12 relaxation times."""
    rate = 1e-11
    time = lam / (rate * max(start, surroundings) ** 3)
    whole, half = (
        radiation.cooled(start, surroundings, rate, time),
        radiation.cooled(start, surroundings, rate, 0.5 * time),
    )
    low, high = sorted((start, surroundings))
    assert low <= half <= high and low <= whole <= high
    assert abs(whole - surroundings) <= abs(half - surroundings)
    assert radiation.cooled(half, surroundings, rate, 0.5 * time) == pytest.approx(whole, rel=1e-12)
