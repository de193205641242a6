"""Balances that `sdph validate` holds each run to."""

import pytest

from sdph.running import balances


@pytest.mark.parametrize("name", balances.BARS)
def test_a_balance_past_its_bar_fails(name):
    bar = balances.BARS[name]
    for value, ok in ((0.99 * bar, True), (-0.99 * bar, True), (1.01 * bar, False), (-1.01 * bar, False)):
        (found,) = balances.checks({name: value, "windows": 3})
        assert found == {"name": name, "value": value, "reference": 0.0, "tolerance": bar, "ok": ok}


def test_numerical_work_of_the_gas_is_held_to_two_percent_where_there_is_any():
    """A gas that feels nothing of the grains has no such column."""
    assert balances.work_of_gas({"windows": 3}) == []
    assert [balances.work_of_gas({"gas_numerical_work_rel": value})[0]["ok"] for value in (0.019, 0.021)] == [
        True,
        False,
    ]


def test_a_balance_that_is_no_number_fails():
    assert not balances.checks({"mass_drift_rel": float("nan")})[0]["ok"]


def test_a_run_tells_what_it_missed_and_what_helps():
    told = balances.missed({"mass_drift_rel": 1e-3, "numerical_work_rel": 0.177, "motion_drift_rel": 1e-15})
    assert len(told) == 2 and not any("\n" in line for line in told)
    assert "mass_drift_rel = 0.001" in told[0] and "numerical_work_rel = 0.18" in told[1] and "step_factor" in told[1]


def test_a_drift_of_the_momentum_of_the_gas_is_told_and_not_judged():
    assert not balances.missed({"gas_momentum_drift_rel": 0.0099, "windows": 3})
    (line,) = balances.missed({"gas_momentum_drift_rel": 0.021})
    assert "gas_momentum_drift_rel = 0.021, a balance is good to 0.01" in line and "resolution.cell_mm" in line
    assert not balances.checks({"gas_momentum_drift_rel": 0.021})


@pytest.mark.parametrize(
    ("dissipated", "at_hand", "blamed"), [(3.1e-3, 44.0, False), (4.5e-2, 44.0, True), (3.1e-3, None, True)]
)
def test_steps_are_not_blamed_for_what_water_at_rest_has(dissipated, at_hand, blamed):
    """A miss is told all the same, and fails its check."""
    summary = {"numerical_work_rel": 0.0255, "dissipated_J": dissipated}
    summary |= {} if at_hand is None else {balances.AT_HAND: at_hand}
    (told,) = balances.missed(summary)
    assert told.startswith("numerical_work_rel = 0.025, a balance is good to 0.02: ")
    assert ("run.step_factor" in told) == blamed and ("nearly at rest" in told) != blamed
    assert [row["ok"] for row in balances.checks(summary)] == [False]
