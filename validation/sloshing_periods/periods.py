"""First sloshing periods of box, cylinder and sphere against linear theory.

    python validation/sloshing_periods/periods.py [box,cylinder,sphere] [0.15,0.25,0.5] [spacings in a radius: 12]
    [h/dx: 1.5] \\
        [shake in mm] [pressure gradient: corrected]

A tank at rest is shaken for two periods of the linear frequency and let go; the period is that of the damped harmonic
fitted to the liquid's centre of mass over four further ones. The box is two-dimensional, its half length the radius;
box and cylinder are as high as they are wide, so that a fill of 0.5 is a depth of one radius. It is shaken by 4 mm, or
by a sixtieth of the depth where that is less: waves are then a tenth of the depth high at most in the box, a sixth in
the cylinder, and linear theory is of small ones.
"""

from __future__ import annotations

import csv
import math
import sys
import tempfile
from pathlib import Path

import numpy as np

from sdph.case import read as cases
from sdph.laws import liquids
from sdph.running.alone import Alone
from sdph.running.metrics.periods import ringing

G = 9.81  # m/s2
RADIUS = 0.5  # m
SHAKEN, FREE = 2, 4  # periods
COURANT = 0.5  # twice the default
SHAKE, OF_DEPTH = 4e-3, 1.0 / 60.0  # m; see above
FIRST_ROOT = 1.8412  # of J_1', NASA SP-106
BARS = {12: 0.03, 25: 0.01}  # liquids.md


def linear(shape: str, fill: float) -> tuple[float, float]:
    """(omega [rad/s], depth [m]) of the first antisymmetric mode; of the sphere from sphere.csv (its head names the
    source)."""
    depth = 2.0 * RADIUS * fill
    if shape == "box":
        return liquids.box_slosh(2.0 * RADIUS, depth, G), depth
    if shape == "cylinder":
        k = FIRST_ROOT / RADIUS
        return math.sqrt(G * k * math.tanh(k * depth)), depth
    with open(Path(__file__).parents[1] / "sloshing_sphere" / "modes.csv", encoding="utf-8") as file:
        rows = [
            row for row in csv.DictReader(line for line in file if not line.startswith("#")) if row["tank"] == "sphere"
        ]
    row = next(row for row in rows if float(row["fill_fraction"]) == fill)
    return math.sqrt(float(row["omega1_sq_R_over_g"]) * G / RADIUS), RADIUS * float(row["depth_over_R"])


def tank(shape: str, fill: float, across: int, ratio: float, shake: float, gradient: str):
    """The case, shaken by `shake` [m], and the linear frequency."""
    omega, depth = linear(shape, fill)
    period, d = 2.0 * math.pi / omega, 2 if shape == "box" else 3
    middle = {"centre_m": [RADIUS] * 3, "radius_m": RADIUS} | (
        {"length_m": 2.0 * RADIUS} if shape == "cylinder" else {}
    )
    box = {"shape": "box", "lower_m": [0.0, 0.0], "upper_m": [2.0 * RADIUS, depth]}
    end = (SHAKEN + FREE) * period
    table = {
        "dimensions": d, "effects": ["gravity", "frame", "density_diffusion", "liquid_damping", "tank"],
        "run": {"end_time_s": end, "output_interval_s": end},
        "domain": {"size_m": [2.0 * RADIUS] * d, "gravity_m_s2": [0.0] * (d - 1) + [-G]},
        "resolution": {"spacing_mm": 1e3 * RADIUS / across, "smoothing_ratio": ratio},
        "liquid": {"density_kg_m3": 1000.0, "sound_speed_m_s": 10.0 * math.sqrt(G * depth),
        "history_interval_s": period / 50.0,
                   "pressure_gradient": gradient, "courant": COURANT},
        "frame": {"shake": [[0, shake, omega, 0.0]], "end_s": SHAKEN * period},
        "tank": {"shape": shape, "slip": "free_slip"} | ({"open_sides": ["top"]} if shape == "box" else middle),
        "pools": {"water": box if shape == "box" else {"shape": "tank", "fill": fill}},
    }  # fmt: skip
    return cases.from_table(table), omega


