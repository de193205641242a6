"""Methods that stand beside the grains of a run: they go through the same windows and touch the grains."""

from __future__ import annotations

import numpy as np

from sdph.engine import arrays
from sdph.engine import state as particles
from sdph.engine.contact import Contact
from sdph.engine.kept import Unfit
from sdph.engine.state import GRAIN
from sdph.methods.method import Method


class Beside:
    """Other methods by their matter, and their contact with the grains; the gas feels nothing of them."""

    KEPT = ("methods",)  # see sdph.engine.kept

    def __init__(self):
        self.methods: dict[str, Method] = {}
        self.contacts: dict[str, Contact] = {}

    def add(self, method: Method, contact: Contact) -> None:
        """Let another method go through the same windows."""
        self.methods[method.matter], self.contacts[method.matter] = method, contact

    def refuse_other_times(self, kept: dict, time: float) -> None:
        """Unfit where a method was kept at another time [s]."""
        if any(own["stepper"]["time"] != time for own in kept["methods"].values()):
            raise Unfit("its time is not that of the ledger")

    def start(self) -> None:
        """Open the ledgers."""
        for method in self.methods.values():
            method.start()

    def advance(self, end: float) -> None:
        """All of them to `end` [s]; the history has a row of every window."""
        for method in self.methods.values():
            method.begin()
            method.new_row()
            method.advance(end)
            method.close()

    def touch(self, grains, dt: float) -> np.ndarray:
        """Impulses (N, 3) [kg m/s] of contact on the grains in a window of `dt` [s]; the others get the opposite."""
        impulse = arrays.zeros((len(grains.x), 3), grains.x)
        if not self.methods:
            return impulse
        here, inside = particles.positions(grains), grains.kind == GRAIN
        for matter, method in self.methods.items():
            wet, there = particles.wet(method.state), particles.positions(method.state)
            own, other = self.contacts[matter].forces(here[inside], there[wet])
            impulse[inside] += dt * own
            push = np.zeros((len(there), 3))
            push[wet] = other / method.state.mass[wet, None]
            method.push(push)
        return impulse

    def limit(self, grains) -> float:
        """Longest window [s] that contacts bear which there are or may come; inf where nothing is near."""
        if not self.methods:
            return np.inf
        inside, longest = grains.kind == GRAIN, np.inf
        here = particles.positions(grains)[inside]
        for matter, method in self.methods.items():
            wet, contact = particles.wet(method.state), self.contacts[matter]
            if contact.near(here, particles.positions(method.state)[wet]):
                longest = min(longest, contact.limit(min(grains.mass[inside].min(), method.state.mass[wet].min())))
        return longest

    def named(self, told) -> dict:
        """Values that each method tells, (method) -> name -> value, under names that begin with its matter."""
        found = {matter: told(method) for matter, method in self.methods.items()}
        return {
            f"{matter}_{key.removeprefix(f'{matter}_')}": value
            for matter, own in found.items()
            for key, value in own.items()
        }

    def points(self) -> dict:
        """Particles as pyvista points, by matter."""
        return {matter: method.points() for matter, method in self.methods.items()}

    def walls(self) -> list:
        """Walls that there are to show."""
        return [walls for method in self.methods.values() if (walls := method.walls()) is not None]

    def warnings(self) -> list[str]:
        """Notes of the methods on how they went, and that the gas does not feel them."""
        told = [f"the gas does not feel the {matter} beside the grains: it flows through" for matter in self.methods]
        return told + [text for method in self.methods.values() for text in method.warnings()]
