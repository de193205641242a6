"""Droplets at boiling: what heat comes in is what evaporates, whoever brings it."""

import math

import pytest
from builders import fixed_windows
from test_evaporation import CLAPEYRON, droplet, started

from sdph.effects.gas import evaporation
from sdph.exchange import droplets as droplet_loss
from sdph.laws import evaporation as law


def gone(case, folder):
    """A run that has come to its end, and the hottest temperature [K] of its droplets on the way."""
    run, hottest = started(case, folder), 0.0
    while run.time < case.run.end_time:
        run.window()
        hottest = max(hottest, run.state.temperature.max(initial=0.0))
    return run, hottest


@pytest.mark.parametrize("name", evaporation.LAWS)
def test_boiling_is_not_exceeded(tmp_path, name):
    """In gas far hotter than the boiling temperature droplets come to it and no higher: 0.1 K, as they shrink in a
    window."""
    case = droplet(
        f"evaporation.law='{name}'",
        "gas.temperature_K=2000.0",
        "run.end_time_s=1.5",
        "run.output_interval_s=1.5",
        *fixed_windows(0.05),
    )
    boiling = law.boiling_temperature(case.gas.operating_pressure, CLAPEYRON)
    _, hottest = gone(case, tmp_path)
    assert 0.9 * boiling < hottest <= boiling + 0.1


@pytest.mark.parametrize("name", evaporation.LAWS)
def test_boiling_by_radiation_in_cool_gas_is_not_exceeded(tmp_path, name):
    """Heat of hot surroundings, not of the gas, brings droplets to boiling, and pays for what evaporates there."""
    case = droplet(
        "effects=['heat','evaporation','radiation']", f"evaporation.law='{name}'", "gas.temperature_K=350.0",
        "radiation.emissivity=1.0", "radiation.surroundings_temperature_K=2500.0", "run.end_time_s=0.3",
        "run.output_interval_s=0.3", *fixed_windows(0.005),
    )  # fmt: skip
    boiling = law.boiling_temperature(case.gas.operating_pressure, CLAPEYRON)
    run, hottest = gone(case, tmp_path)
    assert 0.9 * boiling < hottest <= boiling + 0.5
    assert run.ledger.summary()["evaporated_kg"] > 0.0


def test_a_drop_that_boils_in_steady_heat_has_spaldings_closed_form():
    """m' = h A/c_pv ln(1 + c_pv (T_g - T_b)/L) at the end of a long window, in which it does not shrink."""
    case = droplet("evaporation.law='spalding'")
    p = evaporation.kernel(case)
    capacity, conductance, latent = 1e-9, 1e-6, 2.0
    blowing = p.blowing / (p.latent_heat / latent) / conductance
    balance = droplet_loss.Balance(
        0.0, 0.0, p.boiling_temperature, 1000.0, 0.0, conductance, conductance, capacity, latent, blowing, 1e3
    )
    rate = droplet_loss.window_force(p, balance) * latent / p.latent_heat
    number = p.blowing * (1000.0 - p.boiling_temperature) / p.latent_heat
    assert rate == pytest.approx(conductance / p.blowing * math.log1p(number), rel=1e-9)
