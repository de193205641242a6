"""Dummy particles behind the walls of grains: where they stand, and how far particles are from them."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import prange

from sdph.engine import arrays
from sdph.engine.geometry import deep, nearest_image
from sdph.engine.neighbours import SKIN
from sdph.engine.rows import Rows, entry
from sdph.laws.by_reference import by_reference
from sdph.laws.compiled import inlined, parallel

CONTACT = 0.25  # spacings between a particle and the surface at which they touch; our choice, half of the start's
# reaches of the kernel within which a particle is beside a wall: as far as rows look that were just made. At one reach
# stands the third row of a lattice of h = 1.5 spacings, which round-off would move in and out; our choice
BESIDE = 1.0 + SKIN


class Dummies(NamedTuple):
    """W dummies: place [m], unit normal (0 in corners, where two walls meet), depth behind the surface [m], 0 where
    the surface lets grains slip and else 1, velocity of the surface along itself [m/s], volume [m^d]."""

    x: np.ndarray
    y: np.ndarray
    z: np.ndarray
    normal_x: np.ndarray
    normal_y: np.ndarray
    normal_z: np.ndarray
    depth: np.ndarray
    stick: np.ndarray
    slide_x: np.ndarray
    slide_y: np.ndarray
    slide_z: np.ndarray
    volume: np.ndarray


OF_ROWS = (*Rows._fields, "before", "every", "pressure", "velocity")
Wall = by_reference(NamedTuple("Wall", [(name, np.ndarray) for name in (*Dummies._fields, *OF_ROWS)]))
Wall.__doc__ = """Dummies as loops take them, in one flat group: their fields, the rows of the particles that see them,
how many of a row are before those that contact asks, and where these end (N,), pressure (W,) [Pa] and velocity (W, 3)
[m/s] that they have from the grains in front."""


def seen(dummies: Dummies, rows, before, every) -> Wall:
    """Dummies of which particles see those in `rows`, and touch those from `before` to `every` (N,)."""
    count = len(dummies.x)
    return Wall(*dummies, *rows, before, every, *(arrays.zeros(shape, dummies.x) for shape in (count, (count, 3))))


def plain(rows) -> Rows:
    """The same rows one behind the other, not filled up, where those of a device stand abreast."""
    if arrays.here(rows.number):
        return rows
    begin = arrays.begins(rows.number)
    entries, particle = (arrays.zeros(int(arrays.last(begin)), begin, np.uint32) for _ in range(2))
    tell_pairs(rows, begin, entries, particle)
    return Rows(entries, begin, rows.number)


def turned(rows, count: int) -> Rows:
    """Rows of the `count` fixed points that `rows` lists for particles: for each the particles that see it, in their
    order; not filled up."""
    begin = arrays.begins(rows.number)
    pairs = int(arrays.last(begin))
    point, particle = (arrays.zeros(pairs, begin, kind) for kind in (np.int64, np.uint32))
    tell_pairs(rows, begin, point, particle)
    start, number = arrays.starts(point, count), arrays.empty(count, begin, np.int32)
    lengths(start, number)
    return Rows(arrays.taken(particle, arrays.order(point, count)), start, number)


@parallel
def tell_pairs(rows, begin, point, particle):
    """point and particle (E,) of each pair, row by row; begin (N + 1,): the first of each row."""
    for i in prange(len(rows.number)):
        for k in range(rows.number[i]):
            point[begin[i] + k], particle[begin[i] + k] = entry(rows, i, k), i


@parallel
def lengths(start, number):
    """number (C,): lengths of parts that begin at start (C + 1,)."""
    for c in prange(len(number)):
        number[c] = start[c + 1] - start[c]


@inlined
def offset(box, dummies, w, s, i):
    """r_i - r_w, three components, through periodic boundaries."""
    dz = s.z[i] - dummies.z[w] if deep(box) else 0.0
    return nearest_image(box, s.x[i] - dummies.x[w], s.y[i] - dummies.y[w], dz)


@inlined
def distance(box, dummies, w, s, i):
    dx, dy, dz = offset(box, dummies, w, s, i)
    return math.sqrt(dx * dx + dy * dy + dz * dz)


@inlined
def normal_part(dummies, w, dx, dy, dz):
    """The part of a vector along the normal of a wall: nothing in a corner, which has none. Under one pressure what a
    corner adds along a side is what the rows behind that side, which end there, add along it with the other sign."""
    nx, ny, nz = dummies.normal_x[w], dummies.normal_y[w], dummies.normal_z[w]
    along = dx * nx + dy * ny + dz * nz
    return along * nx, along * ny, along * nz
