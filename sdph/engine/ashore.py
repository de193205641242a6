"""Particles on a device: they go there before the first step, and copies come back for who reads them.

A stepper names in SEEN its arrays of a row a particle, besides the state, that are read between steps; it has `steps`,
`steps_before` (of the parts of the run before this one) and `landed`, None at first. Nothing that comes back is written
to: it is forgotten with the next step.
"""

from __future__ import annotations

import contextlib

from sdph.engine import arrays


@contextlib.contextmanager
def ashore(stepper):
    """Context in which state and SEEN of a stepper lie in memory, and what a checkpoint holds: places at the last build
    of rows too."""
    near = stepper.neighbours
    if arrays.here(stepper.state.x):
        yield
        return
    before, built = {name: getattr(stepper, name) for name in ("state", *stepper.SEEN)}, near.built
    if stepper.landed is None or stepper.landed[0] is not stepper.state or stepper.landed[1] != stepper.steps:
        copies = {name: mapped(arrays.brought, value) for name, value in before.items()}
        stepper.landed = stepper.state, stepper.steps, copies, mapped(arrays.brought, built)
    copies, near.built = stepper.landed[2:]
    _put(stepper, copies)
    try:
        yield
    finally:
        near.built = built
        _put(stepper, before)


def told(stepper) -> dict[str, float]:
    """Columns of the summary of a run on a device."""
    steps = stepper.steps - stepper.steps_before
    return {} if arrays.here(stepper.state.x) else arrays.card.told(steps)


def mapped(function, value):
    """A function of an array, or of those in a tuple."""
    if not isinstance(value, tuple):
        return value if isinstance(value, (int, float)) else function(value)
    parts = [mapped(function, part) for part in value]
    return type(value)(*parts) if hasattr(value, "_fields") else tuple(parts)


def _put(stepper, values: dict) -> None:
    for name, value in values.items():
        setattr(stepper, name, value)
