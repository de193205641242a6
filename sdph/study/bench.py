"""`sdph bench`: the main ratios of speed on this machine, beside those that were measured on ours (`bench.toml`).

Times are the least of several, each ratio is of one run; `benchmarks/` takes them apart.
"""

from __future__ import annotations

import math
import os
import subprocess
import sys
import tempfile
import time
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numba
import numpy as np

from sdph import scenes
from sdph.case import read as cases
from sdph.methods.liquids.method import LiquidStepper
from sdph.running.simulation import Simulation
from sdph.schema import CaseError
from sdph.study.explain.effect_costs import NoLedger

OURS = Path(__file__).with_name("bench.toml")
WIDTH = 0.05715  # m, of the column of dam_break; twice as high
DEEP = (
    "dimensions=3", f"domain.size_m=[{5 * WIDTH}, {3 * WIDTH}, {WIDTH}]", "domain.gravity_m_s2=[0.0, -9.81, 0.0]",
    "pools.column.lower_m=[0.0, 0.0, 0.0]", f"pools.column.upper_m=[{WIDTH}, {2 * WIDTH}, {WIDTH}]",
)  # fmt: skip
STEPS = 6  # of a liquid between two lists of neighbours: one on its way needs that every 8 to 20
BEGUN, WINDOWS = 0.005, 10  # s of the bed before it is timed; windows of a round: our choice
ROUNDS, SECONDS = 3, 6.0  # of each thing that is timed: our choice
LONG = "run.end_time_s=100.0", "run.output_interval_s=100.0"  # none of it stands in the way of a window
BED = 0.1  # s of the bed beside two fluids: our choice
LARGE, SMALL = (5.0, 10.0), (27.8, 20.0)  # mm, particles and cells of beds of 10 000 and of 324 particles
LIQUIDS = {"liquid_2d_us": (2, 1e4), "liquid_3d_us": (3, 1e5)}  # row -> dimensions and particles


class Row(NamedTuple):
    """One line of the table; `value` is nan where it was not measured, which `note` gives the reason of."""

    key: str
    what: str
    value: float
    note: str = ""


def bed(spacing: float, cell: float, until: float = BEGUN) -> Simulation:
    """The bubbling bed on the embedded gas after `until` [s]; particles and cells [mm]."""
    from coupling.embedded import EmbeddedGas

    sets = f"resolution.spacing_mm={spacing}", f"resolution.cell_mm={cell}", *LONG
    case = cases.load(scenes.find("bubbling_bed")[1], sets)
    simulation = Simulation(case, EmbeddedGas(case), NoLedger())
    simulation.start()
    while simulation.time < until:
        simulation.window()
    return simulation


def dam(dimensions: int, count: float):
    """Case of a dam break of about `count` particles of liquid, in three dimensions as deep as it is wide."""
    spacing = (2.0 * WIDTH**dimensions / count) ** (1.0 / dimensions) * 1e3
    given = (f"resolution.spacing_mm={spacing}", *(DEEP if dimensions == 3 else ()))
    return cases.load(scenes.find("dam_break")[1], given)


def tank(dimensions: int, count: float) -> LiquidStepper:
    """The same, begun."""
    return LiquidStepper(dam(dimensions, count))


def step_time(stepper: LiquidStepper) -> float:
    """Mean wall time [s] of a step, the rows made anew once in STEPS."""
    started = time.perf_counter()
    stepper.neighbours.built = ()
    for _ in range(STEPS):
        stepper.step(1.0)
    return (time.perf_counter() - started) / STEPS


def least(measure: Callable[[], np.ndarray | float]):
    """The least of ROUNDS, or of as many as begin within SECONDS, entry by entry."""
    begun, found = time.monotonic(), []
    while len(found) < ROUNDS or time.monotonic() - begun < SECONDS:
        found.append(measure())
    return np.min(found, axis=0)


def windows(simulation: Simulation) -> np.ndarray:
    """Wall times [s] of a sub-step and of a window's exchange, means over WINDOWS."""
    before, steps = dict(simulation.wall), simulation.stepper.steps
    for _ in range(WINDOWS):
        simulation.window()
    particles, exchange = (simulation.wall[name] - before[name] for name in ("particles", "exchange"))
    return np.array([particles / (simulation.stepper.steps - steps), exchange / WINDOWS])


