"""Space cut among processes: all of it, evenly, and always alike."""

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as of_arrays

from sdph.engine import cuts
from sdph.engine.world import ALONE

PLACES = of_arrays.arrays(float, st.tuples(st.integers(0, 60), st.integers(2, 3)), elements=st.floats(-1.0, 1.0))


@pytest.mark.parametrize("number", [2, 3, 4, 7])
def test_parts_weigh_the_same(number):
    rng = np.random.default_rng(number)
    places, weight = rng.random((20000, 3)) * (4.0, 1.0, 1.0), 1.0 + rng.random(20000)
    owner = cuts.owner(cuts.cut(ALONE, places, weight, range(number)), places)
    sums = np.bincount(owner, weight, minlength=number)
    assert len(sums) == number and np.abs(sums / sums.mean() - 1.0).max() < 0.01


@settings(max_examples=50, deadline=None)
@given(PLACES, st.integers(1, 6))
def test_every_place_has_one_owner_wherever_it_is(places, number):
    tree = cuts.cut(ALONE, places, np.ones(len(places)), range(number)) if len(places) else 0
    found = cuts.owner(tree, places)
    assert found.shape == (len(places),) and ((found >= 0) & (found < number)).all()
    np.testing.assert_array_equal(cuts.owner(tree, places[::-1])[::-1], found)


def test_the_longest_way_is_cut():
    axis, value, below, above = cuts.cut(
        ALONE, np.random.default_rng(0).random((99, 2)) * (1.0, 3.0), np.ones(99), range(2)
    )
    assert axis == 1 and 1.0 < value < 2.0 and (below, above) == (0, 1)


@settings(max_examples=200, deadline=None)
@given(PLACES, st.integers(2, 7), st.floats(0.0, 1.0), st.booleans())
@example(np.array([[1.0, -1e-66], [-1e-66, -1e-66]]), 2, 1.0, False)  # apart by the reach, less what round-off takes
@example(np.array([[5e-324, 0.0], [0.0, 0.0]]), 2, 0.0, False)  # nothing lies between
def test_who_has_places_near_a_box_is_beside_it(places, number, reach, turns):
    """Boxes that are not beside each other need not look for places near the other, whatever the turn."""
    if not len(places):
        return
    d = places.shape[1]
    period = (2.5 if turns else 0.0,) + (0.0,) * (d - 1)
    owner = cuts.owner(cuts.cut(ALONE, places, np.ones(len(places)), range(number)), places)
    parts = [places[owner == rank] for rank in range(number)]
    ends = np.array([(own.min(axis=0, initial=np.inf), own.max(axis=0, initial=-np.inf)) for own in parts])
    masks = [cuts.beside(ends, rank, reach, period) for rank in range(number)]
    for here, mask in enumerate(masks):
        for there in range(number):
            seen = cuts.near(parts[here], *ends[there], reach, period).any() if len(parts[here]) else False
            assert mask[there] or here == there or not seen
            assert mask[there] == masks[there][here]
    assert not any(mask[rank] for rank, mask in enumerate(masks))


def test_boxes_far_apart_are_not_beside_each_other():
    ends = np.array([((low, 0.0), (low + 1.0, 1.0)) for low in (0.0, 1.5, 5.0, 9.0)])
    assert cuts.beside(ends, 0, 0.6, (0.0, 0.0)).tolist() == [False, True, False, False]
    assert cuts.beside(ends, 0, 0.6, (10.5, 0.0)).tolist() == [False, True, False, True]