def finite(fill: float, amplitude: float, damping: float, time: float) -> float:
    """Period over the linear of a standing wave in the box whose centre of mass moves by `amplitude` [m] at first, and
    by exp(-damping t) of it later; of the mean square over `time` [s].

    omega = omega_0 + (k a)^2 omega_2/2 in units of sqrt(g k), omega_0^2 = tanh k h: Tadjbakhsh & Keller 1960, J. Fluid
    Mech. 8, 442.
    """
    length, depth = 2.0 * RADIUS, 2.0 * RADIUS * fill
    k = math.pi / length
    # a of a cos(k x), whose centre of mass moves by 2 a L/(pi^2 h)
    height = amplitude * math.pi**2 * depth / (2.0 * length)
    mean = -math.expm1(-2.0 * damping * time) / (2.0 * damping * time)
    w = math.sqrt(math.tanh(k * depth))
    omega_2 = (9.0 * w**-7 - 12.0 * w**-3 - 3.0 * w - 2.0 * w**5) / 32.0
    return w / (w + 0.5 * (k * height) ** 2 * mean * omega_2)


def measure(shape: str, fill: float, across: int, ratio: float, shake: float, gradient: str) -> dict:
    case, omega = tank(shape, fill, across, ratio, shake, gradient)
    with tempfile.TemporaryDirectory() as folder:
        run, rows = Alone(case, Path(folder) / "ledger.csv"), []
        run.start()
        while run.time < case.run.end_time:
            run.window()
            if run.at_row:
                rows.append(run.row())
    h = {key: np.array([row[key] for row in rows]) for key in rows[0]}
    free = h["time_s"] > 1.05 * case.parameters["frame"].end
    found, damping = ringing(h["time_s"][free], h["centre_x_m"][free], omega)
    amplitude = 0.5 * np.ptp(h["centre_x_m"][free])
    values = {
        "liquid": len(run.stepper.active),
        "ratio": omega / found,
        "damping": damping / found,
        "amplitude": amplitude / RADIUS,
    }
    if shape == "box":
        values["finite"] = finite(fill, amplitude, damping, FREE * 2.0 * math.pi / omega)
    if shape == "sphere":
        force, moment = (np.stack([h[f"wall_{name}"] for name in names], axis=1) for names in (
            ("force_x_N", "force_y_N", "force_z_N"), ("moment_x_Nm", "moment_y_Nm", "moment_z_Nm")))  # fmt: skip
        lever = np.cross([RADIUS] * 3, force)
        values["lever"] = float(np.sqrt(((moment - lever) ** 2).sum() / (lever**2).sum()))
    return values


def main(
    shapes: str = "box,cylinder,sphere", fills: str = "0.15,0.25,0.5", across: str = "12", ratio: str = "1.5",
    shake: str = "", gradient: str = "corrected",
) -> None:  # fmt: skip
    print(
        "| tank | fill | R/dx | h/dx | shaken by [mm] | gradient | liquid particles | period over the linear | bar | "
        "damping | centre moves by [R] | waves so high: | M less r_c x F |"
    )
    print("|--|--|--|--|--|--|--|--|--|--|--|--|--|", flush=True)
    for shape in shapes.split(","):
        for fill in map(float, fills.split(",")):
            by = 1e-3 * float(shake) if shake else min(SHAKE, OF_DEPTH * linear(shape, fill)[1])
            found = measure(shape, fill, int(across), float(ratio), by, gradient)
            waves = f"{found['finite']:.4f}" if "finite" in found else ""
            lever = f"{100.0 * found['lever']:.2f} %" if "lever" in found else ""
            bar = BARS.get(int(across), math.nan)
            verdict = "" if abs(found["ratio"] - 1.0) <= bar else " (missed)"
            print(
                f"| {shape} | {fill:g} | {across} | {ratio} | {1e3 * by:g} | {gradient} | {found['liquid']} | "
                f"{found['ratio']:.4f}{verdict} | {100 * bar:g} % | {found['damping']:.4f} | "
                f"{found['amplitude']:.3f} | {waves} | {lever} |",
                flush=True,
            )


if __name__ == "__main__":
    main(*sys.argv[1:])
