"""Arrays with a row a particle, in memory or on a device: made, chosen from, sorted by cells, added up.

Who makes one says beside which it is to lie (`like`). Devices are told apart by what they hand out: an array that is
not numpy's has `card`'s functions done to it (sdph.engine.gpu.card).
"""

from __future__ import annotations

import math

import numpy as np
from numba import prange

from sdph.laws.compiled import parallel, serial

card = None  # the device, once it is begun
SPARE = 16  # one row in so many is kept free, so that slow growth does not ask for room each time; our choice
IN_MEMORY = np.zeros(0)  # an array that lies there, to have others beside it


def here(array) -> bool:
    """True where an array lies in memory."""
    return isinstance(array, np.ndarray)


def empty(shape, like, kind=np.float64):
    """Array of a shape and a type, beside another."""
    return np.empty(shape, kind) if here(like) else card.empty(shape, kind)


def zeros(shape, like, kind=np.float64):
    """The same, all 0."""
    return np.zeros(shape, kind) if here(like) else card.filled(shape, kind, 0)


def copy(array):
    """The same values once more."""
    return array.copy() if here(array) else card.copy(array)


def brought(array) -> np.ndarray:
    """The array, or a copy of it, in memory."""
    return array if here(array) else card.bring(array)


def joined(one, other):
    """Both one after the other, where the first lies."""
    return np.concatenate((one, other)) if here(one) else card.joined(one, other)


def times(factor: float, array):
    """Array (N, k) of factor * array."""
    return factor * array if here(array) else card.times(factor, array)


def taken(array, rows):
    """array[rows]."""
    out = empty(len(rows), array, array.dtype)
    _take(array, rows, out)
    return out


@parallel
def _take(array, rows, out):
    for i in prange(len(rows)):
        out[i] = array[rows[i]]


def positive(array):
    """Array (N,) of the values above 0, and 0 for others: of volumes those of liquid, as walls have negative ones."""
    return np.maximum(array, 0.0) if here(array) else card.positive(array)


def chosen(mask):
    """Rows (int32) at which a mask (N,) of bool is set."""
    return np.flatnonzero(mask).astype(np.int32) if here(mask) else card.chosen(mask)


def total(values):
    """Sums (k,) of the rows of values (N, k), in memory."""
    return values.sum(axis=0) if here(values) else card.total(values)


def exact(values) -> float:
    """Sum of values (N,) without round-off."""
    return math.fsum(values.tolist()) if here(values) else card.exact(values)


def ends(values) -> tuple[float, float]:
    """Least and largest value of an array (N,), 0 where it is empty."""
    if not len(values):
        return 0.0, 0.0
    return (float(values.min()), float(values.max())) if here(values) else card.ends(values)


def begins(lengths):
    """Begin of each of parts of these lengths (N,), one behind the other, and the end of the last: (N + 1,) int64."""
    if not here(lengths):
        return card.begins(lengths)
    begin = np.zeros(len(lengths) + 1, np.int64)
    np.cumsum(lengths, out=begin[1:])
    return begin


def starts(number, total: int):
    """First particle of each of `total` cells, (total + 1,) int64, from the particles' cells (N,)."""
    return _starts(number, total) if here(number) else card.starts(number, total)


def order(number, total: int):
    """Row of each particle after a stable counting sort by cell: (N,) int64."""
    return _order(number, total) if here(number) else card.order(number, total)


def value(array, n: int):
    """The n-th value of an array (N,)."""
    return array[n] if here(array) else card.value(array, n)


def last(array):
    """The last value of an array (N,)."""
    return value(array, len(array) - 1)


class Room:
    """Work arrays by name, which are handed out again as long as no more rows, no other type and no other place are
    asked for: what was in them is in them. To get memory anew takes long on a device, and fresh pages do in memory."""

    def __init__(self):
        self._kept = {}

    def __call__(self, name: str, shape, like, kind=np.float64):
        count, *tail = shape if isinstance(shape, tuple) else (shape,)
        whole, part = self._kept.get(name, (None, None))
        fits = whole is not None and len(whole) >= count and whole.shape[1:] == tuple(tail) and whole.dtype == kind
        if not fits or here(whole) != here(like):
            whole = part = empty((count + count // SPARE, *tail), like, kind)
        if len(part) != count:
            part = whole[:count]
        self._kept[name] = whole, part
        return part


@serial
def _starts(number, total):
    start = np.zeros(total + 1, np.int64)
    for cell in number:
        start[cell + 1] += 1
    for cell in range(total):  # where it is: there are up to 32 cells a particle
        start[cell + 1] += start[cell]
    return start


@serial
def _order(number, total):
    start = _starts(number, total)
    rows = np.empty(len(number), np.int64)
    for i, cell in enumerate(number):
        rows[start[cell]] = i
        start[cell] += 1
    return rows


def fill(array, value) -> None:
    """array[:] = value."""
    if here(array):
        array[:] = value
    else:
        card.fill(array, value)


def beside(array, like):
    """The array, or a copy of it, where another lies."""
    return card.send(array) if here(array) and not here(like) else array


def ones(count: int, like):
    """Array (N,) of 1.0 beside another."""
    out = empty(count, like)
    fill(out, 1.0)
    return out


def counted(count: int, like):
    """Array (N,) of 0, 1, 2, ... beside another, int64."""
    return np.arange(count) if here(like) else card.counted(count)


def vectors(a, b, c):
    """(N, 3) of three arrays (N,), the last of which may have no length: 0 there."""
    if not here(a):
        return card.stacked((a, b, c if len(c) else zeros(len(a), a)))
    out = np.zeros((len(a), 3))
    out[:, 0], out[:, 1] = a, b
    if len(c):
        out[:, 2] = c
    return out


def columns(table):
    """The columns (N,) of a table (N, m)."""
    return np.ascontiguousarray(table.T) if here(table) else card.columns(table)
