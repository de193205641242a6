"""A lone drop of a real fluid in a gas without end, from a run of the scene single_droplet with numbers of CoolProp.

The drop's numbers are what `fluid = "..."` makes of them: constants, liquid at its first temperature, vapour and
diffusivity at the film's. `linear` has `coupling.film`, that is the gas as at the film of each moment; `spalding` knows
no film, and gets the gas as the library has it at the film of the start.
"""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np

from sdph import scenes
from sdph.case import fluids
from sdph.case import read as cases
from sdph.effects.gas import film
from sdph.running import driver
from sdph.study import compare

LAWS = ("linear", "spalding")
WINDOWS = 200  # of the time that was measured, and more where the case asks for it; our choice
ICE = 273.15  # K


class Drop(NamedTuple):
    """A drop that was measured: fluids by their names; diameter [m], temperatures [K], pressure [Pa]; the stream's
    speed [m/s] and mass fraction of vapour [-]; time [s] over which it was followed."""

    liquid: str
    gas: str
    diameter: float
    cold: float
    hot: float
    time: float
    pressure: float = fluids.ATMOSPHERE
    speed: float = 0.0
    humidity: float = 0.0


def course(drop: Drop, law: str, folder: Path, overrides, reporter, longer: float = 1.0) -> np.ndarray:
    """Times [s], squares of the diameter over the first, temperatures [K] of the drop as long as it is there; the run
    takes `longer` times as long as the measurement did."""
    case = cases.load(scenes.find("single_droplet")[1], (*given(drop, law, longer), *overrides))
    driver.run(case, "single_droplet", folder, None, reporter)
    h = compare.open_run(folder).history
    there = np.isfinite(h["particle_1_diameter_m"])
    square = (h["particle_1_diameter_m"][there] / drop.diameter) ** 2
    return np.array([h["time_s"][there], square, h["particle_1_temperature_K"][there]])


def given(drop: Drop, law: str, longer: float = 1.0) -> list[str]:
    """Overrides of the scene: its gas, liquid and vapour give way to those of the drop."""
    end, window = longer * drop.time, drop.time / WINDOWS
    gas = f"fluid={drop.gas!r}, temperature_K={drop.hot!r}, operating_pressure_Pa={drop.pressure!r}"
    if law == "spalding":
        around = film.temperature(drop.hot, drop.cold)
        numbers = fluids.filled({"gas": {"fluid": drop.gas, "temperature_K": around, **_at(drop.pressure)}})["gas"]
        gas += "".join(f", {key}={numbers[key]!r}" for key in fluids.OF_GAS)
    return [
        "coupling.gas='embedded'",
        f"coupling.window_largest_s={window!r}",
        f"coupling.film={str(law == 'linear').lower()}",
        f"run.end_time_s={end!r}",
        f"run.output_interval_s={end!r}",
        f"gas={{{gas}}}",
        f"grains={{fluid={drop.liquid!r}, diameter_mm={1e3 * drop.diameter!r}}}",
        f"vapour={{mass_fraction={drop.humidity!r}}}",
        f"evaporation={{law={law!r}}}",
        f"particles.droplet.temperature_K={drop.cold!r}",
        *(_stream(drop) if drop.speed else ()),
    ]


def _at(pressure: float) -> dict[str, float]:
    return {"operating_pressure_Pa": pressure}


def _stream(drop: Drop) -> list[str]:
    """The gas blows past: it comes in from the left."""
    state = f"temperature_K={drop.hot!r}"
    return [
        "coupling.courant=1e6",  # the stream is even: no window has to follow it
        "boundaries.walls.kind='slip_wall'",
        f"boundaries.upstream={{kind='velocity_inlet', side='left', velocity_m_s=[{drop.speed!r}, 0.0], {state}}}",
        f"boundaries.downstream={{kind='pressure_outlet', side='right', pressure_Pa=0.0, {state}}}",
    ]


def slope(times, squares, most: float = 1.0, least: float = 0.0) -> float:
    """-d(d^2/d_0^2)/dt [1/s] by least squares over the squares [-] from `least` to `most`."""
    here = (squares <= most) & (squares >= least)
    return -float(np.polyfit(times[here], squares[here], 1)[0])
