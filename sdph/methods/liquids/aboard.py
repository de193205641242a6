"""Particles of a liquid go on a device before their first step.

On the device are state, rows, lists of particles and what loops leave to each other.
"""

from __future__ import annotations

from sdph.engine.ashore import mapped


def board(stepper) -> None:
    """Have the particles on the device from now on, with rows of the places that theirs were made at."""
    from sdph.engine.gpu import card  # what it takes costs a run of the processor 0.4 s

    there = card.begun()
    for name in ("state", "enclosed", *stepper.ROWS):
        setattr(stepper, name, mapped(there.send, getattr(stepper, name)))
    stepper.neighbours.built = mapped(there.send, stepper.neighbours.built)
    stepper.rows = stepper.neighbours.relist(stepper.state.kind)
    stepper.tell_apart()
