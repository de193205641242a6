"""Water drops in a stream of dry air, Ranz & Marshall 1952: rate of evaporation and temperature, from runs of the scene
single_droplet with water in the place of decane and an inlet in the place of a wall.

A drop was held at its size by feed. Here it has a ten-thousandth of its heat capacity, so that it comes to its wet bulb
before it shrinks; what is steady does not know of it.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from sdph import scenes
from sdph.case import read as cases
from sdph.running import driver
from sdph.study import compare

from . import measured, water

RATE, TEMPERATURE = 0.05, 0.7  # of the rate measured; K (README.md)
LAWS = ("linear", "spalding")
HEAT_CAPACITY = 0.418  # J/(kg K), a ten-thousandth of water's: see above
TIME, WINDOW = 0.01, 0.001  # s; a drop then takes 0.5 ms to its wet bulb, and seconds to lose a tenth
GROUPS = {1: "20-25 C", 2: "66-90 C", 3: "85-221 C"}  # air, by table of the paper
STREAM = (
    "coupling.gas='embedded'",
    "coupling.courant=1e6",  # the stream is even: no window has to follow it
    f"coupling.window_largest_s={WINDOW}",
    f"run.end_time_s={TIME}",
    f"run.output_interval_s={TIME}",
    f"grains.heat_capacity_J_kg_K={HEAT_CAPACITY}",
    f"grains.density_kg_m3={water.DENSITY}",
    "boundaries.walls.kind='slip_wall'",
    "evaporation.saturation='antoine'",
)


def checks(folder: Path, overrides=(), reporter=None, laws=LAWS, every: int = 1) -> list[dict]:
    """Rate and temperature of each law and each table; of each `every`-th row."""
    rows = measured.table("ranz_marshall_1952")[::every]
    ours = {law: np.array([drop(row, law, folder, overrides, reporter) for row in rows]).T for law in laws}
    _figures(folder, rows, ours)
    return [
        check
        for law, (rate, temperature) in ours.items()
        for number, name in GROUPS.items()
        for check in _group(f"{law}, {name}", rows, rate, temperature, rows["table"] == number)
    ]


def _group(name: str, rows, rate, temperature, here) -> list[dict]:
    found = []
    for what, unit, ours, key, against, bar in (
        ("rate", "1e-11 m3/s", rate, "evaporation_1e-11_m3_s", measured.ratios, RATE),
        ("temperature", "C", temperature, "T_drop_C", measured.differences, TEMPERATURE),
    ):
        known = here & np.isfinite(rows[key])
        labels = [f"run {run:g} [{unit}]" for run in rows["run"][known]]
        if known.any():
            found += against(f"drop's {what}, {name}", ours[known], rows[key][known], labels, bar)
    return found


def drop(row, law: str, folder: Path, overrides, reporter) -> tuple[float, float]:
    """Rate [1e-11 m3/s] and temperature [C] of a drop as a row of the table has it, when both are steady."""
    given = (*STREAM, *_conditions(row), f"evaporation.law='{law}'", *overrides)
    case = cases.load(scenes.find("single_droplet")[1], given)
    own = folder / f"drop-{law}-{row['table']:g}-{row['run']:g}"
    driver.run(case, "single_droplet", own, None, reporter)
    h = compare.open_run(own).history
    mass, time = h["particle_1_mass_kg"], h["time_s"]
    drops = mass[0] / (case.grains.density * math.pi / 6.0 * case.grains.diameter**3)
    rate = -(mass[-1] - mass[-2]) / (time[-1] - time[-2]) / drops / case.grains.density
    return 1e11 * rate, h["particle_1_temperature_K"][-1] - water.ICE


def _conditions(row) -> list[str]:
    """Overrides of a row: stream, air and vapour midway between air and drop, water at the drop's temperature."""
    hot, pressure = float(row["T_air_C"]) + water.ICE, float(row["p_Pa"])
    cold = water.wet_bulb(hot, pressure)
    film = 0.5 * (hot + cold)
    tables = {
        "gas": water.air(film, pressure) | {"temperature_K": hot},
        "vapour": water.vapour(film, pressure),
        "evaporation": {"latent_heat_J_kg": water.latent_heat(cold), "antoine": list(water.antoine(cold))},
        "grains": {"diameter_mm": 1e3 * float(row["d_m"])},
        "particles.droplet": {"temperature_K": cold},
    }
    stream = f"kind='velocity_inlet', side='left', velocity_m_s=[{float(row['U_m_s'])!r}, 0.0], temperature_K={hot!r}"
    return [
        *(f"{section}.{key}={value!r}" for section, keys in tables.items() for key, value in keys.items()),
        f"boundaries.upstream={{{stream}}}",
        f"boundaries.downstream={{kind='pressure_outlet', side='right', pressure_Pa=0.0, temperature_K={hot!r}}}",
    ]


def _figures(folder: Path, rows, ours) -> None:
    with measured.figure(folder / "water_drops_rate.png", "measured [1e-11 m3/s]", "SDPH [1e-11 m3/s]") as axes:
        _parity(axes, rows["evaporation_1e-11_m3_s"], {law: rate for law, (rate, _) in ours.items()}, RATE)
    with measured.figure(folder / "wet_bulb.png", "air [C]", "drop [C]") as axes:
        axes.plot(rows["T_air_C"], rows["T_drop_C"], "k.", label="measured")
        for marker, (law, (_, temperature)) in zip("ox", ours.items()):
            axes.plot(rows["T_air_C"], temperature, marker, mfc="none", label=f"SDPH, {law}")


def _parity(axes, found, ours, share: float) -> None:
    for marker, (law, values) in zip("ox", ours.items()):
        axes.plot(found, values, marker, mfc="none", label=f"SDPH, {law}")
    ends = np.array([np.nanmin(found), np.nanmax(found)])
    axes.plot(ends, ends, "k-", lw=1, label=f"as measured, and {100 * share:g} % either way")
    for by in (1.0 - share, 1.0 + share):
        axes.plot(ends, by * ends, "k:", lw=1)
