"""Sums over processes: one alone sums as numpy does, several add up exactly, whatever the order."""

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from sdph.engine.world import ALONE, World


class Several(World):
    """A world of two, of which the other has nothing."""

    def __init__(self):
        super().__init__()
        self.number = 2

    def _reduced(self, values, how):
        return values


@settings(max_examples=200, deadline=None)
@given(st.lists(st.floats(-1e12, 1e12), max_size=40), st.randoms())
def test_a_total_does_not_depend_on_the_order(values, random):
    told = Several().total(np.array(values, float))
    random.shuffle(values)
    assert Several().total(np.array(values, float)) == told
    assert abs(told - math.fsum(values)) <= 1e-15 * math.fsum(map(abs, values))


def test_totals_of_rows_go_by_column():
    rows = np.random.default_rng(1).standard_normal((1000, 3)) * (1e-9, 1.0, 1e9)
    np.testing.assert_allclose(Several().total(rows), rows.sum(axis=0), rtol=1e-12)
    np.testing.assert_array_equal(ALONE.total(rows), rows.sum(axis=0))


def test_nothing_has_a_total_and_a_mean():
    assert Several().total(np.zeros(0)) == 0.0 and Several().mean(np.zeros(0)) == 0.0 == ALONE.mean(np.zeros(0))
    assert Several().mean(np.array([True, False, False, False])) == 0.25
