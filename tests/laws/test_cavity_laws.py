"""Bubbles and vents against closed forms."""

import math

import pytest
from gel_values import VALUES, VAPOUR

from sdph.laws import cavities, real_gas
from sdph.laws.constants import GAS_CONSTANT

DENSITY = 5.0  # kg/m3, of the closed forms


def grown(dims, heat, end, steps=4000):
    """Radius [m] of a bubble of 0.15 mm at constant pressure after `end` [s] of a heat [W] by its radius."""
    radius = 1.5e-4
    for _ in range(steps):
        dt = end / steps
        half = radius
        for part in (0.5 * dt, dt):
            boiled = cavities.boiled(VAPOUR, heat(half) * part, 1.0, 0.0)
            half = cavities.radius(cavities.void(radius, dims) + boiled / DENSITY, dims)
        radius = half
    return radius


@pytest.mark.parametrize("dims", [2, 3])
def test_growth_under_a_flux(dims):
    surface = {2: lambda r: 2.0 * math.pi * r, 3: lambda r: 4.0 * math.pi * r * r}[dims]
    assert grown(dims, lambda r: 1000.0 * surface(r), 0.3) == pytest.approx(VALUES["bubble_flux_2d"], rel=1e-6)


@pytest.mark.parametrize(("dims", "power"), [(2, 2.0), (3, 0.003)])
def test_growth_under_a_power(dims, power):
    assert grown(dims, lambda r: power, 0.5) == pytest.approx(VALUES[f"bubble_power_{dims}d"], rel=1e-8)


def test_laplace():
    assert cavities.capillary_pressure(0.025, 1.5e-4, 2) == pytest.approx(VALUES["laplace_2d"], rel=1e-12)
    assert cavities.capillary_pressure(0.025, 5e-4, 3) == pytest.approx(VALUES["laplace_3d"], rel=1e-12)


def test_what_boils_takes_the_heat():
    for heat in (3.0, -3.0):
        boiled = cavities.boiled(VAPOUR, heat, 2e-6, 1.5)
        assert cavities.heat_taken(VAPOUR, boiled, 2e-6, 1.5) == pytest.approx(heat, rel=1e-14)
    assert cavities.boiled(VAPOUR, 0.0, 2e-6, 1.5) < 0.0  # warmer without heat: some condenses


@pytest.mark.parametrize("gamma", [1.02, 1.05])
def test_critical_ratio(gamma):
    ratio = cavities.critical_ratio(gamma)
    assert ratio == pytest.approx(VALUES[f"vent_critical_{gamma}"], rel=1e-8)
    assert 101325.0 * (1.0 / ratio - 1.0) == pytest.approx(VALUES[f"vent_choking_ends_{gamma}"], rel=1e-8)


def flux(pressure, temperature=530.88, outside=0.0):
    return cavities.vent_flux(pressure, temperature, outside, 170.33, 1.02)


def test_vent_of_a_slit():
    assert flux(247488.0, outside=101325.0) == pytest.approx(VALUES["vent_flux"], rel=1e-8)
    mass = 247488.0 * 8.35e-7 * 170.33 / (GAS_CONSTANT * 530.88)
    assert mass / (1e-4 * flux(247488.0)) == pytest.approx(VALUES["vent_time_constant"], rel=1e-8)


def test_vent_into_vacuum_that_cools():
    """p ~ rho^gamma and dm/dt = -w G: p/p0 when the time constant of the start is over."""
    share, steps = 1.0, 2000  # of the mass
    for _ in range(steps):
        half = share
        for part in (0.5, 1.0):
            now = flux(half**1.02, half**0.02) / flux(1.0, 1.0)
            half = share - part * now / steps
        share = half
    assert share**1.02 == pytest.approx(VALUES["vent_adiabatic_half"], rel=1e-6)


def test_a_vent_is_continuous_where_it_chokes_and_none_at_even_pressure():
    critical = 101325.0 / cavities.critical_ratio(1.02)
    below, above = (flux(critical * f, outside=101325.0) for f in (1.0 - 1e-9, 1.0 + 1e-9))
    assert below == pytest.approx(above, rel=1e-8)
    assert flux(101325.0, outside=101325.0) == flux(9e4, outside=101325.0) == 0.0
    assert 0.0 < flux(1.1e5, outside=101325.0) < flux(1.1e5)


def test_bubbles_that_merge_keep_mass_and_heat():
    temperatures, voids = (500.0, 515.0), (2e-8, 1e-8)
    masses = tuple(real_gas.saturated_density(VAPOUR, T) * A for T, A in zip(temperatures, voids))
    common, boiled = cavities.merged(VAPOUR, masses, voids, temperatures)
    assert real_gas.saturated_density(VAPOUR, common) == pytest.approx(sum(masses) / sum(voids), rel=1e-12)
    freed = sum(m * (T - common) for m, T in zip(masses, temperatures)) * VAPOUR.heat_capacity
    assert cavities.heat_taken(VAPOUR, boiled, 0.0, 0.0) == pytest.approx(freed, rel=1e-9)
    alike = cavities.merged(VAPOUR, (masses[0], masses[0]), (voids[0], voids[0]), (500.0, 500.0))
    assert alike == (500.0, 0.0)
