"""Linear equations whose pattern is that of neighbour rows: symmetric, the diagonal no less than the rest of its row.

A Matrix stands for `diagonal_i x_i - sum value_ij x_j`. Sums are taken in parts of fixed size, so that they do not hang
on the number of threads.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import prange

from sdph.laws.compiled import parallel

PART = 4096  # of a sum; our choice


class Matrix(NamedTuple):
    """diagonal (N,), and of row i the columns and values (E,) from start[i] to start[i + 1]."""

    diagonal: np.ndarray
    start: np.ndarray
    column: np.ndarray
    value: np.ndarray


class Unsolved(RuntimeError):
    """Conjugate gradients that have not come to their tolerance."""


def solve(matrix: Matrix, right, x, tolerance: float, most: int) -> int:
    """Put the solution into x (N,), which is the first guess, until |right - A x| <= tolerance |right|; iterations.

    Conjugate gradients with the diagonal before them: Hestenes & Stiefel 1952, J. Res. Nat. Bur. Stand. 49, 409.
    `Unsolved` after `most` of them.
    """
    aim = tolerance * math.sqrt(dot(right, right))
    residual = right - multiply(matrix, x)
    if math.sqrt(dot(residual, residual)) <= aim:
        return 0
    smooth = residual / matrix.diagonal
    along, weight = smooth.copy(), dot(residual, smooth)
    for number in range(1, most + 1):
        moved = multiply(matrix, along)
        step = weight / dot(along, moved)
        x += step * along
        residual -= step * moved
        if math.sqrt(dot(residual, residual)) <= aim:
            return number
        np.divide(residual, matrix.diagonal, out=smooth)
        before, weight = weight, dot(residual, smooth)
        along *= weight / before
        along += smooth
    left = math.sqrt(dot(residual, residual)) / (aim / tolerance)
    raise Unsolved(f"{most} iterations left a residual of {left:.3g} of the right-hand side, above {tolerance:g}")


@parallel
def multiply(matrix, x):
    """A x (N,)."""
    out = np.empty(len(x))
    for i in prange(len(x)):
        own = matrix.diagonal[i] * x[i]
        for e in range(matrix.start[i], matrix.start[i + 1]):
            own -= matrix.value[e] * x[matrix.column[e]]
        out[i] = own
    return out


def dot(a, b) -> float:
    """sum a b, in parts that are the same on any number of threads."""
    return float(_parts(a, b).sum())


@parallel
def _parts(a, b):
    parts = np.zeros((len(a) + PART - 1) // PART)
    for k in prange(len(parts)):
        own = 0.0
        for i in range(k * PART, min((k + 1) * PART, len(a))):
            own += a[i] * b[i]
        parts[k] = own
    return parts
