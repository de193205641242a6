"""A packed bed of steel spheres that is heated from its top, Beaulieu 2020: temperature 4 cm below, from runs with the
effect `conduction` alone.

The bed is run with its mirror image above the hot top, as much over 53 C as the bed is below: between them it is 53 C
at all times. Steel conducts in its share of the volume there (the default), or as a bed by Zehner & Schluender, without
the 3 % that gas conducts beside it; or grains have what makes the bed's conductivity that of the record.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from sdph import scenes
from sdph.case import read as cases
from sdph.running import driver
from sdph.study import compare

from . import measured

BAR = 0.5  # K (head of the data)
DEPTH, WIDTH, HEIGHT = 0.04, 0.1, 0.2  # m
COLD, TOP, ICE = 20.0, 53.0, 273.15  # C, C, K
DENSITY, CAPACITY, SOLID, AIR, VOIDAGE = 7747.0, 464.0, 42.0, 0.027, 0.42  # kg/m3, J/(kg K), W/(m K) twice, -
OWN = 2.8e-7  # m2/s, from the last rows of the record itself (head of the data)
TIME, WINDOW = 4000.0, 10.0  # s; our choice, a hundredth of the time that heat takes to the thermocouple


def conductors() -> dict[str, list[str]]:
    """Overrides of what conducts: solid steel in its share of the volume, a law of beds, what the record says."""
    steel = f"grains.conductivity_W_m_K={SOLID!r}"
    return {
        "steel": [steel],
        "Zehner & Schluender": [steel, "conduction.law='zehner_schluender'", f"gas.conductivity_W_m_K={AIR!r}"],
        "from the record's end": [f"grains.conductivity_W_m_K={OWN * DENSITY * CAPACITY!r}"],
    }


def checks(folder: Path, overrides=(), reporter=None, names=None) -> list[dict]:
    """Temperatures of each conductor against the record."""
    rows, known = measured.table("beaulieu_2020"), conductors()
    ours = {
        name: course(known[name], folder / f"heated-bed-{k}", overrides, reporter)
        for k, name in enumerate(names or known)
    }
    _figure(folder / "heated_bed.png", rows, ours)
    labels = [f"{t:.0f} s [C]" for t in rows["t_s"]]
    return [
        row
        for name, curve in ours.items()
        for row in measured.differences(
            f"packed steel 4 cm below its hot top, {name} [K]", np.interp(rows["t_s"], *curve), rows["T_C"], labels, BAR
        )
    ]


def course(conductor: list[str], folder: Path, overrides, reporter) -> np.ndarray:
    """Times [s] and temperatures [C] at the thermocouple of a bed with overrides of `conductors`."""
    given = cases.located(scenes.find("disc_cluster")[1])
    del given["heat"]  # the gas among the grains has a thousandth of their heat
    for text in (*_given(), *conductor, *overrides):
        cases.put(given, text)
    case = cases.from_working_directory(given)
    driver.run(case, "disc_cluster", folder, None, reporter)
    h = compare.open_run(folder).history
    return np.array([h["time_s"], h["centre_temperature_K"] - ICE])


def _given() -> list[str]:
    share = 1.0 - VOIDAGE
    half = f"shape='box', volume_fraction={share!r}"
    cold = f"{{{half}, lower_m=[0.0, 0.0], upper_m=[{WIDTH}, {HEIGHT}], temperature_K={COLD + ICE!r}}}"
    image = 2.0 * TOP - COLD + ICE
    hot = f"{{{half}, lower_m=[0.0, {HEIGHT}], upper_m=[{WIDTH}, {2.0 * HEIGHT}], temperature_K={image!r}}}"
    return [
        "coupling.gas='embedded'",
        "coupling.one_way=true",
        "effects=['conduction']",
        f"coupling.window_largest_s={WINDOW}",
        f"run.end_time_s={TIME}",
        f"run.output_interval_s={TIME}",
        "run.report_at_s=[]",
        f"domain.size_m=[{WIDTH}, {2.0 * HEIGHT}]",
        "resolution.spacing_mm=5.0",
        "resolution.cell_mm=10.0",
        f"grains.density_kg_m3={DENSITY}",
        f"grains.heat_capacity_J_kg_K={CAPACITY}",
        "grains.diameter_mm=6.4",
        f"particles={{cold={cold}, hot={hot}}}",
        f"probes.centre.at_m=[{0.5 * WIDTH}, {HEIGHT - DEPTH}]",
    ]


def _figure(file: Path, rows, ours) -> None:
    with measured.figure(file, "t [s]", "4 cm below the top [C]") as axes:
        axes.plot(rows["t_s"], rows["T_C"], "k.", ms=4, label="measured")
        for name, curve in ours.items():
            axes.plot(*curve, "-", label=f"SDPH, {name}")
        axes.set_ylim(COLD - 1.0, TOP + 4.0)
