"""Solid bodies in a liquid: the liquid takes them along in its steps and presses on them.

The liquid knows them as in sdph.methods.liquids.bodies. Both go in the same steps, the shortest that either bears.
"""

from __future__ import annotations

import math

import numpy as np

from sdph.effects.solids import rigid_sides
from sdph.engine import state as particles
from sdph.engine.contact import between
from sdph.engine.kept import Unfit
from sdph.methods.liquids.bodies import Shell
from sdph.methods.solids import start
from sdph.methods.solids.method import IMPULSES, WORKS
from sdph.methods.solids.method import limits as limits_of_solids
from sdph.methods.solids.solid import Solids

LEFT = 3  # corners of a polygon


class Wetted:
    """Solids as the liquid around carries them (Carrier)."""

    KEPT = ("solids", "force")  # see sdph.engine.kept

    def __init__(self, case, ledger, shortest: float):
        self.solids = Solids(case.only("solid"), ledger, shortest, wet=True, sides=rigid_sides.beside(case))
        self.volume, self.density = self.stepper.weights.volume, case.solid.density
        self.mass = self.stepper.state.mass
        self.force = self.stepper.load
        self.shell = _shell(case, self.stepper.state.ident)
        self.flaw_at = max((body.flaw_at for body in case.bodies.values() if body.flaw), default=0.0)  # [rad]
        self.contact = between(case)  # a liquid is to the body's particles such a spring

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

    def lining(self) -> tuple[np.ndarray, float]:
        own = self.stepper
        held = _held(self.shell.inner, own.free)
        F = own.gradient[held]
        return self.places()[held, :2], float(self.volume[held] @ (F[:, 0] * F[:, 4] - F[:, 1] * F[:, 3]))

    def hull(self) -> np.ndarray:
        """Corners (N, 2) [m] of the shell's outermost circle that have not broken off."""
        return self.places()[_held(self.shell.outer, self.stepper.free), :2]

    def angle_of_loose(self) -> float:
        """Angle [deg] of what has broken off, seen from the middle of the shell and from its flaw."""
        middle, broken = self.places()[:, :2].mean(axis=0), self.places()[self.loose(), :2]
        x, y = (broken - middle).mean(axis=0)
        turn = math.degrees(math.atan2(y, x) - self.flaw_at)
        return (turn + 180.0) % 360.0 - 180.0

    def links(self) -> np.ndarray:
        """Points (N, 2) [m] along the links of the shell's innermost circle, a quarter of them apart."""
        own, here = self.shell.links, self.places()[:, :2]
        first, second = (here[ends] for ends in own[~self.loose()[own].any(axis=1)].T)
        return np.concatenate([first + share * (second - first) for share in (0.25, 0.5, 0.75)])

    @property
    def torn(self) -> bool:
        """Tell whether a particle of the bodies has broken off."""
        return bool(self.stepper.free.any())

    def loose(self) -> np.ndarray:
        return self.stepper.free != 0

    def hasten(self, pace: float, kick: float) -> None:
        """Let `pace` seconds pass for what goes by time in each second of motion; velocities become `kick` times as
        large."""
        self.stepper.hasten(pace, kick)

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
        """Make anew what a checkpoint does not hold, once it was put back."""
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


def _shell(case, ident) -> Shell | None:
    """The ring of a case with one."""
    names = [name for name, body in case.bodies.items() if body.shape == "ring"]
    if len(names) != 1:
        return None
    place = np.argsort(ident)
    inner, outer = (place[circle] for circle in start.circles(case, names[0]))
    return Shell(inner, outer, case.bodies[names[0]].radius)


def _held(circle, free) -> np.ndarray:
    """Particles of a circle that have not broken off; all where fewer than three are left."""
    held = circle[free[circle] == 0]
    return held if len(held) >= LEFT else circle
