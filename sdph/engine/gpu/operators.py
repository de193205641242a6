"""Expressions of numpy on arrays of a device: what stands between sub-steps is written once, and runs on either side.

An operation is a kernel that goes over all values, with numpy's rules for shapes. What a numpy function would give that
is not known here is a TypeError: nothing comes ashore without a word.
"""

from __future__ import annotations

import functools
import math
import types

import numpy as np
from numpy.lib.mixins import NDArrayOperatorsMixin

from sdph.engine import arrays
from sdph.engine.gpu.toolkit import cuda, device, kernel, kind_of_arrays, lies_there, taken_for

FORMS = {
    np.positive: lambda a: a, np.negative: lambda a: -a, np.absolute: lambda a: abs(a), np.sqrt: lambda a: math.sqrt(a),
    np.isnan: lambda a: a != a, np.invert: lambda a: not a, np.add: lambda a, b: a + b, np.subtract: lambda a, b: a - b,
    np.multiply: lambda a, b: a * b, np.divide: lambda a, b: a / b, np.power: lambda a, b: a**b,
    np.minimum: lambda a, b: min(a, b), np.maximum: lambda a, b: max(a, b), np.equal: lambda a, b: a == b,
    np.not_equal: lambda a, b: a != b, np.less: lambda a, b: a < b, np.less_equal: lambda a, b: a <= b,
    np.greater: lambda a, b: a > b, np.greater_equal: lambda a, b: a >= b, np.bitwise_and: lambda a, b: a & b,
    np.bitwise_or: lambda a, b: a | b,
}  # fmt: skip
HANDLED = {}  # numpy's function -> ours: those of sdph.engine.gpu.functions, once a device is begun


@device
def at(own, r, c):
    """Value of an operand in row r and column c: of a table, whose one row or column stands for all, or a number."""
    if len(own) == 2:
        return own[1]
    table = own[0]
    return table[r if table.shape[0] > 1 else 0, c if table.shape[1] > 1 else 0]


def _of_one(a, b, where, out):
    for n in range(cuda.grid(1), out.size, cuda.gridsize(1)):
        r, c = n // out.shape[1], n % out.shape[1]
        if len(where) == 0 or at(where, r, c):
            out[r, c] = form__(at(a, r, c))  # noqa: F821 - a global that `_kernel_of` gives


def _of_two(a, b, where, out):
    for n in range(cuda.grid(1), out.size, cuda.gridsize(1)):
        r, c = n // out.shape[1], n % out.shape[1]
        if len(where) == 0 or at(where, r, c):
            out[r, c] = form__(at(a, r, c), at(b, r, c))  # noqa: F821


@functools.cache
def _kernel_of(ufunc):
    """Kernel of an operation: out where a mask, if any, is set. It has a name of its own, by which it is kept."""
    own = _of_one if ufunc.nargs == 2 else _of_two  # what it takes, and what it gives
    name = f"of_{ufunc.__name__}"
    made = types.FunctionType(own.__code__, globals() | {"form__": device(FORMS[ufunc])}, name)
    made.__module__, made.__qualname__ = __name__, name
    return kernel(made)


@kernel
def sum_rows(values, out):
    """out (N,): sums of the rows of values (N, m)."""
    for i in range(cuda.grid(1), len(out), cuda.gridsize(1)):
        found = values[i, 0]
        for c in range(1, values.shape[1]):
            found += values[i, c]
        out[i] = found


@kernel
def put_column(values, c, table):
    """table (N, m): values (N,) in column c."""
    for i in range(cuda.grid(1), len(values), cuda.gridsize(1)):
        table[i, c] = values[i]


@kernel
def take_column(table, c, values):
    """values (N,): column c of a table (N, m)."""
    for i in range(cuda.grid(1), len(values), cuda.gridsize(1)):
        values[i] = table[i, c]


@kernel
def put_rows(table, rows, values):
    """table[rows] = values (N, m)."""
    for n in range(cuda.grid(1), values.size, cuda.gridsize(1)):
        i, c = n // values.shape[1], n % values.shape[1]
        table[rows[i], c] = values[i, c]


@kernel
def count_up(out):
    """out (N,): 0, 1, 2, ..."""
    for i in range(cuda.grid(1), len(out), cuda.gridsize(1)):
        out[i] = i


