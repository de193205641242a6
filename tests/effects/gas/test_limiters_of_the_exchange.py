"""What limiters of the exchange hold is told: droplets at flat rates, at boiling, at their end; forces on who is gone;
particles beside the mesh."""

import dataclasses

import numpy as np
import pytest
from test_evaporation import droplet, started

from sdph.effects.gas import evaporation
from sdph.exchange.amounts import outside
from sdph.laws import evaporation as law

HOT = ("particles.droplet.temperature_K=900",)


def told(folder, *overrides):
    """What is held at the start, and after a window, of one droplet."""
    run = started(droplet("run.end_time_s=1", "run.output_interval_s=1", *overrides), folder)
    first = dict(run.limiters.now)
    run.window()
    return first, run.limiters.now


@pytest.mark.parametrize("more, flat", [((), 0.0), (("evaporation.saturation='constant'",), 1.0)])
def test_a_rate_that_falls_with_temperature_is_taken_as_flat(tmp_path, more, flat):
    """A constant pressure of saturation is fewer molecules at a higher temperature."""
    for own in told(tmp_path, *more):
        assert (own["flat_rate_share"], own["boiling_held_share"]) == (flat, 0.0)


@pytest.mark.parametrize("name, boiling", [("linear", 0.0), ("spalding", 1.0)])
def test_droplets_past_boiling_are_held_there(tmp_path, name, boiling):
    """Spalding's ln(1 + B) alone has a pole there."""
    first, _ = told(tmp_path, f"evaporation.law='{name}'", *HOT)
    assert first["boiling_held_share"] == boiling
    p = evaporation.kernel(droplet(f"evaporation.law='{name}'"))
    pressure = p.operating_pressure * (1.0 - evaporation.BOILING_MARGIN)
    edge = law.boiling_temperature(pressure, (p.first, p.second, p.third, p.fourth))
    assert [evaporation.past_boiling(p, edge + shift) for shift in (-1e-3, 1e-3)] == [False, bool(boiling)]


def warm(left, *overrides):
    """A droplet as warm as the gas, at a constant pressure of saturation, and a window [s] that leaves the share `left`
    of its surface: the d2 law is exact then."""
    case = droplet(
        "evaporation.saturation='constant'", "evaporation.latent_heat_J_kg=0", "gas.temperature_K=330",
        "particles.droplet.temperature_K=330", "run.end_time_s=1000", "run.output_interval_s=1000", *overrides,
    )  # fmt: skip
    p = evaporation.kernel(case)
    force = evaporation.driving_force(p, 330.0, 0.0, 330.0, 1.225)
    return case, (1.0 - left) * case.grains.diameter**2 / law.regression_rate(force, p.diffusivity, p.grain_density)


@pytest.mark.parametrize("left, gone", [(5e-7, True), (2e-6, False)])
def test_the_rest_of_a_droplet_is_counted(tmp_path, left, gone):
    """left^1.5 of its mass: below 1e-9 it goes at once, above it stays."""
    case, window = warm(left)
    run = started(case, tmp_path)
    mass, handed = run.state.mass[0], run.hand(window)
    rest = mass * left**1.5 if gone else 0.0
    assert handed.columns()["finished_kg"] == handed.loss.rest[0] == pytest.approx(rest, rel=1e-6)
    assert (handed.loss.mass[0] == mass) == gone


def test_the_rest_of_droplets_comes_to_ledger_and_summary(tmp_path):
    case, window = warm(5e-7)
    case = dataclasses.replace(case, run=dataclasses.replace(case.run, end_time=window, output_interval=window))
    case = dataclasses.replace(case, coupling=dataclasses.replace(case.coupling, window_largest=window))
    run = started(case, tmp_path)
    run.clock.limits = {"largest": window}
    mass = run.state.mass[0]
    run.window()
    assert len(run.state.x) == 0 and run.windows == 1
    assert run.ledger.summary()["finished_kg"] == pytest.approx(mass * 5e-7**1.5, rel=1e-6)


@pytest.mark.parametrize("share, gone", [(0.0, True), (0.5, False)])
def test_a_held_force_on_a_droplet_that_goes_is_counted(tmp_path, share, gone):
    case, window = warm(share)
    run = started(case, tmp_path)
    rates = run.exchange._rates
    run.exchange._rates = lambda *seen: (*rates(*seen)[:3], np.array([[3e-9, 0.0, 4e-9]]))
    handed = run.hand(window + 1e-6)
    assert handed.columns()["impulse_of_gone_kg_m_s"] == pytest.approx(5e-9 * handed.dt if gone else 0.0)
    assert handed.force.any() != gone


def test_particles_beside_the_mesh_are_counted(tmp_path):
    run = started(droplet("run.end_time_s=1", "run.output_interval_s=1"), tmp_path)
    assert run.limiters.now["outside_mesh_particles"] == 0.0
    run.state.x[0], run._weights_now = 9.0, None
    assert outside(run.weights)["outside_mesh_particles"] == 1.0
    run.window()
    assert run.limiters.now["outside_mesh_particles"] == 1.0
