"""Particles of grains on a device: they go there before the first window, and copies come back for who reads them.

On the device are state, rows, walls and what loops leave to each other; cells alone are told to the gas and by it.
Nothing that comes back is written to: it is forgotten with the next sub-step.
"""

from __future__ import annotations

import contextlib

from sdph.engine import arrays
from sdph.engine.state import State


def board(stepper) -> None:
    """Have the particles on the device from now on, if the case names one, with rows of the places that theirs were
    made at."""
    if stepper.case.run.device == "cpu" or not arrays.here(stepper.state.x):
        return
    from sdph.engine.gpu import card  # what it takes costs a run of the processor 0.4 s

    there, near = card.begun(), stepper.neighbours
    stepper.state = State(*map(there.send, stepper.state))
    if stepper.boundary:
        own = stepper.boundary.dummies
        stepper.boundary.dummies = type(own)(*map(there.send, own))
    near.built = tuple(map(there.send, near.built))
    if near.built:
        stepper.look_anew()


@contextlib.contextmanager
def ashore(stepper):
    """Context in which state, and places at the last build of rows, lie in memory."""
    near, state, built = stepper.neighbours, stepper.state, stepper.neighbours.built
    if arrays.here(state.x):
        yield
        return
    if stepper.landed is None or stepper.landed[0] is not state or stepper.landed[1] != stepper.steps:
        stepper.landed = state, stepper.steps, State(*map(arrays.brought, state)), tuple(map(arrays.brought, built))
    stepper.state, near.built = stepper.landed[2:]
    try:
        yield
    finally:
        stepper.state, near.built = state, built


def told(stepper) -> dict[str, float]:
    """Columns of the summary of a run on a device."""
    steps = stepper.steps - stepper.steps_before
    return {} if arrays.here(stepper.state.x) else arrays.card.told(steps)
