"""The first window in which droplets meet the gas is as short as their rates ask for, though none were there before.
Drops do not take more heat than the gas has in a window of any length."""

import math

import pytest
from builders import fixed_windows, simulation

from coupling.embedded import EmbeddedGas
from sdph import scenes
from sdph.case import read as cases
from sdph.running import driver
from sdph.running.progress import Reporter

FINE = (
    "coupling.gas='embedded'",
    "grains.diameter_mm=0.01",
    "grains.diameter_std_mm=0.0",
    "gas.temperature_K=1200.0",
    "boundaries.bottom.temperature_K=1200.0",
    "run.end_time_s=0.006",
    "run.output_interval_s=0.006",
)


def test_fine_drops_that_come_into_hot_gas_do_not_take_more_heat_than_it_has(tmp_path):
    """Drops of 10 um take their wet bulb in 0.1 ms; in a first window of 0.8 ms they fell below 0 K."""
    case = cases.load(scenes.HERE / "spray_cone" / "case.toml", FINE)
    flight = driver.stepping(case, "spray_cone", tmp_path / "run", None, Reporter(quiet=True))
    lengths, before, summary = [], 0.0, None
    while summary is None:
        try:
            simulation = next(flight).simulation
        except StopIteration as done:
            summary = done.value
        else:
            if not simulation.clock.idle:
                lengths.append((simulation.time - before, simulation.clock.limits["heat exchange"]))
            before = simulation.time
    assert lengths[1][0] <= lengths[0][1] < 2e-4 and math.isfinite(lengths[0][1])
    assert 290.0 < summary["grain_temperature_min_K"] < summary["grain_temperature_max_K"] < 373.2
    assert summary["energy_drift_rel"] < 1e-12


@pytest.mark.parametrize("windows", (1, 2, 4, 8, 16))
def test_drops_that_cool_their_gas_by_much_do_not_overshoot(tmp_path, windows):
    """A cloud at 294.3 K in gas of 800 K, which it cools to 400 K: its wet bulb lies between them. Seen by the gas of a
    window's start the drops fell to 261 K."""
    end = 2e-3
    given = (
        "coupling.one_way=false", "gas.equation_of_state='operating'", "particles.droplet.volume_fraction=0.01",
        f"run.end_time_s={end}", f"run.output_interval_s={end}", "grains.diameter_mm=0.01", "gas.temperature_K=800",
        *fixed_windows(end / windows),
    )  # fmt: skip
    case = cases.load(scenes.HERE / "single_droplet" / "case.toml", given)
    run = simulation(case, tmp_path, gas=lambda case, cells: EmbeddedGas(case))
    coldest, start = math.inf, run.state.temperature.min()
    while run.time < end:
        run.window()
        coldest = min(coldest, run.state.temperature.min())
    gas = run.gas_state.fields["temperature"].mean()
    assert start < coldest < 373.2 and 390.0 < gas < 420.0
    assert run.ledger.summary()["energy_drift_rel"] < 1e-12
