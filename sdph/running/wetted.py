"""Solid bodies in a liquid: the liquid takes them along in its steps and presses on them.

The liquid knows them as in sdph.methods.liquids.bodies. Both go in the same steps, the shortest that either bears.
"""

from __future__ import annotations

import numpy as np

from sdph.engine import state as particles
from sdph.engine.contact import Contact
from sdph.engine.kept import Unfit
from sdph.methods.solids.method import IMPULSES, WORKS
from sdph.methods.solids.method import limits as limits_of_solids
from sdph.methods.solids.solid import Solids


class Wetted:
    """Solids as the liquid around carries them (Carrier)."""

    KEPT = ("solids", "force")  # see sdph.engine.kept

    def __init__(self, case, ledger, shortest: float):
        self.solids = Solids(case.only("solid"), ledger, shortest, wet=True)
        self.volume = self.stepper.weights.volume
        self.force = self.stepper.load
        # a liquid is to the body's particles a spring as stiff as those of sdph.engine.contact
        spacing, own = case.resolution.spacing, case.liquid
        self.contact = Contact(spacing, own.density * own.sound_speed**2 * spacing ** (case.dimensions - 2))

    @property
    def stepper(self):
        return self.solids.stepper

    @property
    def given(self) -> np.ndarray:
        own = self.stepper
        return np.append(own.impulses[IMPULSES.index("liquid")], own.works[WORKS.index("pressure")])

    def places(self) -> np.ndarray:
        return particles.positions(self.stepper.state)

    def velocities(self) -> np.ndarray:
        return particles.velocities(self.stepper.state)

    def limits(self) -> dict[str, float]:
        own = limits_of_solids(self.stepper) | {"liquid": self.contact.limit(float(self.stepper.state.mass.min()))}
        return {f"solid {cause}": limit for cause, limit in own.items()}

    def set_off(self, dt: float) -> None:
        self.stepper.set_off(dt)

    def meet(self, force) -> None:
        self.force[:] = force
        self.stepper.forces(1.0)  # nothing flows at rest: the length of a step decides nothing

    def arrive(self, dt: float, force) -> None:
        self.force[:] = force
        self.stepper.arrive(dt)

    def revive(self) -> None:
        """After a checkpoint was put back."""
        self.stepper.load = self.force

    def begin(self) -> None:
        """Remember the state to go back to, before a window."""
        self.solids.begin()

    def close(self, time: float, limit: str) -> None:
        """End a window, at the liquid's `time` [s]; what ruled its steps."""
        self.stepper.time, self.stepper.limit = time, limit
        self.solids.windows += 1
        self.solids.close()

    def admit(self, kept: dict) -> None:
        """Unfit where forces are not one row a particle."""
        if len(kept["force"]) != len(kept["solids"]["stepper"]["state"]["x"]):
            raise Unfit("forces of the liquid are of other bodies")
