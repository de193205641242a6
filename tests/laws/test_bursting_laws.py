"""Droplets that burst: settled conduction, flash, sizes after a tear, and the swelling of a droplet with one
temperature."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad, solve_bvp

from sdph.effects.gas import gel
from sdph.laws import bursting, cavities, gel_droplet, real_gas, swelling

ratios, shares = st.floats(0.02, 1.0), st.floats(0.0, 1.0)
DENSITY, HEAT_CAPACITY, CONDUCTIVITY, LATENT = 1500.0, 5000.0, 0.5, 2.5e5  # the gel of Qiang et al. 2017
DIAMETER, PRESSURE = 8e-5, 101325.0
SHELL, FUEL = gel.Shell(), gel.Fuel()
VAPOUR, PLASTIC, DAMAGE = gel.vapour(FUEL), gel.plastic(SHELL), gel.damage(SHELL)
AROUND = gel_droplet.Around(3, PRESSURE, 0.025, *gel.moduli(SHELL))


def settled(inner, outer, into_rim, into_bubble):
    """T_mean - T(inner) [K] by solving k (r^2 T')'/r^2 = s with T' given at both faces."""
    volume = 4.0 / 3.0 * math.pi * (outer**3 - inner**3)
    source = (into_rim - into_bubble) / volume

    def slopes(r, y):
        return np.vstack((y[1], source / CONDUCTIVITY - 2.0 * y[1] / r))

    def ends(a, b):
        return np.array([a[0], a[1] - into_bubble / (4.0 * math.pi * inner**2 * CONDUCTIVITY)])

    r = np.linspace(inner, outer, 200)
    found = solve_bvp(slopes, ends, r, np.zeros((2, len(r))), tol=1e-10, max_nodes=100_000)
    assert found.success
    return quad(lambda x: 4.0 * math.pi * x * x * found.sol(x)[0], inner, outer, epsabs=0.0)[0] / volume


@pytest.mark.parametrize("inner", [0.1, 0.3, 0.8])
@pytest.mark.parametrize("heats", [(1.0, 0.0), (0.0, 1.0), (1.0, 1.0)])
def test_lags_are_those_of_settled_conduction(inner, heats):
    a, b = bursting.lags(inner, 1.0, CONDUCTIVITY)
    assert a * (heats[0] - heats[1]) + b * heats[1] == pytest.approx(settled(inner, 1.0, *heats), rel=1e-7)


def test_the_middle_of_a_ball_lags_by_three_tenths_of_q_r_over_k():
    """Carslaw & Jaeger 1959, section 9.7: T_mean - T(0) = 3 q R/(10 k)."""
    a, _ = bursting.lags(1e-9, 2.0, CONDUCTIVITY)
    assert a * 4.0 * math.pi * 4.0 == pytest.approx(0.3 * 2.0 / CONDUCTIVITY, rel=1e-6)


@given(cooling=st.floats(1e-6, 500.0))
def test_flash_pays_for_its_vapour(cooling):
    """m c dT = L dm, step by step; never more than all of it, c dT/L where that is small."""
    share, steps = bursting.flashed_share(HEAT_CAPACITY, cooling, LATENT), 2000
    left = (1.0 - HEAT_CAPACITY * cooling / steps / LATENT) ** steps
    assert 0.0 < share < 1.0 and 1.0 - share == pytest.approx(left, abs=0.02)
    assert bursting.flashed_share(HEAT_CAPACITY, 1e-3, LATENT) == pytest.approx(HEAT_CAPACITY * 1e-3 / LATENT, rel=1e-4)


@given(thrown=shares, ratio=ratios, mean=st.floats(1e-6, 1e-3), spread=st.floats(0.0, 0.6))
def test_a_tear_keeps_the_mass_and_makes_the_surface_of_its_droplets(thrown, ratio, mean, spread):
    """Of all its parents: number, surface and volume of what each throws and of what remains of it."""
    variance = (spread * mean) ** 2
    second, third = bursting.raw_moments(mean, variance)
    number, own_mean, own_variance = bursting.torn_sizes(mean, variance, thrown, ratio)
    small, remains = thrown / ratio**3, thrown < 1.0
    assert number == pytest.approx(small + remains, rel=1e-12)
    after = bursting.raw_moments(own_mean, own_variance)
    assert number * after[1] == pytest.approx(third, rel=1e-12)
    surface = small * ratio**2 + (1.0 - thrown) ** (2.0 / 3.0) if remains else small * ratio**2
    assert number * after[0] == pytest.approx(surface * second, rel=1e-12)


def test_a_tear_that_throws_nothing_changes_nothing():
    number, mean, variance = bursting.torn_sizes(1e-4, 4e-10, 0.0, 0.3)
    assert (number, mean, variance) == pytest.approx((1.0, 1e-4, 4e-10), rel=1e-12)


def test_a_film_of_water_draws_back_as_taylor_and_culick_say():
    """Speed sqrt(2 sigma/(rho h)): 12 m/s of a film of 1 um, 72 mN/m."""
    assert 1e-3 / bursting.opening_time(1e-3, 1e-6, 0.072, 1000.0) == pytest.approx(12.0, rel=1e-12)


def test_sauter_diameter_is_that_of_a_sample():
    sample = np.random.default_rng(3).lognormal(-9.0, 0.3, 400_000)
    found = bursting.sauter(sample.mean(), sample.var())
    assert found == pytest.approx((sample**3).sum() / (sample**2).sum(), rel=5e-3)


def droplet(flaw=0.07):
    return swelling.droplet(VAPOUR, AROUND, 0.3, 0.05, DIAMETER, DENSITY, HEAT_CAPACITY, CONDUCTIVITY, flaw)


def first(d, power):
    """A droplet whose bubble has just come to be under a power [W]: its middle boils."""
    boiling = swelling.nucleus(VAPOUR, AROUND, d.first)
    bubble = gel_droplet.Bubble(d.seed, cavities.void(d.first, 3), boiling)
    lag, _ = bursting.lags(d.first, d.outer, CONDUCTIVITY)
    return swelling.Swollen(bubble, boiling + lag * power, 0.0, 0.0)


def grown(d, power, window, most=2000):
    """The droplet at its tear under a power [W], the time of that, its wall, and what heat is missing."""
    now, shell, spot, wall, windows = first(d, power), np.zeros((4, 1)), np.zeros(4), 0.0, 0
    start = now.temperature
    while wall == 0.0 and windows < most:
        now, wall = swelling.swell(d, VAPOUR, PLASTIC, DAMAGE, AROUND, power, now, window, shell, spot)
        windows += 1
    heat = (now.temperature - start) * d.capacity + now.taken
    return now, heat / power, wall, windows * window


def test_heat_is_kept_and_windows_do_not_matter():
    power = math.pi * DIAMETER**2 * 1e6
    d = droplet()
    for window in (1e-4, 1e-3):
        now, time, wall, end = grown(d, power, window)
        assert end - window < time <= end and 0.1 * DIAMETER < wall < 0.3 * DIAMETER
        boiled = LATENT * (now.bubble.mass - d.seed)
        warmed = FUEL.saturated_heat_capacity * now.bubble.mass * (now.bubble.temperature - first(d, 0.0).temperature)
        assert boiled < now.taken < boiled + warmed
    assert time == pytest.approx(grown(d, power, 1e-4)[1], rel=2e-3)


def test_the_shell_tears_by_its_flaw_and_later_without():
    power = math.pi * DIAMETER**2 * 1e6
    with_flaw, without = grown(droplet(), power, 1e-3)[0], grown(droplet(0.0), power, 1e-3)[0]
    assert with_flaw.hoop > 0.3 and without.hoop == 0.0
    assert without.bubble.void > with_flaw.bubble.void


def test_a_bubble_condenses_where_heat_is_taken_from_the_rim():
    d, power = droplet(), math.pi * DIAMETER**2 * 1e6
    now, shell, spot = first(d, power), np.zeros((4, 1)), np.zeros(4)
    now, _ = swelling.swell(d, VAPOUR, PLASTIC, DAMAGE, AROUND, power, now, 3e-3, shell, spot)
    assert now.bubble.mass > d.seed and now.taken > 0.0
    now, wall = swelling.swell(d, VAPOUR, PLASTIC, DAMAGE, AROUND, -power, now, 9e-3, shell, spot)
    assert now.bubble.void == 0.0 and wall == 0.0


def test_what_boils_leaves_the_gel():
    """Mass of gel and bubble stays; the bubble is saturated."""
    d, power = droplet(), math.pi * DIAMETER**2 * 1e6
    now, shell, spot = first(d, power), np.zeros((4, 1)), np.zeros(4)
    gel_before = swelling.faces(d, np.array([d.inner, d.outer]), now.bubble.void, now.bubble.mass, shell)[0]
    now, _ = swelling.swell(d, VAPOUR, PLASTIC, DAMAGE, AROUND, power, now, 3e-3, shell, spot)
    gel_after = swelling.faces(d, np.array([d.inner, d.outer]), now.bubble.void, now.bubble.mass, shell)[0]
    lost = DENSITY * cavities.measure(3) * (gel_before - gel_after)
    assert lost == pytest.approx(now.bubble.mass - d.seed, rel=1e-9)
    density = real_gas.saturated_density(VAPOUR, now.bubble.temperature)
    assert now.bubble.mass == pytest.approx(density * now.bubble.void, rel=1e-12)
