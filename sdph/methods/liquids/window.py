"""Account of a window of a liquid: what it gets from where, and where its energy goes."""

from __future__ import annotations

import numpy as np

from sdph.engine import state as particles
from sdph.methods.liquids import account
from sdph.methods.liquids.losses import CAUSES
from sdph.methods.liquids.totals import IMPULSES


class Tally:
    """Account of one window; `run` has its stepper, its outlet or None, what the drain is to leave (fill), and what
    acts now (rates)."""

    def __init__(self, run):
        self.run, self.stepper = run, run.stepper
        self.stepper.look, self.now = self._look, run.rates
        self.sums = np.zeros_like(run.rates)  # integral of sdph.methods.liquids.account.rates [N s, N m s, J]
        self.shifted, self.eased = self.stepper.shifted, self.stepper.eased
        self.gone = run.outlet.gone.copy() if run.outlet else np.zeros(8)
        self.passed, self.given = _passed(self.stepper), _given(self.stepper)
        self.boiled = _boiled(self.stepper)
        self.scaled = run.scaled  # impulse [N s] and work [J] of a change of the pace before this window
        self.pressed = 0.0  # work of contact [J]
        self.contact, self.spared = np.zeros(3), np.zeros(3)  # impulses of contact, and on what the drain took [N s]

    def step(self, end: float) -> None:
        """One step, to `end` [s] at most."""
        run, left, before = self.run, end - self.stepper.time, pushed(self.stepper.state)
        dt = self.stepper.step(left)
        if dt >= left:
            self.stepper.time = end
        self.sums += account.between(run.rates, self.now, dt)
        after = pushed(self.stepper.state)
        self.contact += dt * after[:3]
        self.pressed += 0.5 * dt * (before[3] + after[3])
        if run.outlet:
            self.spared += 0.5 * dt * run.outlet.pushed
            run.outlet.command(run.fill(self.stepper.time))
        run.rates = self.now

    def _look(self, ahead: float) -> None:
        self.now = account.rates(self.stepper, ahead, self.now)

    def amounts(self) -> tuple[dict, dict]:
        """Impulses and amounts for the ledger."""
        gone = (self.run.outlet.gone if self.run.outlet else np.zeros(8)) - self.gone
        came, left = _passed(self.stepper) - self.passed
        given, boiled = _given(self.stepper) - self.given, _boiled(self.stepper) - self.boiled
        shifted, sums = self.stepper.shifted - self.shifted, self.sums
        impulses = (
            sums[account.BODY], sums[account.WALLS], sums[account.TENSION], shifted, -gone[1:4] - self.spared,
            self.contact + given[:3], sums[account.INLET] + came[1:4], -left[1:4],
            sums[account.BUBBLE] - boiled[1:4], self.scaled[:3], sums[account.CONTROL],
        )  # fmt: skip
        amounts = {"drained_kg": gone[0], "drained_J": gone[7], "work_of_contact_J": self.pressed + given[3]}
        amounts |= {"boiled_kg": boiled[0], "boiled_J": boiled[4]}
        amounts |= {"injected_kg": came[0], "injected_J": came[4], "left_kg": left[0], "left_J": left[4]}
        amounts |= {"work_of_inflow_J": sums[account.BY_INLET], "work_of_bubble_J": sums[account.BY_BUBBLE]}
        amounts |= {"work_of_scaling_J": self.scaled[3]}
        amounts |= {"work_of_gravity_J": sums[account.GRAVITY], "work_of_frame_J": sums[account.FRAME]}
        amounts |= {"work_of_walls_J": sums[account.BY_WALLS], "work_of_surface_tension_J": sums[account.BY_TENSION]}
        amounts["held_off_J"] = -sums[account.HELD_OFF]
        amounts |= dict(zip(("shifting_J", "shifting_lift_J"), self.stepper.eased - self.eased))
        amounts |= {"tension_control_J": sums[account.BY_CONTROL]} | dict(zip(CAUSES, sums[account.LOST]))
        return dict(zip(IMPULSES, impulses)), {name: float(value) for name, value in amounts.items()}


def _passed(stepper) -> np.ndarray:
    """(2, 5) of what came in through nozzles and left through open sides (sdph.methods.liquids.openings)."""
    return stepper.openings.passed.copy() if stepper.openings else np.zeros((2, 5))


def _boiled(stepper) -> np.ndarray:
    """(5,) of what boiled off into a bubble (sdph.methods.liquids.bubbles)."""
    return stepper.void.passed.copy() if stepper.void else np.zeros(5)


def _given(stepper) -> np.ndarray:
    """(4,) impulse [N s] and work [J] that bodies have given the liquid (sdph.methods.liquids.bodies)."""
    return -stepper.bodies.carrier.given if stepper.bodies else np.zeros(4)


def pushed(state) -> np.ndarray:
    """(4,) force [N] and power [W] of what pushes the liquid from outside; nothing where nothing does."""
    if not len(state.push_x):
        return np.zeros(4)
    force = np.stack([state.mass * push for push in particles.pushes(state)], axis=1)
    velocity = particles.velocities(state)[:, : force.shape[1]]
    sums = np.zeros(4)
    sums[: force.shape[1]], sums[3] = force.sum(axis=0), float((force * velocity).sum())
    return sums
