"""Conduction around a bubble, and the step of bubble and shell, against closed forms and balances."""

import math

import numpy as np
import pytest
from gel_values import VALUES, VAPOUR

from sdph.effects.gas import gel
from sdph.laws import cavities, real_gas, shells
from sdph.laws import gel_droplet as law

HEAT = 1500.0 * 5000.0  # J/(m3 K)


class Rings:
    """Rings of a gel between two radii [m], with powers [W] in each."""

    def __init__(self, inner, outer, count, dims=2):
        edges = np.linspace(inner, outer, count + 1) ** dims
        self.inner, self.dims, self.volumes = inner, dims, np.diff(edges)
        self.capacities = HEAT * cavities.measure(dims) * self.volumes
        self.temperature, self.powers = np.zeros(count), np.zeros(count)

    def step(self, dt, bubble=None):
        """Advance by dt [s] beside a bubble [K], none: one that takes no heat; returns the heat [J] it took."""
        upper, free, unit = (np.empty(len(self.volumes)) for _ in range(3))
        first = law.conducted(
            self.dims, self.inner, self.volumes, 0.5, self.capacities, self.powers, dt, self.temperature, upper, free,
            unit,
        )  # fmt: skip
        bubble = free[0] / (1.0 - unit[0]) if bubble is None else bubble
        self.temperature = free + bubble * unit
        return dt * first * (self.temperature[0] - bubble)


def test_cylinder_under_a_flux():
    rings = Rings(1e-9, 5e-4, 50)
    rings.powers[-1] = 1.42e5 * math.pi * 1e-3
    for _ in range(500):
        rings.step(1e-3)
    assert rings.temperature[0] == pytest.approx(VALUES["cylinder_flux_r0_t0.5"], rel=0.01)
    rim = rings.temperature[-1] + (rings.temperature[-1] - rings.temperature[-2]) / 2.0
    assert rim == pytest.approx(VALUES["cylinder_flux_r0.0005_t0.5"], rel=0.01)


def test_steady_heat_through_a_cylinder():
    rings = Rings(1.5e-4, 5e-4, 200)
    rings.powers[-1] = VALUES["cylinder_steady_power"]
    rings.step(1e6, 0.0)
    assert rings.temperature[-1] == pytest.approx(10.0, rel=2e-3)


@pytest.mark.parametrize("dims", [2, 3])
def test_no_heat_is_lost(dims):
    rings = Rings(1.5e-4, 5e-4, 20, dims)
    rings.powers[:] = np.linspace(1.0, 3.0, 20)
    rings.temperature[:] = np.linspace(5.0, 9.0, 20)
    before = rings.capacities @ rings.temperature
    taken = rings.step(0.1, 2.0)
    assert rings.capacities @ rings.temperature - before == pytest.approx(0.1 * 40.0 - taken, rel=1e-11)


@pytest.mark.parametrize("dims", [2, 3])
def test_steady_resistance(dims):
    """Flux k dT/dr through each surface on the way is the same."""
    whole = law.resistance(dims, 1e-4, 3e-4, 0.5)
    assert whole == pytest.approx(
        law.resistance(dims, 1e-4, 2e-4, 0.5) + law.resistance(dims, 2e-4, 3e-4, 0.5), rel=1e-12
    )
    near, far = 2e-4, 2e-4 * (1.0 + 1e-6)
    surface = 2.0 * math.pi * near if dims == 2 else 4.0 * math.pi * near**2
    assert law.resistance(dims, near, far, 0.5) == pytest.approx((far - near) / (0.5 * surface), rel=1e-5)


def droplet(dims=2):
    """A shell at rest around a bubble of 0.3 mm, and what `inflated` takes of it."""
    own = gel.Shell()
    around = law.Around(dims, 101325.0, 0.025, *gel.moduli(own))
    edges, rows = shells.layers(4.5e-4, 5e-4, 4)
    void = cavities.void(1.5e-4, dims)
    temperature = real_gas.saturation_temperature(VAPOUR, law.bubble_pressure(around, 0.0, void))
    bubble = law.Bubble(real_gas.saturated_density(VAPOUR, temperature) * void, void, temperature)
    fixed = around, 4.5e-4**dims - 1.5e-4**dims, VAPOUR, edges, gel.plastic(own), gel.damage(own)
    return fixed, bubble, rows


@pytest.mark.parametrize("dims", [2, 3])
@pytest.mark.parametrize("share", [1e-6, 1e-3, 0.3, -1e-3])
def test_a_step_takes_the_heat_that_comes(dims, share):
    """`share` of the bubble's heat comes in a step: it is boiled and warmed away, and the void is saturated."""
    fixed, bubble, rows = droplet(dims)
    heat = share * VAPOUR.latent_heat * bubble.mass
    after = rows.copy()
    new = law.inflated(*fixed, 1.0, (heat, 0.0), bubble, rows, after)
    taken = cavities.heat_taken(VAPOUR, new.mass - bubble.mass, new.mass, new.temperature - bubble.temperature)
    assert taken == pytest.approx(heat, abs=2e-13 * VAPOUR.latent_heat * bubble.mass)
    assert new.mass == pytest.approx(real_gas.saturated_density(VAPOUR, new.temperature) * new.void, rel=1e-13)
    assert (new.void > bubble.void) == (share > 0.0)


def test_a_droplet_that_nothing_warms_stays():
    fixed, bubble, rows = droplet()
    new = law.inflated(*fixed, 1e-3, (0.0, 0.0), bubble, rows, rows.copy())
    assert new == bubble


def test_no_void_is_told():
    """More heat than any void within reach takes."""
    fixed, bubble, rows = droplet()
    new = law.inflated(*fixed, 1.0, (1e9, 0.0), bubble, rows, rows.copy())
    assert math.isnan(new.void)


def test_a_vent_keeps_mass_and_heat_and_stops_at_the_pressure_around():
    fixed, _, _ = droplet()
    around, void = fixed[0], 8.35e-7
    bubble = law.Bubble(real_gas.saturated_density(VAPOUR, 530.0) * void, void, 530.0)
    left, now = 0.0, bubble
    for _ in range(300):
        before = now
        now, out = law.vented(around, VAPOUR, 1e-4, 1e-5, (0.0, 0.0), before, 530.0)
        taken = cavities.heat_taken(
            VAPOUR, now.mass + out - before.mass, now.mass, now.temperature - before.temperature
        )
        assert abs(taken) < 1e-12 * VAPOUR.latent_heat * bubble.mass
        left += out
    assert now.temperature == pytest.approx(real_gas.saturation_temperature(VAPOUR, 101325.0), abs=1e-3)
    boiled = now.mass + left - bubble.mass
    assert 0.0 < boiled < bubble.mass  # cooling along the curve sets heat free: that of dry vapour would condense none
