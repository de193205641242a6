"""Particles of a liquid on a device: they go there before the first step, and copies come back for who reads them.

On the device are state, rows, lists of particles and what loops leave to each other. Nothing that comes back is
written to: it is forgotten with the next step.
"""

from __future__ import annotations

import contextlib

from sdph.engine import arrays
from sdph.engine import state as particles

READ = ("state", "active", "walls", "enclosed")  # of a stepper, what somebody reads between steps besides ROWS


def board(stepper) -> None:
    """Have the particles on the device from now on, with rows of the places that theirs were made at."""
    from sdph.engine.gpu import card  # what it takes costs a run of the processor 0.4 s

    there = card.begun()
    for name in ("state", "enclosed", *stepper.ROWS):
        setattr(stepper, name, _mapped(there.send, getattr(stepper, name)))
    stepper.neighbours.built = _mapped(there.send, stepper.neighbours.built)
    stepper.rows = stepper.neighbours.relist(stepper.state.kind)
    stepper.tell_apart()


@contextlib.contextmanager
def ashore(stepper):
    """Context in which state and ROWS of a stepper lie in memory."""
    if arrays.here(stepper.state.x):
        yield
        return
    before = {name: getattr(stepper, name) for name in (*READ, *stepper.ROWS)}
    now = stepper.steps, stepper.time
    if stepper.landed is None or stepper.landed[0] != now:
        stepper.landed = now, {}
    copies = stepper.landed[1]
    for name in before.keys() - copies.keys():
        copies[name] = _mapped(arrays.brought, before[name])
    _put(stepper, {name: copies[name] for name in before})
    try:
        yield
    finally:
        _put(stepper, before)


@contextlib.contextmanager
def all_ashore(stepper):
    """Context in which what a checkpoint holds lies in memory: places at the last build of rows too."""
    near, built = stepper.neighbours, stepper.neighbours.built
    with ashore(stepper):
        near.built = _mapped(arrays.brought, built)
        try:
            yield
        finally:
            near.built = built


def told(stepper) -> dict[str, float]:
    """Columns of the summary of a run on a device."""
    steps = stepper.steps - stepper.steps_before
    return {} if arrays.here(stepper.state.x) else arrays.card.told(steps)


def _put(stepper, values: dict) -> None:
    for name, value in values.items():
        setattr(stepper, name, value)


def _mapped(function, value):
    """Array, or tuple of arrays, of a function of each."""
    if not isinstance(value, tuple):
        return function(value)
    parts = [function(part) for part in value]
    return type(value)(*parts) if isinstance(value, particles.State) or hasattr(value, "_fields") else tuple(parts)
