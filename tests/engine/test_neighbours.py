"""The neighbour rows against all pairs, and that every array stays with its particle when they are reordered."""

import numpy as np
import pytest
from builders import cloud
from hypothesis import given
from hypothesis import strategies as st

from sdph.engine import state as particles
from sdph.engine.geometry import box_of, nearest_image
from sdph.engine.neighbours import SKIN, Neighbours
from sdph.engine.rows import LANES, length

REACH = 0.2


def all_pairs(state, reach, period=(0.0, 0.0, 0.0)):
    """Pairs of ident nearer than `reach`, through periodic boundaries, and those so near it that either is right."""
    here = np.stack(particles.axes(state), axis=1)
    apart = here[:, None, :] - here[None, :, :]
    for a, wide in enumerate(period[: here.shape[1]]):
        if wide:
            apart[..., a] -= wide * np.rint(apart[..., a] / wide)
    distance = np.sqrt((apart**2).sum(axis=-1))
    pairs = {(a, b) for a, b in state.ident[np.argwhere(distance < reach)].tolist() if a != b}
    edge = {(a, b) for a, b in state.ident[np.argwhere(abs(distance - reach) < 1e-12)].tolist()}
    return pairs, edge


def listed(state, rows):
    """Pairs of ident in the rows; every neighbour stands there once."""
    pairs = [
        (state.ident[i], state.ident[j])
        for i in range(len(state.x))
        for j in rows.entries[rows.start[i] :][: rows.number[i]]
    ]
    assert len(pairs) == len(set(pairs))
    return set(pairs)


def assert_right(state, rows, period=(0.0, 0.0, 0.0)):
    """All within the reach are there, and none beyond the reach and its skin as it was when the rows were built."""
    pairs, edge = all_pairs(state, REACH, period)
    found = listed(state, rows)
    assert pairs - edge <= found
    wide, rim = all_pairs(state, REACH * (1.0 + 2.0 * SKIN), period)
    assert found <= wide | rim


clouds = st.integers(0, 2**32 - 1).map(np.random.default_rng)


@given(rng=clouds, count=st.integers(0, 150), dimensions=st.sampled_from([2, 3]))
def test_open_cloud(rng, count, dimensions):
    points = rng.uniform(-0.7, 0.9, (count, dimensions))
    state, rows = Neighbours(REACH).update(cloud(points))
    assert_right(state, rows)


@given(
    rng=clouds,
    count=st.integers(0, 120),
    dimensions=st.sampled_from([2, 3]),
    cells=st.lists(st.sampled_from([0.0, 2.0, 2.3, 3.4, 5.0]), min_size=3, max_size=3),
)
def test_periodic_cloud(rng, count, dimensions, cells):
    """From two reaches, the narrowest box in which nothing meets its own image, to five; any axis may be open."""
    period = tuple(REACH * n for n in cells)
    lengths = np.array([length or 0.7 for length in period])[:dimensions]
    points = rng.uniform(-0.5, 1.5, (count, dimensions)) * lengths
    state, rows = Neighbours(REACH, period).update(cloud(points))
    assert_right(state, rows, period)
    for axis, wide in zip(particles.axes(state), period):
        assert not wide or ((axis >= 0.0).all() and (axis <= wide).all())


@given(rng=clouds, scale=st.sampled_from([0.0, 1e-12, 1e-3]))
def test_crowd_in_one_place(rng, scale):
    """Coincident particles: everybody is everybody's neighbour, more than a row first has room for."""
    points = 0.3 + scale * rng.uniform(size=(60, 2))
    state, rows = Neighbours(REACH).update(cloud(points))
    assert_right(state, rows)
    np.testing.assert_array_equal(rows.number, 59)


@pytest.mark.parametrize("dimensions", [2, 3])
@pytest.mark.parametrize("period", [(0.0, 0.0, 0.0), (1.0, 1.0, 1.0)])
@pytest.mark.parametrize("count", [0, 1])
def test_none_or_one(count, period, dimensions):
    state, rows = Neighbours(REACH, period).update(cloud(np.full((count, dimensions), 0.4)))
    assert len(state.x) == len(rows.number) == count
    assert rows.number.sum() == 0


def test_only_a_line_in_a_plane():
    """Extent zero along y: one row of cells."""
    points = np.stack((np.linspace(0.0, 5.0, 101), np.full(101, 2.0)), axis=1)
    state, rows = Neighbours(REACH).update(cloud(points))
    assert_right(state, rows)


def marked(rng, count, dimensions):
    """A cloud whose every array is a function of ident, so that a mix-up shows."""
    state = particles.empty(
        count,
        particles.FIELDS if dimensions == 3 else ("temperature", "diameter", "diameter_variance", "theta"),
        dimensions,
    )
    for array in state:
        array[:] = rng.uniform(0.0, 1.0, len(array))
    state.ident[:] = rng.permutation(count)
    state.kind[:] = state.ident % 2
    return state


