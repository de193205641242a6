"""Short forms of the drops of `sdph validate experiments`: runs have the rate and temperature of a balance that is
written down apart, and what is off by more than its bar is told."""

import numpy as np
import pytest

from sdph.running.progress import Reporter
from sdph.study import validate

QUIET = Reporter(quiet=True)


def part(name):
    return validate.part(validate.EXPERIMENTS, name)


def verdicts(checks) -> list[bool]:
    return [check["ok"] for check in checks]


def test_a_run_of_heptane_has_the_rate_of_the_balance_apart(tmp_path):
    """0.5 %; without weight and numbers that follow the temperature."""
    drops, balance = part("heptane_drops"), part("drop_balance")
    place = 1.0, 741.0
    (told,) = drops.checks(tmp_path, (), QUIET, ("spalding",), (place,))
    assert (tmp_path / "heptane_drops.png").is_file()
    rows = drops.measured.table("nomura_1996")
    rows = rows[(rows["p_atm"] == place[0]) & (rows["T_gas_K"] == place[1])]
    of_run = balance.STEFAN, balance.LATENT  # a fluid's latent heat is that at the wet bulb
    times, squares, _ = balance.course(drops._drop(place, rows), of_run)
    assert told["value"] == pytest.approx(drops.constant(times / drops.SCALE, squares, drops.TO), rel=5e-3)
    assert told["reference"] == pytest.approx(0.382, abs=5e-4)  # as the head of the data has it


def test_what_the_balance_adds_takes_heat(tmp_path):
    """The vapour's flow slows a drop in hot gas, by the ratio ln(1 + B)/B of its heat; latent heat falls with T."""
    drops, balance = part("heptane_drops"), part("drop_balance")
    rows = drops.measured.table("nomura_1996")
    drop = drops._drop((1.0, 741.0), rows[(rows["p_atm"] == 1.0) & (rows["T_gas_K"] == 741.0)])
    slopes = {more: _slope(balance.course(drop, more)) for more in ((), (balance.STEFAN,), (balance.LATENT,))}
    assert slopes[balance.STEFAN,] < 0.7 * slopes[()] < slopes[balance.LATENT,]


def _slope(curves) -> float:
    return part("lone_drops").slope(curves[0], curves[1], 0.8, 0.2)


def test_a_run_in_a_stream_has_the_rate_and_temperature_of_the_balance_apart(tmp_path):
    """0.5 %, 0.05 K; the air is humid."""
    drops, balance = part("humid_drops"), part("drop_balance")
    rate, temperature = drops.checks(tmp_path, (), QUIET, ("spalding",), ("Re60_RH30",))
    times, squares, temperatures = balance.course(drops.drop("Re60_RH30"))
    here = times <= drops.TIME
    expected = drops.MM2 * drops.DIAMETER**2 * part("lone_drops").slope(times[here], squares[here])
    assert rate["value"] == pytest.approx(expected, rel=5e-3)
    assert temperature["value"] == pytest.approx(np.interp(drops.TIME, times, temperatures) - drops.COLD, abs=0.05)


@pytest.mark.parametrize(("factor", "ok"), [(1.0, True), (1.2, False), (1.0 / 1.2, False)])
@pytest.mark.parametrize("name", ["heptane_drops", "humid_drops", "micro_drops"])
def test_drops_that_are_a_fifth_too_fast_or_slow_are_told(tmp_path, monkeypatch, name, factor, ok):
    """As measured passes; rates by a factor do not, nor do temperatures 0.6 K off."""
    drops = part(name)
    monkeypatch.setattr(drops.lone_drops, "course", lambda *given: as_measured(drops, given[2].name, factor))
    checks = drops.checks(tmp_path)
    assert verdicts(checks) == [ok] * len(checks)
    assert len(checks) == {"heptane_drops": 8, "humid_drops": 14, "micro_drops": 4}[name]


def as_measured(drops, folder: str, factor: float) -> np.ndarray:
    """Times [s], squares and temperatures [K] of the data of a run's folder."""
    _, _, name = folder.split("-", 2)
    if drops.__name__.endswith("heptane_drops"):
        pressure, temperature = (float(word) for word in name.split("-"))
        rows = drops.measured.table("nomura_1996")
        rows = rows[(rows["p_atm"] == pressure) & (rows["T_gas_K"] == temperature)]
        return np.array([drops.SCALE * rows["t_over_d02_s_mm2"] / factor, rows["d2_over_d02"], 0.0 * rows["p_atm"]])
    if drops.__name__.endswith("micro_drops"):
        times, squares = drops._measured(drops.measured.table("taflin_1988"), name)
        return np.array([times / factor, squares, 0.0 * times])
    rows = drops.measured.table("fujita_2010")
    times, squares = drops._rows(rows, name, "d2_over_d02")
    known = drops._rows(rows, name, "T_minus_T0_K")
    warmer = np.interp(times, *known) if len(known[0]) else 0.0 * times
    return np.array([times / factor, squares, drops.COLD + warmer + 0.6 * (factor != 1.0)])
