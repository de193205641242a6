"""Solid bodies as a run needs them (sdph.methods.method.Method): stepper and ledger."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from sdph.engine import state as particles
from sdph.engine.kept import Unfit
from sdph.methods.solids import history
from sdph.methods.solids.method import SolidStepper
from sdph.methods.solids.totals import SolidLedger


class Solids:
    """Bodies and what they do in a window."""

    matter = "solid"
    KEPT = ("windows", "stepper", "ledger")  # see sdph.engine.kept

    def __init__(self, case, ledger: Path, shortest: float, *, wet: bool = False):
        self.case, self.windows = case, 0
        self.stepper, self.ledger = SolidStepper(case, shortest, wet=wet), SolidLedger(ledger)

    @property
    def state(self):
        return self.stepper.state

    @property
    def time(self) -> float:
        return self.stepper.time

    @property
    def steps(self) -> int:
        return self.stepper.steps

    @property
    def limit(self) -> str:
        return self.stepper.limit

    def tables(self) -> list:
        """Files that grow by rows."""
        return [self.ledger.table]

    def start(self) -> None:
        self.ledger.open(self.stepper)

    def admit(self, kept: dict) -> None:
        """Unfit where time is not that of the ledger."""
        if kept["stepper"]["time"] != kept["ledger"]["last"]["time_s"]:
            raise Unfit("its time is not that of the ledger")

    def begin(self) -> None:
        self.stepper.guard.begin(self)
        self.begun = self.time

    def advance(self, end: float, most: float = np.inf) -> None:
        """Go to `end` [s], or as far as `most` steps get."""
        done = 0
        while self.time != end and done < most:
            left = end - self.time
            if self.stepper.step(left) >= left:
                self.stepper.time = end
            done += 1
        self.windows += 1

    def close(self) -> None:
        self.stepper.guard.look(self.stepper)
        self.ledger.close_window(self.stepper, self.time - self.begun)

    def new_row(self) -> None:
        """Nothing: no column is a mean since the last row."""

    def row(self) -> dict[str, float]:
        return history.row(self.stepper)

    def held(self) -> dict[str, float]:
        """Nothing: no limiter holds a solid."""
        return {}

    def points(self):
        import pyvista

        cloud = pyvista.PolyData(particles.positions(self.state))
        cloud["velocity"] = particles.velocities(self.state)
        for name, values in history.fields(self.stepper).items():
            cloud[name] = values
        for name in ("ident", "kind", "mass"):
            cloud[name] = getattr(self.state, name)
        return cloud

    def walls(self):
        return None

    def summary(self) -> dict[str, float]:
        return history.summary(self.stepper)

    def warnings(self) -> list[str]:
        return []
