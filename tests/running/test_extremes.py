"""The summary has the highest and lowest of what is asked for by name, over all parts of a run."""

import math

import pytest
from tank_cases import tank_case

import sdph
from sdph.case import read as cases
from sdph.running.extremes import Extremes


def test_rows_are_looked_through_by_name():
    case = tank_case(probes={"wall": {"at_m": [0.0, 0.05]}})
    own = Extremes(case)
    for value in (1.0, -3.0, math.nan, 2.0):
        own.hear({"time_s": 9.0, "wall_pressure_Pa": value, "walls_other": 7.0})
    assert own.summary() == {"highest_wall_pressure_Pa": 2.0, "lowest_wall_pressure_Pa": -3.0}


def test_what_is_before_the_means_begin_counts_for_nothing():
    case = tank_case(
        probes={"wall": {"at_m": [0.0, 0.05]}}, run={"end_time_s": 1.0, "output_interval_s": 1.0, "average_from_s": 0.3}
    )
    own = Extremes(case)
    for time, value in ((0.0, 9.0), (0.2, -9.0), (0.1 + 0.2, 3.0), (0.9, 1.0)):
        own.hear({"time_s": time, "wall_pressure_Pa": value})
    assert own.summary() == {"highest_wall_pressure_Pa": 3.0, "lowest_wall_pressure_Pa": 1.0}
    own = Extremes(case)
    own.hear({"time_s": 0.3 * (1.0 - 1e-15), "wall_pressure_Pa": 5.0})  # the same time, but for round-off
    assert own.summary()["highest_wall_pressure_Pa"] == 5.0


def test_a_run_tells_its_peaks_also_when_it_went_on(tmp_path):
    """Water falls by 3 cm on a floor: the highest pressure is in the history, in one run and in two parts."""
    pool = {"water": {"shape": "box", "lower_m": [0.0, 0.02], "upper_m": [0.2, 0.12]}}
    given = tank_case(
        pools=pool, probes={"deep": {"at_m": [0.1, 0.03], "fields": ["pressure", "level"]}},
        run={"end_time_s": 0.12, "output_interval_s": 0.02, "forces": ["bottom"]},
    )  # fmt: skip
    (tmp_path / "case.toml").write_text(cases.dumps(given))
    whole = sdph.run(sdph.Case.load(tmp_path / "case.toml"), out=tmp_path / "whole")
    with sdph.stepping(sdph.Case.load(tmp_path / "case.toml"), out=tmp_path / "parts") as windows:
        for window in windows:
            if window.time > 0.09:
                break
    parts = sdph.resume(tmp_path / "parts")
    for column in ("deep_pressure_Pa", "deep_level_m", "bottom_liquid_pressure_force_y_N"):
        curve = whole.history[column]
        assert whole.summary[f"highest_{column}"] == pytest.approx(curve.max(), rel=1e-12)
        assert parts.summary[f"lowest_{column}"] == whole.summary[f"lowest_{column}"] == pytest.approx(curve.min())
        assert parts.summary[f"highest_{column}"] == whole.summary[f"highest_{column}"]
    assert 0.08 < whole.summary["lowest_deep_level_m"] < whole.summary["highest_deep_level_m"] < 0.13