def by_ident(state):
    return [array[np.argsort(state.ident)] if len(array) else array for array in state]


@given(rng=clouds, dimensions=st.sampled_from([2, 3]), period=st.sampled_from([(0.0, 0.0, 0.0), (1.0, 1.0, 1.0)]))
def test_every_array_stays_with_its_particle(rng, dimensions, period):
    state = marked(rng, 80, dimensions)
    before = [array.copy() for array in by_ident(state)]
    after, _ = Neighbours(REACH, period).update(state)
    assert not np.array_equal(after.ident, state.ident)  # they were reordered
    for was, now in zip(before, by_ident(after)):
        np.testing.assert_array_equal(now, was)


@given(
    rng=clouds,
    moves=st.lists(st.sampled_from([0.0, 0.3, 0.49, 0.6, 3.0]), min_size=1, max_size=6),
    period=st.sampled_from([0.0, 1.0]),
)
def test_rows_hold_while_particles_move(rng, moves, period):
    """Moves of less and of more than half the skin, one after the other, also through periodic boundaries."""
    near = Neighbours(REACH, (period, period))
    state, rows = near.update(cloud(rng.uniform(0.0, 1.0, (60, 2))))
    for share in moves:
        direction = rng.normal(size=(60, 2))
        step = share * SKIN * REACH * direction / np.linalg.norm(direction, axis=1)[:, None]
        for axis, moved in zip(particles.axes(state), step.T):
            axis += moved
        state, rows = near.update(state)
        assert_right(state, rows, (period, period, 0.0))


def test_rows_are_kept_within_half_the_skin_and_rebuilt_beyond():
    near = Neighbours(REACH)
    state, rows = near.update(cloud(np.random.default_rng(1).uniform(0.0, 1.0, (50, 2))))
    state.x[7] += 0.49 * SKIN * REACH
    kept, same = near.update(state)
    assert kept is state and same is rows
    state.x[7] += 0.02 * SKIN * REACH
    _, fresh = near.update(state)
    assert fresh is not rows


def test_rows_follow_when_particles_come_and_go():
    near = Neighbours(REACH)
    state, _ = near.update(cloud(np.random.default_rng(2).uniform(0.0, 1.0, (50, 2))))
    for changed in (particles.take(state, state.ident % 3 > 0), state, particles.take(state, state.ident < 0)):
        after, rows = near.update(changed)
        assert_right(after, rows)


@given(count=st.integers(2, 60), rng=clouds)
def test_rows_are_symmetric(count, rng):
    """What i has in its row has i in its own: sums over pairs are antisymmetric to round-off only so."""
    state, rows = Neighbours(REACH).update(cloud(rng.uniform(0.0, 1.0, (count, 2))))
    pairs = listed(state, rows)
    assert {(b, a) for a, b in pairs} == pairs


@given(count=st.integers(1, 60), rng=clouds)
def test_rows_end_in_the_particle_itself(count, rng):
    """Up to whole vectors: what loops of pairs run over beyond the neighbours adds nothing."""
    _, rows = Neighbours(REACH).update(cloud(rng.uniform(0.0, 1.0, (count, 2))))
    for i in range(count):
        last = length.py_func(rows, i)
        assert last % LANES == 0 and 0 <= last - rows.number[i] < LANES
        assert (rows.entries[rows.start[i] :][rows.number[i] : last] == i).all()


@given(
    apart=st.lists(st.floats(-3.0, 3.0), min_size=3, max_size=3),
    period=st.lists(st.sampled_from([0.0, 1.0, 2.5]), min_size=3, max_size=3),
)
def test_nearest_image(apart, period):
    found = nearest_image(box_of(period, 3), *apart)
    for given_, image, wide in zip(apart, found, period):
        shift = given_ - image
        if not wide:
            assert image == given_
        else:
            assert abs(image) <= 0.5 * wide * (1.0 + 1e-12)
            assert shift / wide == pytest.approx(round(shift / wide), abs=1e-9)


def test_box_narrower_than_two_reaches_is_refused():
    """There a particle would meet a neighbour and its image, and a list holds one of them."""
    with pytest.raises(ValueError, match="two reaches"):
        Neighbours(REACH, (1.9 * REACH, 1.0))


def test_one_far_away_particle_costs_no_memory():
    """A grain thrown a million reaches away leaves the grid coarse, not as large as its box."""
    points = np.random.default_rng(3).uniform(0.0, 1.0, (50, 2))
    points[0] = 1e6 * REACH
    state, rows = Neighbours(REACH).update(cloud(points))
    assert_right(state, rows)
