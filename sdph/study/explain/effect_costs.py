"""Cost of each effect on this machine, in microseconds per particle and sub-step: a case with it, less the same
without.

Only grains that move: particle side and exchange, no gas solver. Times are the least of several, taken in turns.
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
from sdph.running.simulation import Simulation
from sdph.study.explain import estimate

ROUNDS = 7  # the least of so many counts
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
            budget=Budget(0.0, 0.0, 0.0, NOTHING, 0.0, 0.0, 0.0, 0.0),
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
    keep(min(row["with all [us]"] for row in rows))
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


def keep(moving: float) -> None:
    """Remember the speed of this machine for the estimates of `sdph explain`; the rest in the shipped proportion."""
    ratio = moving / estimate.SHIPPED.moving
    shipped = estimate.SHIPPED._asdict() | {"measured": f"this machine, {time.strftime('%Y-%m-%d')}"}
    estimate.MEASURED.parent.mkdir(parents=True, exist_ok=True)
    estimate.MEASURED.write_text(json.dumps({k: v if isinstance(v, str) else v * ratio for k, v in shipped.items()}))
