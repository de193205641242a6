"""Solid bodies as a run needs them (sdph.methods.method.Method): stepper and ledger."""

from __future__ import annotations

from pathlib import Path

from sdph.engine import state as particles
from sdph.engine.stepped import Stepped
from sdph.methods.solids import history
from sdph.methods.solids.method import SolidStepper
from sdph.methods.solids.totals import SolidLedger


class Solids(Stepped):
    """Bodies and what they do in a window."""

    matter = "solid"
    KEPT = ("windows", "stepper", "ledger")  # see sdph.engine.kept

    def __init__(self, case, ledger: Path, shortest: float, *, wet: bool = False, sides=None):
        self.case, self.windows = case, 0
        self.stepper, self.ledger = SolidStepper(case, shortest, wet=wet, sides=sides), SolidLedger(ledger)

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
        return history.outside(self.stepper)
