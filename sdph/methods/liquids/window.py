"""What a liquid gets from where in one window."""

from __future__ import annotations

import numpy as np

from sdph.methods.liquids.loads import balance
from sdph.methods.liquids.totals import IMPULSES


class Tally:
    """What a liquid got from where in one window; `run` has its stepper, its outlet or None, and what the drain is to
    leave (fill)."""

    def __init__(self, run):
        self.run, self.stepper = run, run.stepper
        self.load = np.zeros(10)  # integral of sdph.methods.liquids.loads.balance [N s, N m s, J]
        self.shifted = self.stepper.shifted
        self.gone = run.outlet.gone.copy() if run.outlet else np.zeros(8)
        self.tension = 0.0  # work of surface tension [J]
        self.before = balance(self.stepper)

    def step(self, end: float) -> None:
        """One step, to `end` [s] at most."""
        left, tightening = end - self.stepper.time, self.stepper.tightening
        dt = self.stepper.step(left)
        if dt >= left:
            self.stepper.time = end
        now = balance(self.stepper)
        self.load += 0.5 * dt * (self.before + now)
        self.tension += 0.5 * dt * (tightening + self.stepper.tightening)
        self.before = self._drain(now)

    def _drain(self, now):
        """What the drain is commanded to take; the balance after it."""
        if not self.run.outlet:
            return now
        self.run.outlet.command(self.run.fill(self.stepper.time))
        return balance(self.stepper)

    def amounts(self) -> tuple[dict, dict]:
        """Impulses and amounts for the ledger."""
        gone = (self.run.outlet.gone if self.run.outlet else np.zeros(8)) - self.gone
        given = (self.load[6:9], -self.load[:3], self.stepper.shifted - self.shifted, -gone[1:4])
        works = {"work_of_body_forces_J": float(self.load[9]), "work_of_surface_tension_J": self.tension}
        return dict(zip(IMPULSES, given)), {"drained_kg": float(gone[0]), "drained_J": float(gone[7])} | works
