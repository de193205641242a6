"""Friction of gas in a packed bed, from runs of the column of the scene fluidised_column, against the markers of Ergun
1952.

The grains are held: they are too heavy to be moved (0.1 m/s2 at the largest x), and nothing has weight. Ergun's
friction f_v = (dP/L) d^2/(mu U) eps^3/(1 - eps)^2 is a function of x = Re/(1 - eps) alone: one size of grains serves at
any x.
"""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np

from sdph import scenes
from sdph.case import read as cases
from sdph.running import driver
from sdph.study import compare

from . import measured

BAR = 0.05  # of Ergun's friction (README.md)
PLACES = (5.0, 50.0, 500.0, 2000.0)  # x [-] of the runs: around the markers, 7.4 to 1820
SERIES = {"present_investigation": "Ergun", "burke_plummer": "Burke & Plummer", "morcom": "Morcom"}
HELD = (
    "coupling.gas='embedded'",
    "effects=['drag', 'gas_pressure', 'walls']",
    "domain.gravity_m_s2=[0.0, -1e-9]",  # says which way is up
    "grains.density_kg_m3=1e6",
    "grains.diameter_mm=3.0",
    "run.end_time_s=0.01",
    "run.output_interval_s=0.01",
)


def checks(folder: Path, overrides=(), reporter=None, places=PLACES) -> list[dict]:
    """Markers of each series over the friction of the runs, and of each decade of x."""
    runs = np.array([friction(x, folder / f"packed-{x:g}", overrides, reporter) for x in places]).T
    markers = measured.table("ergun_1952")
    x, ratio = markers["Re_over_1_eps"], np.interp(markers["Re_over_1_eps"], *runs) / markers["f_v"]
    _figure(folder / "packed_bed.png", markers, runs)
    parts = {name: markers["series"] == key for key, name in SERIES.items()}
    parts |= {f"x = {a:g} to {b:g}": (x >= a) & (x < b) for a, b in pairwise(places)}
    return [
        compare.check(f"friction, {name}: mean over measured, {here.sum()} rows [-]", ratio[here].mean(), 1, BAR)
        for name, here in parts.items()
    ]


def friction(x: float, folder: Path, overrides, reporter) -> tuple[float, float]:
    """x and f_v [-] inside the bed of a run that is blown through at about `x`; both of alpha_p as it lies there."""
    file = scenes.find("fluidised_column")[1]
    held = cases.load(file, HELD)
    speed = x * held.gas.viscosity * held.particles["bed"].volume_fraction / held.gas.density / held.grains.diameter
    case = cases.load(file, (*HELD, f"boundaries.distributor.velocity_m_s=[0.0, {speed!r}]", *overrides))
    driver.run(case, "fluidised_column", folder, None, reporter)
    last = compare.open_run(folder).summary
    gas, d, alpha_p, U = case.gas, case.grains.diameter, last["alpha_p_inside"], last["superficial_velocity_m_s"]
    f_v = last["gradient_Pa_m"] * d**2 / (gas.viscosity * U) * (1.0 - alpha_p) ** 3 / alpha_p**2
    return gas.density * U * d / (gas.viscosity * alpha_p), f_v


def _figure(file: Path, markers, runs) -> None:
    with measured.figure(file, "Re/(1 - eps) [-]", "friction f_v [-]") as axes:
        for key, name in SERIES.items():
            rows = markers[markers["series"] == key]
            axes.loglog(rows["Re_over_1_eps"], rows["f_v"], ".", label=f"{name} (measured)")
        x = np.geomspace(runs[0, 0], runs[0, -1], 100)
        axes.plot(x, np.interp(x, *runs), "k-", lw=1)
        axes.plot(*runs, "ks", mfc="none", label="SDPH, runs; between them linear")
