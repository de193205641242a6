"""Rows of liquids against all pairs: liquid meets liquid and wall, a wall liquid alone."""

import numpy as np
import pytest

from sdph.engine import state as particles
from sdph.engine.neighbours import Neighbours
from sdph.engine.rows import LANES
from sdph.engine.state import LIQUID, WALL

REACH, SKIN = 0.12, 0.1


def cloud(dimensions, count=400):
    """Liquid and wall particles at random in a unit box, as many of each."""
    random = np.random.default_rng(3)
    state = particles.empty(count, (), dimensions)
    for axis in particles.axes(state):
        axis[:] = random.random(count)
    state.kind[:] = np.where(random.random(count) < 0.5, WALL, LIQUID)
    state.ident[:] = np.arange(count)
    return state


def expected(state, period):
    """Pairs (ident, ident of the neighbour) within reach and skin."""
    d = particles.positions(state)[:, None] - particles.positions(state)
    for axis, length in enumerate(period):
        if length:
            d[..., axis] -= length * np.rint(d[..., axis] / length)
    near = ((d**2).sum(axis=2) < (REACH * (1.0 + SKIN)) ** 2) & ~np.eye(len(state.x), dtype=bool)
    near &= ((state.kind != WALL)[:, None]) | (state.kind != WALL)
    return {(state.ident[i], state.ident[j]) for i, j in np.argwhere(near)}


@pytest.mark.parametrize("dimensions", [2, 3])
@pytest.mark.parametrize("periodic", [False, True])
def test_rows_hold_all_that_is_needed_and_nothing_else(dimensions, periodic):
    period = (1.0 * periodic, 0.0, 0.0)[:dimensions]
    own = Neighbours(REACH, period, SKIN)
    state, rows = own.update(cloud(dimensions))
    found = []
    for i in range(len(state.x)):
        row = rows.entries[rows.start[i] : rows.start[i + 1]]
        assert len(row) % LANES == 0 and len(row) > rows.number[i] and (row[rows.number[i] :] == i).all()
        found += [(state.ident[i], state.ident[j]) for j in row[: rows.number[i]]]
    assert len(found) == len(set(found)) and set(found) == expected(state, period)
    again = own.relist(state.kind)
    assert np.array_equal(again.number, rows.number) and np.array_equal(again.start, rows.start)


def test_rows_hold_until_something_has_moved_half_the_skin():
    own = Neighbours(REACH, (0.0, 0.0), SKIN)
    state, rows = own.update(cloud(2))
    state.x[7] += 0.49 * SKIN * REACH
    assert own.update(state)[1] is rows
    state.x[7] += 0.02 * SKIN * REACH
    state, rows = own.update(state)
    assert {
        (state.ident[i], state.ident[j]) for i in range(400) for j in rows.entries[rows.start[i] :][: rows.number[i]]
    } == expected(state, (0.0, 0.0))
