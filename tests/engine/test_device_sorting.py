"""Sorting, running sums, sums and extremes of a device, as numba's simulator runs them, against numpy.

The tests are functions of this file that a process of its own runs with NUMBA_ENABLE_CUDASIM=1.
"""

import math
import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.append(str(Path(__file__).parents[1]))  # where this file is a process of its own

from on_simulator import make_strict, simulated

from sdph.engine import arrays

SIZES = (0, 1, 5, 6, 7, 12, 13, 200)  # some divide by the number of threads, some are fewer
DRAW = np.random.default_rng(3)


def sums(card) -> None:
    """Where parts begin, and what a mask chooses."""
    for many in SIZES:
        lengths = DRAW.integers(0, 9, many)
        begin = card.bring(card.begins(card.send(lengths)))
        assert begin.tolist() == [0, *np.cumsum(lengths)]
        mask = DRAW.random(many) < 0.4
        rows = card.bring(card.chosen(card.send(mask)))
        assert rows.dtype == np.int32 and rows.tolist() == np.flatnonzero(mask).tolist()
    assert len(card.bring(card.chosen(card.send(np.zeros(9, bool))))) == 0


def order(card) -> None:
    """Rows cell by cell in their order before, some cells empty, one with all."""
    for many in SIZES:
        for cells in (1, 4, 50):
            number = DRAW.integers(0, cells, many)
            expected = arrays.order(number, cells), arrays.starts(number, cells)
            there = card.send(number)
            found = card.order(there, cells), card.starts(there, cells)
            for one, other in zip(found, expected):
                assert card.bring(one).tolist() == other.tolist()


def tidied(card) -> None:
    """Rows of a cell stand in their order, whichever thread came first."""
    from sdph.engine.gpu import sorting
    from sdph.engine.gpu.card import LOOP

    start, rows = card.send(np.array([0, 4, 4, 9])), card.send(np.array([3, 0, 8, 1, 7, 2, 6, 5, 4]))
    sorting.tidy[LOOP](start, rows)
    assert card.bring(rows).tolist() == [0, 1, 3, 8, 2, 4, 5, 6, 7]


def extremes(card) -> None:
    """Sums of columns, ends, products, copies."""
    for many in SIZES:
        values = DRAW.normal(size=(many, 3))
        there = card.send(values)
        np.testing.assert_allclose(card.total(there), values.sum(axis=0), rtol=0.0, atol=1e-13)
        assert (card.bring(card.times(2.5, there)) == 2.5 * values).all()
        twin = card.copy(there)
        assert (card.bring(twin) == values).all() and twin is not there
        line = values[:, 0].copy()
        wide = line * 10.0 ** DRAW.integers(-8, 8, many)
        assert card.exact(card.send(wide)) == pytest.approx(math.fsum(wide), rel=1e-15)
        assert arrays.ends(card.send(line)) == arrays.ends(line)
    assert card.bring(card.filled((2, 3), np.int8, 7)).tolist() == [[7] * 3] * 2


def loops(card) -> None:
    """A loop runs where its arrays lie, takes small ones along and no large ones; sums and largest values come back."""
    from sdph.engine import motion

    axis = DRAW.normal(size=50)
    zero, still, there = np.zeros(50), np.zeros(0), card.send(axis)
    where = card.send(zero), card.send(still)
    before = card.launches
    assert motion.travelled(axis, zero, still, zero, zero, still) == (axis**2).max() and card.launches == before
    found = motion.travelled(there, where[0], where[1], where[0], where[0], where[1])
    assert found == (axis**2).max() and card.launches == before + 2
    motion.wrap(there, 0.7)
    assert (card.bring(there) == axis % 0.7).all()
    motion.densify(card.send(np.arange(5, dtype=np.int32)), np.ones(50), 0.5, there)  # a small one of memory
    np.testing.assert_array_equal(card.bring(there)[:5], axis[:5] % 0.7 + 0.5)
    with pytest.raises(TypeError, match="lies in memory"):
        motion.densify(card.send(np.arange(5, dtype=np.int32)), np.ones(500), 0.5, there)


@pytest.mark.parametrize("what", [sums, order, tidied, extremes, loops])
def test_what_a_device_does_is_what_numpy_does(what):
    done = simulated(what.__name__, file=__file__)
    assert done.returncode == 0, done.stderr[-3000:]


def test_places_of_a_period_are_those_of_numpy():
    from sdph.engine import motion

    axis = np.concatenate((DRAW.normal(scale=3.0, size=1000), [0.0, -0.0, 1.5, -1.5, 3.0, -1e-30]))
    wrapped = axis.copy()
    motion.wrap(wrapped, 1.5)
    assert (wrapped == np.mod(axis, 1.5)).all()


if __name__ == "__main__":
    from sdph.engine.gpu.card import begun

    make_strict()
    globals()[sys.argv[1]](begun())
