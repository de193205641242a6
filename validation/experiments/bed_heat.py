"""Nusselt number of a packed bed that gas is heated in, from runs of the column of the scene fluidised_column, against
the law of Wakao & Funazkri 1978 for gases and against the law that the runs use.

Grains of 3 mm, which nothing moves, are 50 K hotter than the gas that comes in, and too heavy to cool. The number
is that of the run's own heat balance: of what gas leaves with, and of the closed form of a bed in which heat is
exchanged and conducted along the flow, D T'' - U T' + U s (T_p - T) = 0, s = 6 alpha_p Nu k/(d rho c_p U d).

What is settled, before any result: Re 10 and 100, four cells of bed, cells of 3.3 grains, the scene's and such as
`sdph explain` calls safe, and cells of a third of a grain. Gas takes the temperature of grains within a grain or two,
and what lies within a cell the gas does not see: that is how far the coarse bed is from its own law.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from sdph import scenes
from sdph.case import read as cases
from sdph.laws import heat
from sdph.running import driver
from sdph.study import compare

from . import bed_transfer, measured

BAR = bed_transfer.BANDS["gas_evaporation_Sc0.6"]  # of Nu, of the markers about Wakao & Funazkri's law
OWN = 0.05  # of the law that the run uses; our choice, as the bar of friction in packed beds
NUMBERS = (10.0, 100.0)  # Re, superficial
GRAIN, SHARE, RISE = 3e-3, 1.0 - bed_transfer.VOIDAGE, 50.0  # m, -, K of the grains over the gas that comes in
CELLS = (0.01, 0.001)  # m
LAW = "gunn"  # the default of `heat.law`
DEEP, ACROSS, TALL = 4, 3, 12  # cells of bed, width and column; the bed lies in the middle
CHANGES = 8.0  # times that the gas in the column is renewed


def checks(folder: Path, overrides=(), reporter=None, numbers=NUMBERS, cells=CELLS) -> list[dict]:
    """Nu of each Re and size of cells over that of Wakao & Funazkri's law, and over that of the law in the run."""
    told, drawn = [], []
    for cell in cells:
        for Re in numbers:
            ours, law, theirs = nusselt(Re, cell, folder, overrides, reporter)
            drawn.append((Re, cell, ours))
            name = f"heat in a packed bed, Re {Re:g}, cells of {cell / GRAIN:.2g} grains: Nu [-]"
            told.append(compare.check(f"{name}, Wakao & Funazkri", ours, theirs, BAR, True))
            told.append(compare.check(f"{name}, {LAW} alone", ours, law, OWN, True))
    _figure(folder / "bed_heat.png", drawn)
    return told


def wakao(reynolds, prandtl: float):
    """Nu of Wakao & Funazkri's law; `reynolds` superficial."""
    return 2.0 + prandtl ** (1.0 / 3.0) * bed_transfer.wakao(reynolds)


def nusselt(reynolds: float, cell: float, folder: Path, overrides, reporter) -> tuple[float, float, float]:
    """Nu [-] of a run by what its gas leaves with, of the law that it uses, and of Wakao & Funazkri's law."""
    place = folder / f"bed-heat-{reynolds:g}-{1e3 * cell:g}mm"
    case = at_rest(reynolds, cell, overrides)
    driver.run(case, "fluidised_column", place, None, reporter)
    history, gas = compare.open_run(place).history, case.gas
    hot = case.particles["bed"].temperature
    left = (hot - history["outlet_gas_out_temperature_K"][-1]) / RISE
    prandtl = heat.prandtl_number(gas.viscosity, gas.heat_capacity, gas.conductivity)
    law = getattr(heat, LAW)(1.0 - SHARE, reynolds / (1.0 - SHARE), prandtl)
    return by_balance(case, left, DEEP * cell), law, wakao(reynolds, prandtl)


