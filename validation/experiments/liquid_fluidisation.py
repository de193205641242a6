"""Index n of U = U_i eps^n of liquid-fluidised spheres, Richardson & Zaki 1954, against laws of drag alone: what a bed
in balance has is the root of one equation."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from scipy.optimize import brentq

from sdph.laws import drag

from . import measured

BAR = 0.15  # of n (README.md)
LAWS = ("gidaspow", "wen_yu", "syamlal_obrien", "di_felice")  # that know of crowding and of lone spheres
EPS = np.geomspace(0.4, 0.95, 20)  # voidages that beds were measured at (README.md); evenly in log eps, our choice
SPHERE, WATER = 1e-3, (1000.0, 1e-3)  # m; kg/m3 and Pa s: n is a function of the Reynolds number alone


def settling_slip(law, alpha_p: float, density: float) -> float:
    """Slip [m/s] of spheres of `density` [kg/m3] that settle evenly: beta s = alpha_p alpha_l (rho_p - rho_l) g, both
    sides by alpha_p."""
    force = (1.0 - alpha_p) * (density - WATER[0]) * measured.GRAVITY
    excess = lambda slip: law(alpha_p, slip, SPHERE, *WATER) * slip - force  # noqa: E731
    upper = 1.0
    while excess(upper) < 0.0:
        upper *= 2.0
    return brentq(excess, 0.0, upper, xtol=1e-300, rtol=1e-15)


def index(law, reynolds: float) -> float:
    """n [-] of a law of sdph.laws.drag: slope of log U over log eps; `reynolds` of the lone sphere that settles."""
    alone = reynolds * WATER[1] / (WATER[0] * SPHERE)  # m/s
    weight = law(0.0, alone, SPHERE, *WATER) * alone  # N/m3, in the liquid
    density = WATER[0] + weight / measured.GRAVITY
    slips = [settling_slip(law, 1.0 - eps, density) for eps in EPS]
    return float(np.polyfit(np.log(EPS), np.log(EPS * slips), 1)[0])


def checks(folder: Path, overrides=(), reporter=None) -> list[dict]:
    """Checks of each law over all Reynolds numbers: n without walls (table VI), and of each bed (tables III, IV)."""
    return [*_without_walls(folder), *_of_beds()]


def _of_beds() -> list[dict]:
    """Checks against the 29 beds, each at the Reynolds number of its own lone sphere; their tubes are in what was
    measured."""
    rows = measured.table("richardson_zaki_beds_1954")
    labels = [f"{row['particle']} in {row['liquid']}, D = {1e3 * row['D_m']:.0f} mm" for row in rows]
    return [
        row
        for name in LAWS
        for ours in [np.array([index(getattr(drag, name), Re) for Re in rows["Re0"]])]
        for row in measured.differences(f"index n of beds, {name}", ours, rows["n"], labels, BAR)
    ]


def _without_walls(folder: Path) -> list[dict]:
    rows = measured.table("richardson_zaki_1954")
    ours = {name: np.array([index(getattr(drag, name), Re) for Re in rows["Re"]]) for name in LAWS}
    with measured.figure(folder / "liquid_fluidisation.png", "Re of the lone sphere [-]", "n [-]") as axes:
        axes.errorbar(rows["Re"], rows["n0"], BAR, fmt="k.", label="measured, and the bar of 0.15")
        for name, values in ours.items():
            axes.semilogx(rows["Re"], values, "-", label=name)
    labels = [f"Re = {Re:g}" for Re in rows["Re"]]
    return [
        row
        for name, values in ours.items()
        for row in measured.differences(f"index n, {name}", values, rows["n0"], labels, BAR)
    ]