def rows(say: Callable[[str], None]) -> list[Row]:
    """All rows; `say` hears what is measured next."""
    say("grains, 10 000 in two dimensions, all effects")
    large = bed(*LARGE)
    count = len(large.state.x)
    sub_step, exchange = least(lambda: windows(large))
    threads = numba.get_num_threads()
    numba.set_num_threads(1)
    alone, _ = least(lambda: windows(large))
    numba.set_num_threads(threads)
    say("grains, 324")
    small = bed(*SMALL)
    few, _ = least(lambda: windows(small))
    found = [
        Row("grains_us", "grains, 2-D, 10 000, all effects: a particle and sub-step [us]", 1e6 * sub_step / count),
        Row("grains_threads", f"the same on one thread over {threads}", alone / sub_step),
        Row("few_over_many", "sub-step of 324 grains over one of 10 000", few / sub_step),
        Row("exchange_over_sub_step", "exchange of a window over a sub-step of its grains", exchange / sub_step),
    ]
    for key, (dimensions, number) in LIQUIDS.items():
        say(f"liquid, {number:.0f} in {dimensions} dimensions")
        stepper = tank(dimensions, number)
        spent = 1e6 * float(least(lambda of=stepper: step_time(of))) / len(stepper.active)
        found.append(Row(key, f"liquid, {dimensions}-D, {number:.0f}, delta-SPH: a particle and step [us]", spent))
    spent = {row.key: row.value for row in found}
    ratio = spent["grains_us"] / spent["liquid_2d_us"]
    found.append(Row("grains_over_liquid", "grains over liquid, 2-D, a particle", ratio))
    say(f"the bed, {BED:g} s, and twoPhaseEulerFoam on the same cells")
    return [*found, beside_two_fluids()]


def beside_two_fluids() -> Row:
    """The bed of BED seconds, a program from start to end, over twoPhaseEulerFoam, blockMesh and setFields too."""
    from coupling.gas import GasError
    from coupling.openfoam.comparators.run import run_two_fluid

    what = f"bed of {BED:g} s, embedded gas, over twoPhaseEulerFoam: wall time"
    case = cases.load(scenes.find("bubbling_bed")[1], (f"run.end_time_s={BED}",))
    with tempfile.TemporaryDirectory(prefix="sdph-bench-") as folder:
        command = [sys.executable, "-m", "sdph.cli", "run", "bubbling_bed", "--until", str(BED), "--gas", "embedded"]
        begun = time.monotonic()
        subprocess.run([*command, "--out", os.path.join(folder, "run")], check=True, capture_output=True)
        ours, begun = time.monotonic() - begun, time.monotonic()
        try:
            run_two_fluid(case, Path(folder) / "tfm", again=True)
        except (CaseError, GasError) as reason:
            return Row("bed_over_two_fluids", what, math.nan, str(reason).splitlines()[0])
        return Row("bed_over_two_fluids", what, ours / (time.monotonic() - begun))


def ours() -> dict:
    """Machine, date and values of bench.toml."""
    return tomllib.loads(OURS.read_text(encoding="utf-8"))


def table(found: list[Row]) -> str:
    """Lines for a reader: here, and ours."""
    known, lines = ours(), [f"{'':68s}{'here':>9s}{'ours':>9s}"]
    for row in found:
        here, there = (
            "-" if math.isnan(own) else f"{own:.3g}" for own in (row.value, known["values"].get(row.key, math.nan))
        )
        lines.append(f"{row.what:68s}{here:>9s}{there:>9s}")
        lines += [f"    not measured: {row.note}"] if row.note else []
    return "\n".join([*lines, f"ours: {known['machine']}, {known['date']}"])


def record(found: list[Row]) -> dict:
    """The same for a program: {"rows": [{"name", "what", "value", "ours"}, ...]}; nan where nothing was measured, None
    where nothing was on ours."""
    known, keys = ours()["values"], ("name", "what", "value", "ours")
    return {"rows": [dict(zip(keys, (row.key, row.what, row.value, known.get(row.key)))) for row in found]}
