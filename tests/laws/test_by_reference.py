"""Tuples that compiled functions take by reference: read as they are, held no longer than the call."""

import re
import sys
from typing import NamedTuple

import numba
import numpy as np
import pytest
from numba import prange

from sdph.laws.by_reference import Reference, by_reference
from sdph.laws.compiled import law, parallel


@by_reference
class Inner(NamedTuple):
    """A member that is a reference itself."""

    many: np.ndarray


@by_reference
class Group(NamedTuple):
    """Members of every kind that ours have."""

    x: np.ndarray
    table: np.ndarray
    tags: np.ndarray
    number: int
    size: float
    pair: tuple
    inner: Inner


def group(count=5):
    table = np.arange(3.0 * count).reshape(count, 3)
    return Group(np.arange(1.0, count + 1), table, np.arange(count, dtype=np.int8), 7, 0.5, (table[0], 2.0),
                 Inner(np.full(count, 100.0)))  # fmt: skip


@law
def _of_one(own, i):
    return own.x[i] + own.table[i, 2] + own.tags[i] + own.number * own.size + own.pair[0][1] * own.pair[1]


@parallel
def _sums(own, out):
    total = 0.0
    for i in prange(len(out)):
        out[i] = _of_one(own, i) + own.inner.many[i]
        total += out[i]
    return total


@parallel
def _moved(own, by):
    for i in prange(len(own.x)):
        own.x[i] += by


def expected(own):
    return own.x + own.table[:, 2] + own.tags + own.number * own.size + own.pair[0][1] * own.pair[1] + own.inner.many


def test_members_are_read_by_name_also_by_threads_and_by_what_loops_call():
    own = group()
    out = np.full(5, np.nan)
    assert numba.typeof(own) == Reference(Group, tuple(map(numba.typeof, own)))
    assert _sums(own, out) == expected(own).sum()
    np.testing.assert_array_equal(out, expected(own))
    other = own._replace(x=own.x[::-1].copy(), size=-1.0)
    assert _sums(other, out) == expected(other).sum()


def test_what_a_loop_writes_is_written():
    """numba drops what a loop of threads writes into an array of a tuple; a reference is none."""
    own = group()
    _moved(own, 2.5)
    np.testing.assert_array_equal(own.x, np.arange(3.5, 8.5))


def test_nothing_is_held_after_the_call():
    own, out = group(), np.zeros(5)
    held = own.x, own.table, own.tags, own.pair[0], own.inner.many
    before = [sys.getrefcount(array) for array in held]
    for _ in range(3):
        _sums(own, out)
    assert [sys.getrefcount(array) for array in held] == before


def test_length_is_the_number_of_members():
    @numba.njit
    def length(own):
        return len(own)

    assert length(group()) == len(Group._fields) and length(group().inner) == 1


def test_a_member_that_is_not_there_does_not_compile():
    @numba.njit
    def absent(own):
        return own.y

    with pytest.raises(numba.TypingError, match="Unknown attribute 'y'"):
        absent(group())


def test_a_member_of_another_kind_is_another_function():
    own = group()
    whole = own._replace(tags=np.arange(5))
    assert numba.typeof(whole) != numba.typeof(own)
    assert _sums(whole, np.zeros(5)) == expected(whole).sum()


def test_two_classes_of_one_name_are_two_types():
    """Of the second the fields stand the other way round."""
    first, second = (by_reference(NamedTuple("Pair", [(name, float) for name in names])) for names in ("ab", "ba"))

    @numba.njit
    def a(own):
        return own.a

    assert (a(first(a=1.0, b=2.0)), a(second(a=1.0, b=2.0))) == (1.0, 1.0)


def test_the_way_in_writes_and_reads_nothing():
    """LLVM takes what a function reads to stay the same: one that writes it too would read what is not yet there."""

    @numba.njit(forceinline=True)
    def read(own, i):
        return own.x[i] * own.size

    assert read(group(), 1) == 1.0
    functions = re.split(r"\n(?=define )", next(iter(read.inspect_llvm().values())))[1:]
    ways_in = [text for text in functions if "cpython" in text.partition("{")[0]]
    assert ways_in and not any("!invariant.load" in text for text in ways_in)
    assert any("!invariant.load" in text for text in functions)


def test_tuples_of_arrays_on_a_device_stay_tuples():
    class There:
        __cuda_array_interface__ = {}
        _numba_type_ = numba.float64[::1]

    away = Inner(There())
    assert isinstance(numba.typeof(away), numba.types.BaseTuple)
