"""Cost of each effect of grains on this machine, in microseconds per particle and sub-step: a case with it, less the
same without; of a case without a gas the time of its own particles.

Of grains particle side and exchange, no gas solver. Times are the least of several, taken in turns.
"""

from __future__ import annotations

import json
import time
from types import SimpleNamespace

import numpy as np

from coupling.gas import NOTHING, Budget, Mesh
from sdph import scenes
from sdph.case import gas_cells
from sdph.case import read as cases
from sdph.running.alone import Alone
from sdph.running.simulation import Simulation
from sdph.study.explain import mps, prices

ROUNDS = 7  # the least of so many counts
WINDOWS = 4  # of a case without a gas, of some 20 steps each; the first compiles
FEW = 1000  # particles, of fewer the time of a step hangs on their number little: not kept for other cases; our choice
BED = ("resolution.spacing_mm=10", "resolution.cell_mm=20")


class Still:
    """A gas at rest on the case's cells: enough for particles and exchange to do their whole work."""

    def __init__(self, case):
        counts = gas_cells.cells(case)
        ticks = [(np.arange(n) + 0.5) * length / n for n, length in zip(counts, case.domain.size)]
        grid = np.meshgrid(*ticks, indexing="ij")
        centres = np.stack([g.ravel() for g in grid] + [np.zeros(grid[0].size)] * (3 - len(grid)), axis=1)
        volume = float(np.prod([length / n for n, length in zip(counts, case.domain.size)]))
        self.mesh = Mesh(centres, np.full(len(centres), volume), case.dimensions)
        zeros = np.zeros((len(centres), 3))
        fields = {
            "velocity": zeros + 0.1,
            "pressure": zeros[:, 0],
            "pressure_gradient": zeros,
            "vapour_mass_fraction": zeros[:, 0],
        }
        full = {"temperature": case.gas.temperature + 10.0, "density": case.gas.density}
        self.state = SimpleNamespace(
            fields=fields | {name: np.full(len(centres), value) for name, value in full.items()},
            budget=Budget(
                0.0, 0.0, 0.0, NOTHING, 0.0, 0.0, 0.0, 0.0, crossed=dict.fromkeys(case.boundaries, [0.0] * 4)
            ),
        )

    def start(self, alpha_g, sources, fields=()):
        return self.state


class NoLedger:
    """Takes the rows of a ledger and keeps none."""

    table = None

    def open(self, *row) -> None:
        """The first row."""

    def close_window(self, *row) -> None:
        """A row of a window."""


def prepared(case) -> Simulation:
    """A simulation of the case that has started on gas at rest."""
    simulation = Simulation(case, Still(case), NoLedger())
    simulation.start()
    return simulation


def step(simulation, dt: float) -> float:
    """Wall time [s] of one sub-step of `dt` [s], its exchange included."""
    simulation.grains.begin()
    count, started = len(simulation.state.x), time.perf_counter()
    push = sum(simulation._body(simulation.hand(dt)))
    simulation.stepper.force(np.zeros(count), push, np.zeros(count))
    simulation.stepper.move(dt)
    simulation.grains.close()
    return time.perf_counter() - started


def measured(case, report=print) -> list[dict]:
    """Rows of what concerns a case, of which `sdph explain` keeps the times: of grains, or of each other matter by
    itself."""
    if case.grains:
        return table(report)
    return [row for matter in case.matters for row in alone(case.only(matter), report)]


def alone(case, report=print) -> list[dict]:
    """Time [us] of a particle and step of a case without a gas, of its first steps; kept unless they are FEW."""
    run, found = Alone(case, None), []
    run.start()
    for _ in range(WINDOWS):
        if run.clock.over(run.time):
            break
        steps, before = run.stepper.steps, run.wall["particles"]
        run.window()
        spent = run.wall["particles"] - before  # without compiling
        found.append(1e6 * spent / max(1, run.stepper.steps - steps) / len(run.state.x))
    name = case.moved_by(run.matter)
    report(f"{name}: {min(found):.3f} us")
    if len(run.state.x) >= FEW:
        keep(**({"solid": min(found)} if name == "solid" else {"liquid": min(found) / _of_liquid(case, name)}))
    return [{"method": name, "particle and step [us]": min(found)}]


def _of_liquid(case, method: str) -> float:
    """Time of a particle of a liquid and a step over the one that `Speed` has."""
    return mps.ROWS if method == "mps" else prices.of_liquid(case) / prices.speed().liquid


def table(report=print) -> list[dict]:
    """Effect -> microseconds per particle and sub-step; keeps the time of the whole for `sdph explain`."""
    whole = cases.load(scenes.HERE / "bubbling_bed" / "case.toml", BED)
    rows, dt = [], 1e-7
    for name in whole.effects:
        on, off = prepared(whole), prepared(without(whole, name))
        pairs = [(step(on, dt), step(off, dt)) for _ in range(ROUNDS + 1)][1:]
        best_on, best_off = (1e6 * min(column) / len(on.state.x) for column in zip(*pairs))
        rows.append(
            {"effect": name, "with all [us]": best_on, "without it [us]": best_off, "costs [us]": best_on - best_off}
            | _leaves(on, off)
        )
        report(f"{name}: {best_on - best_off:.3f} us")
    ratio = min(row["with all [us]"] for row in rows) / prices.SHIPPED.moving  # the rest in the shipped proportion
    keep(**{key: getattr(prices.SHIPPED, key) * ratio for key in prices.OF_GRAINS})
    return rows


def without(case, name: str):
    table = cases.to_table(case)
    table["effects"] = [other for other in table["effects"] if other != name]
    table.pop(name, None)
    return cases.from_table(table)


def _leaves(on, off) -> dict:
    """Arrays and sources that are there only because of the effect."""
    arrays = [name for name in on.state._fields if len(getattr(on.state, name)) and not len(getattr(off.state, name))]
    sources = [name for name in on.exchange.sources if name not in off.exchange.sources]
    return {"arrays only it needs": " ".join(arrays) or "-", "sources only it sends": " ".join(sources) or "-"}


def keep(**times) -> None:
    """Remember times [us] of this machine for the estimates of `sdph explain`."""
    known = prices.speed()._asdict() | times | {"measured": f"this machine, {time.strftime('%Y-%m-%d')}"}
    prices.MEASURED.parent.mkdir(parents=True, exist_ok=True)
    prices.MEASURED.write_text(json.dumps(known))
