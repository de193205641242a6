"""Space cut among processes: all of it, evenly, and always alike."""

import numpy as np
import pytest
from hypothesis import given, settings
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
