"""Functions of numpy on arrays of a device, as far as what stands between sub-steps asks for them."""

from __future__ import annotations

import numpy as np

from sdph.engine import arrays
from sdph.engine.gpu.operators import columns, rows, stacked

SUMS = {
    "ij,ij->i": lambda a, b: rows(a * b),
    "ij->j": lambda a: a.sum(axis=0),
    "ij,ij->": lambda a, b: (a * b).sum(),
    "i,ij->j": lambda a, b: (a[:, None] * b).sum(axis=0),
    "i,ij,ij->": lambda a, b, c: (a * rows(b * c)).sum(),
}


def einsum(form: str, *own):
    """Sum of products, of the forms in SUMS; TypeError of others."""
    if form not in SUMS:
        raise TypeError(f"einsum of {form!r} is not known of arrays of a device: {', '.join(SUMS)}")
    return SUMS[form](*own)


def concatenate(tables, axis: int):
    """Tables (N, k) beside each other; TypeError where they are to be joined otherwise."""
    if axis != 1:
        raise TypeError("arrays of a device are joined along their last axis")
    return stacked([column for table in tables for column in columns(table)])


def column_stack(own):
    return concatenate([part if part.ndim == 2 else part[:, None] for part in own], axis=1)


def zeros_like(own):
    return arrays.zeros(own.shape, own, own.dtype)


def empty_like(own):
    return arrays.empty(own.shape, own, own.dtype)


def average(own, weights):
    return (own * weights).sum() / weights.sum()


def mean(own):
    return own.mean()


def total(own):
    return own.sum()


def flatnonzero(mask):
    """Rows that are set, in memory."""
    return arrays.brought(arrays.chosen(mask)).astype(np.int64)


def ndim(own) -> int:
    return own.ndim


def shape(own) -> tuple:
    return own.shape


def copyto(target, own) -> None:
    """Copy as the simulator does."""
    np.copyto(target, own.copy_to_host())


KNOWN = {
    np.einsum: einsum,
    np.concatenate: concatenate,
    np.column_stack: column_stack,
    np.zeros_like: zeros_like,
    np.empty_like: empty_like,
    np.average: average,
    np.mean: mean,
    np.sum: total,
    np.flatnonzero: flatnonzero,
    np.ndim: ndim,
    np.shape: shape,
    np.copyto: copyto,
}
