"""Beds of spheres that water carries, Richardson & Zaki 1954: voidage at three velocities, and the index n of
U = U_i eps^n, from runs of the scene fluidised_column with their spheres and water in the place of its gas.

Two beds of the wider tube: lead and steel, heavy enough for what `sdph explain` calls safe (gas pushed aside). Glass is
not: spheres of 4.2 mm end as unstable. The program's own law of drag (`gidaspow`). Velocities are those at which 0.5 to
0.65 of voidage were measured: at 0.7 and more lead gathers in bands that rise and fall, and the bed has no height.

A bed is laid in with the voidage that was measured at its velocity, 0.1 m high, and runs for three times as long as a
change of voidage takes through it, H/(n (1 - eps) U) (Wallis 1969, One-dimensional Two-phase Flow, ch. 6); the latter
half counts. Voidage is by the height of the bed, as it was measured.
"""

from __future__ import annotations

import math
from functools import partial
from pathlib import Path

import numpy as np
from scipy.optimize import brentq

from sdph import scenes
from sdph.case import read as cases
from sdph.laws import drag
from sdph.running import driver, output
from sdph.study.compare import check

from . import measured

BAR = 0.15  # of n (README.md)
STEADY = 0.25 * BAR  # that n may be apart by halves of the time that counts; our choice
BEDS = {"Lead shot": (0.001029, 0.061976), "Ballbearings 1/8 in. D": (0.003175, 0.061976)}  # sphere, tube [m]; in water
LAID = (0.5, 0.575, 0.65)  # measured voidages of the velocities
LAW = "gidaspow"  # the default of `drag.law`
HEIGHT, WIDTH, ROOM = 0.1, 0.03, 3  # m of the bed as it is laid in, m of the scene; such beds in the column's height
PASSAGES, OUTPUTS = 3.0, 80  # times that a change of voidage goes through a bed; rows of the metrics


def row(name: str):
    """The row of the table of a bed in water."""
    rows = measured.table("richardson_zaki_beds_1954")
    diameter, tube = BEDS[name]
    own = (rows["particle"] == name) & (rows["liquid"] == "Water") & (rows["d_m"] == diameter) & (rows["D_m"] == tube)
    return rows[own][0]


def checks(folder: Path, overrides=(), reporter=None, beds=tuple(BEDS), laid=LAID) -> list[dict]:
    """Index and velocities of each bed against what was measured and against the law of drag alone, and whether it was
    steady."""
    found = {name: np.array([run(row(name), eps, folder, overrides, reporter) for eps in laid]) for name in beds}
    _figure(folder / "liquid_beds.png", found, laid)
    return [told for name, halves in found.items() for told in _of_bed(row(name), halves, laid)]


def _of_bed(own, halves: np.ndarray, laid) -> list[dict]:
    """Checks of a bed; `halves` (velocities, 2) are the voidages of each half of the time that counts."""
    name = f"liquid bed of {own['particle']}, {1e3 * own['d_m']:.3g} mm, in water"
    speeds, eps = np.array([speed(own, at) for at in laid]), halves.mean(axis=1)
    alone = np.array([law_alone(own, at) for at in eps])
    parts = [slope(half, speeds) for half in halves.T]
    told = [
        check(f"{name}: n [-], Richardson & Zaki", slope(eps, speeds), own["n"], BAR),
        check(f"{name}: n [-], {LAW} alone", slope(eps, speeds), slope(eps, alone), BAR),
        check(f"{name}: n [-], halves of the time apart", parts[1] - parts[0], 0.0, STEADY),
    ]
    for U, at, law in zip(speeds, eps, alone):
        bar = BAR * abs(math.log(at))  # what the bar of n makes of U at this voidage
        text = f"{name} at {U:.3g} m/s: U over"
        told.append(check(f"{text} the measured at its voidage [-]", U / speed(own, at), 1.0, bar))
        told.append(check(f"{text} {LAW}'s at its voidage [-]", U / law, 1.0, bar))
    return told


def speed(own, eps: float) -> float:
    """Superficial velocity [m/s] that was measured at a voidage."""
    return float(own["Ui_m_s"] * eps ** own["n"])


def slope(eps, speeds) -> float:
    """n [-]: slope of log U over log eps."""
    return float(np.polyfit(np.log(eps), np.log(speeds), 1)[0])


def law_alone(own, eps: float) -> float:
    """Superficial velocity [m/s] at which the law of drag carries the spheres of a row at a voidage: beta s = alpha_p
    alpha_l (rho_p - rho_l) g, both sides by alpha_p."""
    law = partial(getattr(drag, LAW), 1.0 - eps)
    numbers = float(own["d_m"]), float(own["rho_l"]), float(own["mu_Pas"])
    force = eps * float(own["rho_s"] - own["rho_l"]) * measured.GRAVITY
    return eps * brentq(lambda slip: law(slip, *numbers) * slip - force, 0.0, 10.0, xtol=1e-12)


def run(own, laid: float, folder: Path, overrides, reporter) -> tuple[float, float]:
    """Mean voidages [-] of the third and the fourth quarter of a run of a row's bed, laid in at a voidage."""
    place = folder / f"liquid-bed-{own['particle'].split()[0]}-{laid:g}"
    path, text = scenes.find("fluidised_column")[1], given(own, laid)
    case = cases.load(path, (*text, *overrides))
    driver.run(case, "fluidised_column", place, None, reporter)
    rows = output.read_table(place / "metrics.csv", output.TEXTS)
    late = np.array_split(rows["bed_height_m"][rows["time_s"] > 0.5 * case.run.end_time], 2)
    return tuple(1.0 - (1.0 - laid) * HEIGHT / float(half.mean()) for half in late)


def given(own, laid: float) -> list[str]:
    """Overrides of the scene for a row and the voidage that its bed is laid in with."""
    U = speed(own, laid)
    end = PASSAGES * HEIGHT / (float(own["n"]) * (1.0 - laid) * U)
    return [
        "coupling.gas='embedded'",
        "coupling.window_largest_s=0.01",
        f"drag.law={LAW!r}",
        f"run.end_time_s={end!r}",
        f"run.output_interval_s={end / OUTPUTS!r}",
        f"domain.size_m=[{WIDTH}, {ROOM * HEIGHT!r}]",
        f"domain.gravity_m_s2=[0.0, {-measured.GRAVITY}]",
        f"particles.bed.upper_m=[{WIDTH}, {HEIGHT}]",
        f"particles.bed.volume_fraction={1.0 - laid!r}",
        f"gas.density_kg_m3={float(own['rho_l'])}",
        f"gas.viscosity_Pa_s={float(own['mu_Pas'])}",
        f"grains.density_kg_m3={float(own['rho_s'])}",
        f"grains.diameter_mm={1e3 * float(own['d_m'])!r}",
        f"boundaries.distributor.velocity_m_s=[0.0, {U!r}]",
    ]


def _figure(file: Path, found, laid) -> None:
    with measured.figure(file, "voidage [-]", "superficial velocity [m/s]") as axes:
        axes.set(xscale="log", yscale="log")
        for k, (name, halves) in enumerate(found.items()):
            own, eps = row(name), halves.mean(axis=1)
            at = np.geomspace(0.45, 0.95, 60)
            axes.plot(at, [speed(own, one) for one in at], "-", c=f"C{k}", label=f"{name}, measured (U_i eps^n)")
            axes.plot(at, [law_alone(own, one) for one in at], "--", c=f"C{k}", label=f"{name}, {LAW} alone")
            speeds = [speed(own, one) for one in laid]
            axes.plot(eps, speeds, "o", c=f"C{k}", mfc="none", label=f"{name}, SDPH")
