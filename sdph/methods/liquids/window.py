"""Account of a window of a liquid: what it gets from where."""

from __future__ import annotations

import numpy as np

from sdph.engine import state as particles
from sdph.methods.liquids.loads import balance
from sdph.methods.liquids.totals import IMPULSES


class Tally:
    """Account of one window; `run` has its stepper, its outlet or None, and what the drain is to
    leave (fill)."""

    def __init__(self, run):
        self.run, self.stepper = run, run.stepper
        self.load = np.zeros(10)  # integral of sdph.methods.liquids.loads.balance [N s, N m s, J]
        self.shifted = self.stepper.shifted
        self.gone = run.outlet.gone.copy() if run.outlet else np.zeros(8)
        self.tension = self.pressed = 0.0  # work of surface tension and of contact [J]
        self.contact = np.zeros(3)  # impulse of contact [N s]
        self.before = balance(self.stepper)

    def step(self, end: float) -> None:
        """One step, to `end` [s] at most."""
        left, tightening, before = end - self.stepper.time, self.stepper.tightening, pushed(self.stepper.state)
        dt = self.stepper.step(left)
        if dt >= left:
            self.stepper.time = end
        now = balance(self.stepper)
        self.load += 0.5 * dt * (self.before + now)
        self.tension += 0.5 * dt * (tightening + self.stepper.tightening)
        after = pushed(self.stepper.state)
        self.contact += dt * after[:3]
        self.pressed += 0.5 * dt * (before[3] + after[3])
        self.before = self._drain(now)

    def _drain(self, now):
        """Command what the drain has to take, and take the balance after it."""
        if not self.run.outlet:
            return now
        self.run.outlet.command(self.run.fill(self.stepper.time))
        return balance(self.stepper)

    def amounts(self) -> tuple[dict, dict]:
        """Impulses and amounts for the ledger."""
        gone = (self.run.outlet.gone if self.run.outlet else np.zeros(8)) - self.gone
        given = (self.load[6:9], -self.load[:3], self.stepper.shifted - self.shifted, -gone[1:4], self.contact)
        works = {"work_of_body_forces_J": float(self.load[9]), "work_of_surface_tension_J": self.tension}
        works["work_of_contact_J"] = self.pressed
        return dict(zip(IMPULSES, given)), {"drained_kg": float(gone[0]), "drained_J": float(gone[7])} | works


def pushed(state) -> np.ndarray:
    """(4,) force [N] and power [W] of what pushes the liquid from outside; nothing where nothing does."""
    if not len(state.push_x):
        return np.zeros(4)
    force = np.stack([state.mass * push for push in particles.pushes(state)], axis=1)
    velocity = particles.velocities(state)[:, : force.shape[1]]
    sums = np.zeros(4)
    sums[: force.shape[1]], sums[3] = force.sum(axis=0), float((force * velocity).sum())
    return sums
