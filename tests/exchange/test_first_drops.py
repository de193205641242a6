"""The first window in which droplets meet the gas is as short as their rates ask for, though none were there before."""

import math

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
