"""Particles of a method that several processes share: all of them at the chief for a while, and parts again.

A stepper has `state`, `neighbours`, `domain`, and names in ROWS its arrays, or tuples of them, of a row a particle that
are kept beside the state.
"""

from __future__ import annotations

import contextlib

import numpy as np

from sdph.engine import state as particles
from sdph.engine.state import WALL


@contextlib.contextmanager
def whole(stepper):
    """Hold the particles of all processes at the chief, as one process alone has them, for outputs and checkpoints;
    True there, and none elsewhere."""
    if stepper.domain.alone:
        yield True
        return
    before = stepper.state, stepper.neighbours.built, _rows(stepper)
    built = stepper.neighbours.built
    found = stepper.domain.gather(stepper.state, [*built, *before[2]])
    if found:
        (state, arrays), d = found, len(built)
        order = stepper.neighbours.by_cell(tuple(arrays[:d]), state.kind == WALL)
        arrays = [own[order] if len(own) else own for own in arrays]
        stepper.state, stepper.neighbours.built = particles.take(state, order), tuple(arrays[:d])
        _put(stepper, arrays[d:])
    else:
        stepper.state = particles.first(stepper.state, 0)
    try:
        yield bool(found)
    finally:
        stepper.state, stepper.neighbours.built, arrays = before
        _put(stepper, arrays)


def take_part(stepper, allocate=lambda: None) -> None:
    """Keep the own ones of all particles, which each process has just read, and copies, with rows of the places that
    theirs were made at; `allocate()` makes room."""
    number, arrays, here = stepper.state.ident, _rows(stepper), stepper.domain.axes(stepper.state)
    at = dict(zip("xyz", stepper.neighbours.built))
    stepper.neighbours.built, stepper.domain.tree, stepper.domain.parted = (), None, False
    stepper.state, stepper.rows = stepper.neighbours.update(stepper.state._replace(**at))
    sorter = np.argsort(number)
    chosen = sorter[np.searchsorted(number, stepper.state.ident, sorter=sorter)]
    for axis, now in zip(stepper.domain.axes(stepper.state), here if at else ()):
        axis[:] = now[chosen]
    allocate()
    _put(stepper, [own[chosen] if len(own) else own for own in arrays])


def _rows(stepper) -> list[np.ndarray]:
    """The arrays that ROWS of a stepper names."""
    named = (getattr(stepper, name) for name in stepper.ROWS)
    return [array for row in named for array in (row if isinstance(row, tuple) else (row,))]


def _put(stepper, arrays: list[np.ndarray]) -> None:
    """Put arrays in the place of those."""
    rest = iter(arrays)
    for name in stepper.ROWS:
        own = getattr(stepper, name)
        setattr(stepper, name, tuple(next(rest) for _ in own) if isinstance(own, tuple) else next(rest))