class Operable(NDArrayOperatorsMixin, kind_of_arrays()):
    """An array of a device that knows operators, and some functions of numpy."""

    __hash__ = object.__hash__

    def __array_ufunc__(self, ufunc, method, *given, out=(None,), where=True):
        if method != "__call__" or (ufunc is not np.matmul and ufunc not in FORMS):
            return NotImplemented
        return product(*given) if ufunc is np.matmul else applied(ufunc, given, out[0], where)

    def __array_function__(self, function, kinds, given, named):
        return HANDLED[function](*given, **named) if function in HANDLED else NotImplemented

    def __getitem__(self, key):
        if isinstance(key, int | np.integer):
            found = super().__getitem__(int(key))
            return operable(found) if lies_there(found) else found
        if isinstance(key, Operable):
            return arrays.taken(self, arrays.chosen(key) if key.dtype == np.bool_ else key)
        if isinstance(key, tuple) and len(key) == 2 and _whole(key[0]) and not _whole(key[1]):
            if key[1] is None:
                return operable(self.reshape(len(self), 1))
            own = columns(self)[key[1]]
            return stacked(own) if isinstance(own, list) else own
        found = super().__getitem__(key)
        return operable(found) if lies_there(found) else found

    def __setitem__(self, key, value):
        if isinstance(key, Operable):
            arrays.card.launch(put_rows, self, key, value)
        elif _whole(key):
            applied(np.positive, (value,), self)
        else:  # the simulator's kernels write so
            super().__setitem__(key, value)

    def sum(self, axis=None):
        """Sum of all, or of each column."""
        found = arrays.total(self if self.ndim == 2 else operable(self.reshape(len(self), 1)))
        return found if axis == 0 and self.ndim == 2 else found.sum()

    def mean(self):
        return self.sum() / self.size

    def any(self) -> bool:
        return bool(self.sum() > 0.0)

    def all(self) -> bool:
        return bool(self.sum() == self.size)

    def max(self, initial=-math.inf):
        return max(arrays.ends(self)[1], initial) if self.size else initial

    def min(self, initial=math.inf):
        return min(arrays.ends(self)[0], initial) if self.size else initial

    def copy(self):
        return arrays.copy(self)

    def tolist(self) -> list:
        return arrays.brought(self).tolist()


def _whole(key) -> bool:
    return isinstance(key, slice) and key == slice(None)


def operable(array) -> Operable:
    """An array of a device with operators."""
    return taken_for(Operable, array)


def applied(ufunc, given, out=None, where=True):
    """Result of an operation on arrays and numbers, in `out` where it is given, where a mask is set."""
    deep = max(np.ndim(own) if not isinstance(own, Operable) else own.ndim for own in given)
    tables = [_operand(own, deep) for own in given]
    if out is None:
        shapes = [_shape(own, deep) for own in given]
        shape = np.broadcast_shapes(*shapes)
        out = arrays.card.empty(shape if deep == 2 else shape[:1], _kind(ufunc, given))
    target = out if out.ndim == 2 else operable(out.reshape(len(out), 1))
    mask = () if where is True else _operand(where, deep)
    if out.size:
        arrays.card.launch(_kernel_of(ufunc), tables[0], tables[-1], mask, target)
    return out


def _shape(own, deep: int) -> tuple[int, int]:
    shape = np.shape(own) if not isinstance(own, Operable) else own.shape
    return shape if len(shape) == 2 else (1, 1) if not shape else (1, *shape) if deep == 2 else (*shape, 1)


def _operand(own, deep: int) -> tuple:
    """An operand as kernels take it: (table,), or (0.0, number)."""
    if np.ndim(own) == 0 and not isinstance(own, Operable):
        return 0.0, own.item() if isinstance(own, np.generic) else own
    table = own if isinstance(own, Operable) else np.asarray(own)
    return (table.reshape(_shape(own, deep)),)


def _kind(ufunc, given):
    """Type of what an operation gives."""
    ones = [np.ones(1, own.dtype) if hasattr(own, "dtype") else own for own in given]
    return ufunc(*ones).dtype


def product(a, b):
    """a @ b of arrays (N,) and (N,), or (N, m) and (m,)."""
    return rows(a * b) if a.ndim == 2 else (a * b).sum()


def rows(table):
    """Sums of the rows (N,) of a table (N, m)."""
    out = arrays.card.empty(len(table), table.dtype)
    if out.size:
        arrays.card.launch(sum_rows, table, out)
    return out


def stacked(own):
    """(N, m) of m arrays (N,)."""
    table = arrays.card.empty((len(own[0]), len(own)), np.float64)
    for c, values in enumerate(own):
        if len(values):
            arrays.card.launch(put_column, values, c, table)
    return table


def columns(table) -> list:
    """The columns (N,) of a table."""
    found = [arrays.card.empty(len(table), table.dtype) for _ in range(table.shape[1])]
    for c, values in enumerate(found):
        if values.size:
            arrays.card.launch(take_column, table, c, values)
    return found
