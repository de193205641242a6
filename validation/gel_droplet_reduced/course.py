"""Base case against the other reduced model: D/D_0 and pressure in time, and what closes."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from sdph.study.compare import check

from . import runs

# Bars of issue 20's ladder for the particles against the reduced model (point 13): the two reduced ones are nearer
RATIO, PRESSURE, TIME = 0.01, 0.05, 0.05
REACHED = {1.02: 0.4864388045, 1.05: 0.6646902453, 1.1: 0.7183192642, 1.2: 0.7411695651, 1.4: 0.7496174416}  # s
MOST, AT_RUPTURE = 150751.996, 146163.605  # Pa
ROUND_OFF, WORK = 1e-10, 0.01  # of mass and heat; of work on the shell: integrated by the step


def checks(folder: Path, overrides=(), reporter=None) -> list[dict]:
    """D/D_0 and pressure at the table's times, times of the table's D/D_0, drifts."""
    found = runs.course(runs.EVEN)
    h, rows, own = found.history, runs.table("course"), found.summary
    found_rows = [np.interp(rows["time_s"], h["time_s"], h[name]) for name in ("diameter_ratio", "pressure_Pa")]
    compared = [
        check(f"{name} at {t:g} s", value, row[column], bar, True)
        for name, column, bar, values in zip(
            ("D/D_0", "pressure [Pa]"), ("diameter_ratio", "pressure_Pa"), (RATIO, PRESSURE), found_rows
        )
        for t, value, row in zip(rows["time_s"], values, rows)
    ]
    compared += [check(f"time of D/D_0 = {r:g} [s]", runs.time_at(found, r), t, TIME, True) for r, t in REACHED.items()]
    at = float(np.interp(1.4, h["diameter_ratio"][: found.tear], h["pressure_Pa"][: found.tear]))
    return [
        *compared,
        check("largest pressure [Pa]", own["pressure_max_Pa"], MOST, PRESSURE, True),
        check("pressure at D/D_0 = 1.4 [Pa]", at, AT_RUPTURE, PRESSURE, True),
        check("mass made, of all", own["mass_drift_rel"], 0.0, ROUND_OFF),
        check("heat made, of what came in", own["heat_drift_rel"], 0.0, ROUND_OFF),
        check("work on the shell that is missing", own["work_drift_rel"], 0.0, WORK),
    ]
