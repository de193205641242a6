"""Methods: ways to move one kind of matter each, as a run needs them. They stand side by side and know no other."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

from sdph.engine.state import State
from sdph.engine.walls.parts import Pushed


@runtime_checkable
class Method(Protocol):
    """Matter and how it goes forward; a run calls `begin`, `advance` and `close` once a window, in that order.

    matter   name of what it moves, "grains", "liquid" or "solid", and of its fields and columns where several are there
    KEPT     what a checkpoint holds of it (sdph.engine.kept); `admit` refuses what cannot be
    state    its particles; what pushes them from outside over a window is in `push_x` to `push_z` (sdph.engine.state)
    steps, limit   sub-steps so far, and what ruled the last one
    pushed   forces on walls that `run.forces` names (sdph.engine.walls.parts.Pushed); None where none has a name

    Steppers say in HALO what their loops take, fresh, from neighbours (tests/methods/test_halo.py): what a domain must
    tell the next.
    """

    matter: str
    KEPT: tuple[str, ...]
    state: State
    time: float
    steps: int
    limit: str
    pushed: Pushed | None

    def start(self) -> None:
        """Begin: what comes in at once is there, a ledger of its own is open."""

    def begin(self) -> None:
        """Remember the state to go back to, before a window."""

    def advance(self, end: float) -> None:
        """Go to `end` [s], in sub-steps no longer than any effect that is on allows."""

    def close(self) -> None:
        """End the window: what held over it is released, a ledger of its own has its row."""

    def row(self) -> dict[str, float]:
        """Columns of history.csv."""

    def held(self) -> dict[str, float]:
        """Shares that its limiters hold now, by column of history.csv."""

    def points(self):
        """Its particles as pyvista points."""

    def walls(self):
        """Its walls as a pyvista surface; None where there are none to show."""

    def summary(self) -> dict[str, float]:
        """Its part of summary.json, beside that of its ledger."""

    def warnings(self) -> list[str]:
        """Notes for the user on how it went."""


@runtime_checkable
class OwnLedger(Method, Protocol):
    """A method that keeps its own account of mass, momentum and energy: it runs alone, or beside grains, whose account
    is with that of their gas.

    stepper   what moves it; ledger   its account
    """

    stepper: object
    ledger: object

    def tables(self) -> list:
        """Files that grow by rows (sdph.engine.table)."""

    def whole(self):
        """Context in which the first process holds all particles, and no other any; True there."""

    def new_row(self) -> None:
        """Begin means anew that the history has a row of now."""
