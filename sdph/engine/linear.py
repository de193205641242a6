"""Linear equations whose pattern is that of neighbour rows: symmetric, the diagonal no less than the rest of its row.

A Matrix stands for `diagonal_i x_i - sum value_ij x_j`. Sums are taken in parts of fixed size, so that they do not hang
on the number of threads.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import prange

from sdph.engine import arrays
from sdph.engine.domain import WHOLE
from sdph.engine.rows import Rows, laid, place
from sdph.laws.by_reference import by_reference
from sdph.laws.compiled import parallel

PART = 4096  # of a sum; our choice
ALL, LEFT, MOVED, WEIGHT, PLACES = 0, 1, 2, 3, 5  # among the sums of `solve`: squares of right-hand side and residual


@by_reference
class Matrix(NamedTuple):
    """diagonal (N,), links whose entries are columns (sdph.engine.rows), and along these entries the values (E,)."""

    diagonal: np.ndarray
    links: Rows
    value: np.ndarray


def links_of(number, room) -> Rows:
    """Links of these numbers of entries (N,), which are to be filled in; they are a work array of a `room`."""
    kind, start = laid(number)
    return kind(room("entries", int(arrays.last(start)), number, np.uint32), start, number)


class Unsolved(RuntimeError):
    """Conjugate gradients that have not come to their tolerance."""


class Undefined(Unsolved):
    """Equations, or a first guess, with an infinity or what is no number among them."""


def solve(matrix: Matrix, right, x, tolerance: float, most: int, room=None, domain=WHOLE) -> int:
    """Put the solution into x (N,), which is the first guess, until |right - A x| <= tolerance |right|; iterations.

    Conjugate gradients with the diagonal before them: Hestenes & Stiefel 1952, J. Res. Nat. Bur. Stand. 49, 409.
    `Unsolved` after `most` of them, `Undefined` as soon as a sum is no number. Work arrays are from a `room`. On a
    device five numbers an iteration come to the host, as |right - A x|^2 is among them. Processes of a `domain` have
    the rows of own particles each: x is given with fresh copies, and comes back without; the way along which all go is
    told of in every iteration, sums are of all.
    """
    room = room or arrays.Room()
    residual, smooth, along, moved = (room(name, len(x), x) for name in ("residual", "smooth", "along", "moved"))
    sums = arrays.zeros(PLACES, x)
    multiply(*matrix, x, moved)
    begin(matrix.diagonal, right, moved, residual, smooth, along)
    add(right, (right,), sums, (ALL,), domain)
    add(residual, (residual, smooth), sums, (LEFT, WEIGHT), domain)
    whole = math.sqrt(arrays.brought(sums)[ALL])
    if _length(sums, 0) <= tolerance * whole:
        return 0
    for number in range(1, most + 1):
        now = WEIGHT + (number + 1) % 2  # the weights of this iteration and of the next one stand there in turn
        then = 2 * WEIGHT + 1 - now
        domain.refresh(along)
        multiply(*matrix, along, moved)
        add(along, (moved,), sums, (MOVED,), domain)
        go(matrix.diagonal, sums, now, along, moved, x, residual, smooth)
        add(residual, (residual, smooth), sums, (LEFT, then), domain)
        if (left := _length(sums, number)) <= tolerance * whole:
            return number
        turn(sums, now, then, smooth, along)
    left /= whole
    raise Unsolved(f"{most} iterations left a residual of {left:.3g} of the right-hand side, above {tolerance:g}")


def _length(sums, number: int) -> float:
    """|right - A x| after a `number` of iterations; `Undefined` where it is none, or infinite."""
    found = math.sqrt(arrays.brought(sums)[LEFT])
    if not math.isfinite(found):
        raise Undefined(f"after {number} iterations |right - A x| is {found:g}")
    return found


@parallel
def multiply(diagonal, links, value, x, out):
    """out (N,) = A x of the Matrix (diagonal, links, value)."""
    for i in prange(len(x)):
        own = diagonal[i] * x[i]
        for k in range(links.number[i]):
            e = place(links, i, k)
            own -= value[e] * x[links.entries[e]]
        out[i] = own


@parallel
def begin(diagonal, right, moved, residual, smooth, along):
    """residual = right - moved, smooth and along = residual/diagonal; all (N,)."""
    for i in prange(len(right)):
        residual[i] = right[i] - moved[i]
        smooth[i] = residual[i] / diagonal[i]
        along[i] = smooth[i]


@parallel
def go(diagonal, sums, now, along, moved, x, residual, smooth):
    """A step along `along`: x, the residual, and that over the diagonal; all (N,)."""
    step = sums[now] / sums[MOVED]
    for i in prange(len(x)):
        x[i] += step * along[i]
        residual[i] -= step * moved[i]
        smooth[i] = residual[i] / diagonal[i]


@parallel
def turn(sums, now, then, smooth, along):
    """along (N,) = smooth + along times the weight of then over that of now."""
    factor = sums[then] / sums[now]
    for i in prange(len(along)):
        along[i] = along[i] * factor + smooth[i]


def add(a, others: tuple, sums, places: tuple, domain=WHOLE) -> None:
    """Sums of a b for each b of others, at their places among sums, in one order on any number of threads; over the own
    particles of all processes of a domain."""
    if not arrays.here(a):
        arrays.card.dots(a, others, sums, places)
        return
    own = np.array([dot(*map(domain.mine_of, (a, b))) for b in others])
    sums[list(places)] = domain.world.sum(own)


def dot(a, b) -> float:
    """sum a b, in parts that are the same on any number of threads."""
    parts = np.empty((len(a) + PART - 1) // PART)
    _parts(a, b, parts)
    return float(parts.sum())


@parallel
def _parts(a, b, parts):
    for k in prange(len(parts)):
        own = 0.0
        for i in range(k * PART, min((k + 1) * PART, len(a))):
            own += a[i] * b[i]
        parts[k] = own
