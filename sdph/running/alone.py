"""A run without a gas: a method alone goes from row to row of its history."""

from __future__ import annotations

import time as clock
from pathlib import Path

from sdph.engine.clock import Clock
from sdph.engine.kept import Unfit
from sdph.methods.liquids.liquid import Liquid
from sdph.running.limiters import Limiters

SAMPLES = 10  # rows of history.csv for each output of fields, where the case says nothing
STRIDE = 20  # steps in a window at most: a liquid that goes unstable is caught within these (our choice)


class Alone:
    """A liquid without a gas; call `window` until `time` is the end."""

    gas = None
    KEPT = ("windows", "wall", "clock", "liquid", "limiters")  # see sdph.engine.kept

    def __init__(self, case, ledger: Path):
        self.case = case
        self.clock = Clock(case.run, case.liquid.history_interval or case.run.output_interval / SAMPLES)
        self.liquid = Liquid(case, ledger, self.clock.shortest)
        self.limiters = Limiters()
        self.limiters.hear(self.liquid.held())
        self.windows, self.wall, self.notices = 0, {"particles": 0.0}, []

    @property
    def state(self):
        return self.liquid.state

    @property
    def stepper(self):
        return self.liquid.stepper

    @property
    def ledger(self):
        return self.liquid.ledger

    @property
    def time(self) -> float:
        return self.liquid.time

    @property
    def at_row(self) -> bool:
        """True where the history has a row of now."""
        return self.clock.rows_at(self.time)

    @staticmethod
    def time_of(kept: dict) -> float:
        """Time [s] of what was kept."""
        return kept["liquid"]["stepper"]["time"]

    @staticmethod
    def windows_of(kept: dict) -> int:
        """Windows of what was kept."""
        return kept["windows"]

    def tables(self) -> list:
        """Ledgers that are open."""
        return [self.ledger.table]

    def start(self) -> None:
        self.liquid.start()

    def admit(self, kept: dict) -> None:
        """Unfit where the liquid has gone through other windows."""
        if kept["windows"] != kept["liquid"]["windows"]:
            raise Unfit("its windows are not those of the liquid")

    def take_up(self, checkpoint) -> None:
        """Nothing: there is no gas, and what was kept is put back next."""

    def window(self) -> None:
        """Some steps, to the next row of the history at most."""
        begun = clock.perf_counter()
        if self.at_row:
            self.liquid.new_row()
        self.liquid.begin()
        self.liquid.advance(self.clock.next(self.time), STRIDE)
        self.liquid.close()
        self.limiters.hear(self.liquid.held())
        self.windows += 1
        self.clock.limit = self.liquid.limit
        self.wall["particles"] += clock.perf_counter() - begun

    def row(self) -> dict[str, float]:
        """Columns of history.csv."""
        return {"time_s": self.time} | self.liquid.row() | self.limiters.now

    def meshes(self) -> dict:
        """Particles for the timeline."""
        return {"particles": self.liquid.points()}

    def walls(self):
        """Walls of the tank as a pyvista surface; None where there are none."""
        return self.liquid.walls()

    def summary(self, out) -> dict[str, float]:
        """summary.json, its own part."""
        return {"sub_steps": self.liquid.steps} | self.liquid.summary() | self.limiters.summary()

    def warnings(self) -> list[str]:
        """Notes for the user on how the run went."""
        return self.liquid.warnings()
