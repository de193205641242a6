"""Particles of grains go on a device before their first window.

On the device are state, rows, walls and what loops leave to each other; cells alone are told to the gas and by it.
"""

from __future__ import annotations

from sdph.engine import arrays


def board(stepper) -> None:
    """Have the particles on the device from now on, if the case names one, with rows of the places that theirs were
    made at."""
    if stepper.case.run.device == "cpu" or not arrays.here(stepper.state.x):
        return
    from sdph.engine.gpu import card  # what it takes costs a run of the processor 0.4 s

    there, near = card.begun(), stepper.neighbours
    stepper.state = stepper.state._make(map(there.send, stepper.state))
    if stepper.boundary:
        own = stepper.boundary.dummies
        stepper.boundary.dummies = type(own)(*map(there.send, own))
    near.built = tuple(map(there.send, near.built))
    if near.built:
        stepper.look_anew()
