"""Functions of numpy on arrays of a device, as far as what stands between sub-steps asks for them."""

from __future__ import annotations

import numpy as np

from sdph.engine import arrays
from sdph.engine.gpu.operators import columns, rows, stacked


def einsum(form: str, *own):
    if form == "ij,ij->i":
        return rows(own[0] * own[1])
    if form == "ij->j":
        return own[0].sum(axis=0)
    if form == "ij,ij->":
        return (own[0] * own[1]).sum()
    if form == "i,ij->j":
        return (own[0][:, None] * own[1]).sum(axis=0)
    assert form == "i,ij,ij->", form
    return (own[0] * rows(own[1] * own[2])).sum()


def concatenate(tables, axis: int):
    """Tables (N, k) beside each other."""
    assert axis == 1
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
