"""Conjugate gradients on rows against a direct solution."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sdph.engine import linear
from sdph.engine.rows import Rows


def drawn(count: int, seed: int):
    """A symmetric matrix with positive neighbours and a diagonal that is larger, as Matrix and whole."""
    rng = np.random.default_rng(seed)
    links = np.triu(rng.uniform(0.0, 1.0, (count, count)) * (rng.random((count, count)) < 0.3), 1)
    links = links + links.T
    diagonal = links.sum(axis=1) + rng.uniform(0.01, 1.0, count)
    number = (links > 0).sum(axis=1)
    rows, columns = np.nonzero(links)
    own = Rows(columns.astype(np.uint32), np.cumsum(number) - number, number)
    return linear.Matrix(diagonal, own, links[rows, columns]), np.diag(diagonal) - links


@settings(max_examples=40, deadline=None)
@given(st.integers(1, 60), st.integers(0, 2**31))
def test_the_solution_is_that_of_the_whole_matrix(count, seed):
    matrix, whole = drawn(count, seed)
    right, x = np.random.default_rng(seed + 1).normal(size=count), np.zeros(count)
    assert linear.solve(matrix, right, x, 1e-12, 10 * count + 10) <= count + 10
    np.testing.assert_allclose(x, np.linalg.solve(whole, right), rtol=1e-7, atol=1e-9)


def test_a_right_guess_takes_no_iteration():
    matrix, whole = drawn(30, 1)
    x = np.arange(30.0)
    assert linear.solve(matrix, whole @ x, x.copy(), 1e-10, 5) == 0
    assert linear.solve(matrix, np.zeros(30), np.zeros(30), 1e-3, 5) == 0


def test_too_few_iterations_are_told():
    matrix, _ = drawn(50, 2)
    with pytest.raises(linear.Unsolved, match="1 iterations left a residual of"):
        linear.solve(matrix, np.ones(50), np.zeros(50), 1e-12, 1)


def test_a_long_sum_does_not_hang_on_threads():
    import numba

    a, b = np.random.default_rng(3).normal(size=(2, 100_003))
    before, found = numba.get_num_threads(), set()
    for threads in range(1, before + 1):
        numba.set_num_threads(threads)
        found.add(linear.dot(a, b))
    numba.set_num_threads(before)
    assert len(found) == 1
    assert found.pop() == pytest.approx(float(a @ b), rel=1e-12)
