"""The height of the wave against Prosperetti 1981, from the first Fourier component of where the lower liquid is."""

from __future__ import annotations

import csv
import math
from pathlib import Path

import numpy as np

from sdph.engine.state import LIQUID
from sdph.laws import liquids
from sdph.study.compare import check

TABLE = Path(__file__).parent / "prosperetti.csv"
LAPLACE = 0.0182571749236**-2  # -: sigma rho L/mu^2 of the table (its head), 3000.08
HIGH = 0.01  # -: height at the start over the length, of the table (its head)
HEIGHT = 0.03  # of the height at the start, root mean square: issue 19; 2 % at 32 cells a wave is good for grids
EVERY = 12  # rows of the table of which one is drawn; our choice


def heights(run) -> tuple[np.ndarray, np.ndarray]:
    """(times [s], heights over that at the start): 2/L sum V cos(k x) of the lower liquid is the amplitude of its
    surface, as the rest of it is even."""
    case, found = run.case, []
    pool, times = case.pools["lower"], np.arange(0.0, run.summary["time_s"], case.run.output_interval)
    length = pool.upper[0] - pool.lower[0]
    for time in times:
        _, points, _ = run.fields(time)
        own = points["kind"] == LIQUID
        phase = 2.0 * np.pi * (points.points[own, 0] - pool.centre[0]) / length
        found.append(2.0 / length * (points["mass"][own] * np.cos(phase)).sum() / case.liquid.density)
    return times, np.array(found) / pool.displacement


def solution(case, times) -> np.ndarray:
    """Height (T,) over that at the start by Prosperetti at times (T,) [s]."""
    pool = case.pools["lower"]
    return liquids.capillary_wave(
        times, pool.upper[0] - pool.lower[0], case.parameters["surface_tension"].coefficient, case.liquid.density,
        case.gas_phase.density, case.liquid.viscosity / case.liquid.density,
    )  # fmt: skip


def table(case) -> tuple[np.ndarray, np.ndarray]:
    """(times [s], heights over that at the start, without their sign) of prosperetti.csv for the liquids of a case;
    none where they are not those of the table."""
    pool, tension = case.pools["lower"], case.parameters["surface_tension"].coefficient
    length, density, viscosity = pool.upper[0] - pool.lower[0], case.liquid.density, case.liquid.viscosity
    laplace = tension * density * length / viscosity**2
    alike = (case.gas_phase.density, case.gas_phase.viscosity) == (density, viscosity)
    if not alike or not math.isclose(laplace, LAPLACE, rel_tol=1e-6):
        return np.zeros(0), np.zeros(0)
    with open(TABLE, encoding="utf-8") as file:
        _, *rows = csv.reader(line for line in file if not line.startswith("#"))
    phase, height = np.array(rows, dtype=float).T
    return phase / math.sqrt(tension * (2.0 * math.pi / length) ** 3 / (2.0 * density)), height / HIGH


def off(run, times, ours) -> float:
    """Root mean square by which heights (T,) over that at the start are off at times (T,) [s]."""
    return float(np.sqrt(np.mean((ours - solution(run.case, times)) ** 2)))


def metrics(run) -> dict:
    """Values for `sdph cost`: (value, reference, scale)."""
    return {"height": (off(run, *heights(run)), 0.0, 1.0)}


def exact(run) -> list[dict]:
    own = heights(run)
    _figure(run, *own)
    return [check("height over that at the start, root mean square", off(run, *own), 0.0, HEIGHT)]


def _figure(run, times, ours) -> None:
    """Height against time into the run's folder: the run, the solution, the table with the solution's sign."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    drawn, axes = pyplot.subplots(figsize=(6.5, 4.0), constrained_layout=True)
    fine, (told, height) = np.linspace(0.0, run.summary["time_s"], 500), table(run.case)
    shown = np.flatnonzero(told <= run.summary["time_s"])[::EVERY]
    axes.plot(fine, solution(run.case, fine), "k-", lw=1, label="Prosperetti 1981")
    if len(shown):
        signed = np.copysign(height[shown], solution(run.case, told[shown]))
        axes.plot(told[shown], signed, "kx", ms=4, label="his, as tabulated by Popinet & Zaleski 1999")
    axes.plot(times, ours, "C3o-", ms=3, lw=1, label="SDPH")
    axes.set(xlabel="t [s]", ylabel="height over that at the start [-]")
    axes.legend(fontsize=8)
    drawn.savefig(run.folder / "wave.png", dpi=90)
    pyplot.close(drawn)
