"""What is said of curves that have become steady, and of those that have not."""

import numpy as np
import pytest

from sdph.study import steadiness

TIME = np.linspace(0.0, 4.0, 401)


def row(values, time=TIME):
    found = steadiness.rows({"time_s": time, "own": values})
    return found[0] if found else None


@pytest.mark.parametrize("size", [0.02, 0.3, 3.0])
def test_noise_about_a_mean_is_steady_as_often_as_said_and_its_doubt_holds(size):
    draw = np.random.default_rng(5)
    rows = [row(5.0 + size * draw.normal(size=len(TIME))) for _ in range(400)]
    assert 0.93 <= np.mean([own["steady"] for own in rows]) <= 1.0
    assert np.mean([abs(own["mean"] - 5.0) <= own["doubt"] for own in rows]) == pytest.approx(0.95, abs=0.025)


@pytest.mark.parametrize(
    "name, values",
    {
        "a ramp": 1.0 + 0.1 * TIME,
        "a ramp in noise": 1.0 + 0.1 * TIME + 0.1 * np.sin(977.0 * TIME),
        "an approach": 1.0 - np.exp(-TIME),
        "a slow wave": 1.0 + 0.2 * np.sin(0.25 * np.pi * TIME),
    }.items(),
)
def test_what_still_changes_is_told(name, values):
    own = row(values)
    assert not own["steady"]
    assert own["change"] == pytest.approx(values[TIME > 3].mean() - values[(TIME > 2) & (TIME <= 3)].mean(), rel=0.05)


@pytest.mark.parametrize("values", [1.0 - np.exp(-4.0 * TIME), 1.0 + 0.5 * np.sin(40.0 * np.pi * TIME)])
def test_what_has_arrived_or_swings_about_its_mean_is_steady(values):
    assert row(values)["steady"] and row(values)["mean"] == pytest.approx(1.0, abs=0.01)


def test_rows_count_by_the_time_that_they_stand_for():
    """Rows ten times as dense where a curve is high: the mean is that over time."""
    time = np.concatenate([np.linspace(0.0, 3.0, 31), *(np.linspace(a, a + 0.1, 101)[1:] if n % 2 else [a + 0.1]
                           for n, a in enumerate(np.arange(3.0, 4.0, 0.1)))])  # fmt: skip
    values = np.where((10.0 * (time - 1e-9)).astype(int) % 2 == 1, 2.0, 0.0)
    assert row(values, time)["mean"] == pytest.approx(1.0, rel=1e-6)


def test_what_says_nothing_has_no_row():
    gap = np.where(TIME < 3.5, TIME, np.nan)
    assert row(np.ones(len(TIME))) is None and row(gap) is None and row(np.full(len(TIME), "a")) is None
    assert row(TIME[:8], TIME[:8]) is None and row(np.zeros(0), np.zeros(0)) is None
    early = np.where(TIME > 1.0, 1.0 + 0.1 * np.sin(30 * TIME), np.nan)
    assert row(early)["steady"]


@pytest.mark.parametrize(("excess", "steady"), [(3.5, False), (1e-3, True)])
def test_temperatures_are_measured_by_what_they_went_through_and_not_from_zero(excess, steady):
    """Of 300 K half a per cent would be 1.5 K; what changes by less than that of LEAST_SPAN has not changed."""
    values = 300.0 + excess * np.clip(TIME - 1.0, 0.0, None) / 3.0
    (own,) = steadiness.rows({"time_s": TIME, "top_gas_temperature_K": values})
    assert own["steady"] is steady and own["change"] < 0.005 * own["mean"]
    (other,) = steadiness.rows({"time_s": TIME, "top_gas_pressure_Pa": values})
    assert other["steady"]
    early = np.where(TIME > 0.5, values, np.nan)
    assert steadiness.rows({"time_s": TIME, "top_K": early})[0]["steady"] is steady


def test_a_temperature_that_came_a_long_way_may_change_by_its_share_of_that():
    values = 300.0 + 100.0 * (1.0 - np.exp(-2.5 * TIME))
    (own,) = steadiness.rows({"time_s": TIME, "top_K": values})
    assert own["steady"] and 0.1 < own["change"] < 0.005 * 100.0