def at_rest(reynolds: float, cell: float, overrides=()):
    """The scene with heat alone, for a Reynolds number and a size of cells [m]."""
    table = cases.located(scenes.find("fluidised_column")[1])
    del table["drag"]
    for text in (*given(reynolds, cell), *overrides):
        cases.put(table, text)
    return cases.from_working_directory(table)


def by_balance(case, left: float, deep: float) -> float:
    """Nu [-] of a bed of a depth [m] that a share `left` of the difference of temperatures outlasts."""
    gas, U = case.gas, case.boundaries["distributor"].velocity[1]
    fall = -math.log(left) / deep  # 1/m
    spread = (1.0 - SHARE) * gas.conductivity / (gas.density * gas.heat_capacity)  # m2/s, over the whole section
    s = fall * (1.0 + spread * fall / U)
    return s * gas.density * gas.heat_capacity * U * GRAIN**2 / (6.0 * SHARE * gas.conductivity)


def given(reynolds: float, cell: float) -> list[str]:
    """Overrides of the scene for a Reynolds number and a size of cells [m]."""
    scene = cases.load(scenes.find("fluidised_column")[1])
    gas = scene.gas
    U = reynolds * gas.viscosity / (gas.density * GRAIN)
    width, top, below = ACROSS * cell, TALL * cell, 0.5 * (TALL - DEEP) * cell
    end = CHANGES * top / U
    return [
        "coupling.gas='embedded'",
        "coupling.window_largest_s=0.01",
        "effects=['heat', 'walls']",  # nothing pushes the grains
        f"heat.law={LAW!r}",
        "domain.gravity_m_s2=[0.0, -1e-9]",  # says which way is up
        f"domain.size_m=[{width!r}, {top!r}]",
        f"resolution.spacing_mm={500.0 * cell!r}",
        f"resolution.cell_mm={1e3 * cell!r}",
        "grains.density_kg_m3=1e6",
        f"grains.diameter_mm={1e3 * GRAIN!r}",
        f"particles.bed.lower_m=[0.0, {below!r}]",
        f"particles.bed.upper_m=[{width!r}, {below + DEEP * cell!r}]",
        f"particles.bed.volume_fraction={SHARE!r}",
        f"particles.bed.temperature_K={gas.temperature + RISE!r}",
        f"boundaries.distributor.velocity_m_s=[0.0, {U!r}]",
        f"run.end_time_s={end!r}",
        f"run.output_interval_s={0.25 * end!r}",
    ]


def _figure(file: Path, drawn) -> None:
    scene = cases.load(scenes.find("fluidised_column")[1])
    prandtl = heat.prandtl_number(scene.gas.viscosity, scene.gas.heat_capacity, scene.gas.conductivity)
    markers, Re = measured.table("wakao_1978"), np.geomspace(3.0, 3000.0, 60)
    markers = markers[markers["set"] == "gas_evaporation_Sc0.6"]
    own = [getattr(heat, LAW)(1.0 - SHARE, one / (1.0 - SHARE), prandtl) for one in Re]
    with measured.figure(file, "Re, superficial [-]", "Nu [-]") as axes:
        raised = 2.0 + prandtl ** (1.0 / 3.0) * markers["reduced"]
        axes.loglog(markers["Re"], raised, ".", ms=4, c="0.6", label="measured, gas (of Sh, at the Pr of air)")
        axes.plot(Re, wakao(Re, prandtl), "k-", lw=1, label="Wakao & Funazkri, and 39 % either way")
        for share in (1.0 - BAR, 1.0 + BAR):
            axes.plot(Re, share * wakao(Re, prandtl), "k:", lw=1)
        axes.plot(Re, own, "-", c="C0", label=f"{LAW}, which the runs use")
        for k, cell in enumerate(dict.fromkeys(cell for _, cell, _ in drawn)):
            points = np.array([(one, ours) for one, of, ours in drawn if of == cell])
            axes.plot(*points.T, "os"[k % 2], c=f"C{k + 1}", label=f"SDPH, cells of {cell / GRAIN:.2g} grains")
