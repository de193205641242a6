"""Heat from a wall to grains: Schluender's wedge against its integral, VDI's numbers, a half-space against its own."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.special import erfcx

from sdph.laws import wall_heat as law

AIR = 0.0242, 1006.43, 28.96, 288.0, 101325.0  # k, c_p, M, T, p


@given(st.floats(1e-6, 1e-1), st.floats(1e-9, 1e-6))
def test_the_wedge_is_the_integral_over_a_spheres_shadow(diameter, gap):
    """Of rings 2 pi r dr of gas g + R - sqrt(R^2 - r^2) thick, in layers, over pi R^2; with c = sqrt(R^2 - r^2)."""
    radius = 0.5 * diameter
    ratio = gap / radius  # parts of R: 2 int_0^1 c dc/(ratio + 1 - c)
    layers = quad(lambda c: 2.0 * c / (ratio + 1.0 - c), 0.0, 1.0, epsrel=1e-11, points=[1.0 - ratio], limit=200)[0]
    assert law.schluender(diameter, 0.03, gap) == pytest.approx(0.03 / radius * layers, rel=1e-7)


def test_glass_beads_in_air_by_hand():
    """R = 287.1 J/(kg K): sqrt(2 pi 287.1 288) = 720.8 m/s, Lambda = 1.00e-7 m, gamma = 0.903, l = 2.43e-7 m; for 0.5
    mm Nu = 4 (1.000972 ln 1029.8 - 1) = 23.77."""
    gamma = law.accommodation_of_air(288.0)
    assert math.log10(1.0 / gamma - 1.0) == pytest.approx(0.6 - (1000.0 / 288.0 + 1.0) / 2.8, rel=1e-12)
    assert gamma == pytest.approx(0.908, abs=2e-3)
    jump = law.temperature_jump(*AIR, gamma)
    assert jump == pytest.approx(2.0 * (2.0 / gamma - 1.0) * 720.8 * 0.0242 / (101325.0 * (2012.86 - 287.1)), rel=1e-3)
    assert law.schluender(5e-4, 0.0242, jump) * 5e-4 / 0.0242 == pytest.approx(23.8, abs=0.1)


@given(st.floats(0.0, 1e3))
def test_erfcx(x):
    assert law.erfcx(x) == pytest.approx(erfcx(x), rel=2e-5 if x >= law.SERIES else 1e-11)


def test_a_packet_begins_at_its_contact_and_ends_at_what_lies_before_it():
    """At first h; then as a half-space, whose heat is that of Carslaw & Jaeger; in the end 1/(1/h + way/k)."""
    h, k, stored, way = 800.0, 0.15, 1.2e6, 2e-3
    assert law.passed(h, k, stored, way, 0.0) == h
    end = 0.9 * way**2 * stored / (math.pi * k)
    found = quad(lambda t: law.passed(h, k, stored, way, t), 0.0, end, epsrel=1e-9)[0]
    x = h * math.sqrt(end / (k * stored))
    assert found == pytest.approx(k * stored / h * (erfcx(x) - 1.0 + 2.0 * x / math.sqrt(math.pi)), rel=1e-7)
    assert law.passed(h, k, stored, way, 1e4) == pytest.approx(1.0 / (1.0 / h + way / k), rel=1e-12)
    assert law.passed(h, k, stored, 0.0, 1e4) == h  # on the wall
