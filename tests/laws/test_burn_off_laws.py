"""Burn-off of a sphere: its law against its own differential equation and both limits; numbers worked out apart."""

import math

import pytest
from scipy.integrate import solve_ivp

from sdph.laws import burn_off as law

D, DIAMETER = 2e-4, 1e-3  # m2/s, m


def test_arrhenius():
    assert law.surface_velocity(500.0, 9000.0, 1200.0) == pytest.approx(500.0 * math.exp(-7.5), rel=1e-14)


@pytest.mark.parametrize("film", [0.0, 1.0])
def test_gas_that_is_stripped(film):
    """6 V k/d of spheres, 1/k = 1/k_s + d/(Sh D), Sh = 2 (1 + 20 sqrt(0.001)), by hand."""
    k = 1.0 / (1.0 / 0.3 + film * 1e-3 / (3.264911064067352 * D))
    assert law.gas_stripped(2e-9, 1e-3, D / 0.3, 20.0, D, film) == pytest.approx(6.0 * 2e-9 * k / 1e-3, rel=1e-13)


@pytest.mark.parametrize("ventilation", [0.0, 30.0])
@pytest.mark.parametrize("k_s", [1e-3, 0.3, 50.0])
@pytest.mark.parametrize("film", [0.0, 1.0])
@pytest.mark.parametrize("share", [0.2, 0.9, 0.999])
def test_the_diameter_follows_its_equation(ventilation, k_s, film, share):
    """dd/d(loss) = -1/S'(d), S' = 4 l + 2 d/(1 + c sqrt(d)), from d_0 to most of the way."""
    slow = D / k_s
    loss = share * law.scale(DIAMETER, slow, ventilation, film)

    def fall(s, d):
        root = math.sqrt(max(d[0], 0.0))
        return [-1.0 / (4.0 * slow + film * 2.0 * d[0] / (1.0 + ventilation * root))]

    expected = solve_ivp(fall, (0.0, loss), [DIAMETER], rtol=1e-11, atol=1e-15).y[0, -1]
    found = law.diameter_after(DIAMETER, loss, slow, ventilation, film)
    assert found == pytest.approx(expected, rel=2e-5, abs=1e-9)  # the scale G is good to 1e-6
    assert law.scale(found, slow, ventilation, film) == pytest.approx(
        law.scale(DIAMETER, slow, ventilation, film) - loss, rel=1e-11
    )


def test_limits_of_slow_and_fast_surfaces():
    half = law.diameter_after(DIAMETER, 0.5 * law.scale(DIAMETER, 1e3, 0.0, 1.0), 1e3, 0.0, 1.0)
    assert half == pytest.approx(0.5 * DIAMETER, rel=1e-6)
    fast = law.diameter_after(DIAMETER, 0.75 * DIAMETER**2, 1e-12, 0.0, 1.0)
    assert fast == pytest.approx(0.5 * DIAMETER, rel=1e-6)
    assert law.diameter_after(DIAMETER, 2.0 * law.scale(DIAMETER, 1e-4, 5.0, 1.0), 1e-4, 5.0, 1.0) == 0.0


def test_mean_content():
    """(1 - exp(-x))/x, by hand; all of it where nothing is taken."""
    assert law.mean_content(2.0) == pytest.approx(0.43233235838169365, rel=1e-14)
    assert law.mean_content(0.0) == 1.0 and law.mean_content(1e-12) == pytest.approx(1.0, rel=1e-11)
