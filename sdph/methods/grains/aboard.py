"""Particles of grains on a device: they are there for the sub-steps of a window, and in memory between windows.

Rows, walls, and what loops leave to each other stay there. An array that nobody has written to goes neither way.
"""

from __future__ import annotations

import contextlib
from typing import NamedTuple

from sdph.engine import arrays
from sdph.engine.state import State

WRITTEN = ("received", "exchanged")  # of the state, in place, between windows
# by sub-steps; all of it where rows were made anew
CHANGED = (
    *"xyzuvw", "density", "theta", "temperature", "contact_xx", "contact_yy", "contact_xy", "contact_yz", "contact_zx",
    "damped", "way_x", "way_y", "way_z",
)  # fmt: skip


class Twin(NamedTuple):
    """State and places of the last build of rows, in memory and there, as they were when they last came ashore."""

    state: State
    built: tuple
    there: State
    built_there: tuple


@contextlib.contextmanager
def aboard(stepper, change: bool = True):
    """Context in which the particles of a stepper are on the device that its case names, if any; without `change`
    nothing is written there."""
    if stepper.case.run.device == "cpu" or not arrays.here(stepper.state.x):
        yield
        return
    before = stepper.state, stepper.neighbours.built
    _board(stepper)
    try:
        yield
    finally:
        if change:
            _land(stepper, *before)
        else:
            stepper.state, stepper.neighbours.built = before


def _board(stepper) -> None:
    from sdph.engine.gpu import card  # what it takes costs a run of the processor 0.4 s

    there, near, last = card.begun(), stepper.neighbours, stepper.twin
    known = last.state._asdict() if last else {}
    own = {
        name: getattr(last.there, name) if array is known.get(name) and name not in WRITTEN else there.send(array)
        for name, array in stepper.state._asdict().items()
    }
    stepper.state, built = State(**own), near.built
    if last and built is last.built:
        near.built = last.built_there
        return
    near.built = tuple(map(there.send, built))
    if stepper.boundary and arrays.here(stepper.boundary.dummies.x):
        dummies = stepper.boundary.dummies
        stepper.boundary.dummies = type(dummies)(*map(there.send, dummies))
    if built:
        stepper.look_anew()


def _land(stepper, state, built) -> None:
    """Bring the particles back; `state` and `built` are those that went there."""
    near, last = stepper.neighbours, stepper.twin
    there, built_there = stepper.state, near.built
    same = last is not None and built_there is last.built_there
    kept = {name: array for name, array in state._asdict().items() if same and name not in CHANGED}
    own = {name: arrays.brought(array) for name, array in there._asdict().items() if name not in kept}
    stepper.state = State(**kept, **own)
    near.built = built if same else tuple(map(arrays.brought, built_there))
    stepper.twin = Twin(stepper.state, near.built, there, built_there)


class Landed:
    """What somebody reads of a stepper, or of a tuple of arrays, whose arrays come ashore when they are asked for;
    `aboard` is the stepper itself."""

    def __init__(self, own):
        self.aboard = own

    def __getattr__(self, name: str):
        own = getattr(self.aboard, name)
        found = Landed(own) if hasattr(own, "_fields") else arrays.brought(own) if hasattr(own, "dtype") else own
        setattr(self, name, found)
        return found


def landed(stepper):
    """The stepper, its arrays in memory for who reads them."""
    return stepper if arrays.here(stepper.state.x) else Landed(stepper)


def told(stepper) -> dict[str, float]:
    """Columns of the summary of a run on a device."""
    return arrays.card.told(stepper.steps - stepper.steps_before) if stepper.twin else {}
