"""Faces of walls that have a temperature: points on the surface in front of the first layer of dummies, one spacing
apart, each with the area that is its own."""

from __future__ import annotations

import itertools
from typing import NamedTuple

import numpy as np

from sdph.engine.neighbours import Neighbours
from sdph.engine.rows import Rows
from sdph.engine.walls.dummies import turned
from sdph.engine.walls.sides import lattice
from sdph.laws.by_reference import by_reference
from sdph.laws.kernels import SUPPORT
from sdph.schema import CaseError

KINDS = ("wall", "slip_wall")  # of boundaries; at others a temperature is that of gas that comes in


class Faces(NamedTuple):
    """F faces: place [m], unit normal towards the grains, area [m^(d-1)], temperature [K]."""

    x: np.ndarray
    y: np.ndarray
    z: np.ndarray
    normal_x: np.ndarray
    normal_y: np.ndarray
    normal_z: np.ndarray
    area: np.ndarray
    temperature: np.ndarray


Seen = by_reference(NamedTuple("Seen", [(name, np.ndarray) for name in (*Faces._fields, *Rows._fields)]))
Seen.__doc__ = """Faces as loops take them, in one flat group: their fields, and the rows of the particles that see
them."""


def temperatures(case) -> dict[str, float]:
    """Temperature [K] of each boundary that is a wall, and of each part, that has one, by name."""
    of_kind = {name: own for name, own in case.boundaries.items() if own.kind in KINDS}
    return {name: own.temperature for name, own in (*of_kind.items(), *case.parts.items()) if own.temperature}


class Heated:
    """The faces of a case that have a temperature, by name, and which of them each particle sees."""

    def __init__(self, case, boundary):
        given = temperatures(case)
        found, w, axis, real = surface(case, boundary)
        here = {name: share[w, axis] == 1.0 for name, share in boundary.shares(case, given).items()}
        self.names = tuple(name for name, own in here.items() if own.any())
        own = np.array([here[name] for name in self.names]).reshape(len(self.names), len(w))
        _refuse_twice(self.names, own)
        self.search = Neighbours(SUPPORT * case.smoothing_length, case.domain.period, case.resolution.neighbour_skin)
        chosen = np.flatnonzero(own.any(axis=0))
        chosen = chosen[self.search.sort(_axes(found[chosen].T, case.dimensions))]
        self.owners, heat = own[:, chosen], np.array([given[name] for name in self.names])
        self.faces = Faces(*(np.ascontiguousarray(column) for column in (*found[chosen].T, heat @ self.owners)))
        self.areas = self.owners @ (self.faces.area * real[chosen])  # (n,) [m^(d-1)] of the names

    def seen(self, places) -> tuple[Seen, Rows]:
        """Faces for loops, for particles at `places`, and the rows of the particles that each of them has in front."""
        rows = self.search.seen_from(_axes(self.faces, len(places)), places)
        return Seen(*self.faces, *rows), turned(rows, len(self.faces.x))


def _axes(columns, dimensions: int):
    return tuple(np.ascontiguousarray(column) for column in columns[:dimensions])


def surface(case, boundary) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """(F, 7) columns of `Faces` but the temperature, of all walls; which dummy each is in front of, and along which
    axis of a side (0 of a mesh); False where it goes on with a side beyond a corner of the box: a side without heat
    that meets it is a mirror, and what lies behind both dummies is not empty there."""
    own, d = boundary.dummies, case.dimensions
    places, steps = np.stack(own[:3], axis=1), np.array(lattice(case)[1])
    mesh = np.flatnonzero(boundary.area > 0.0)
    feet = boundary.feet[mesh]
    parts = [(np.column_stack((feet, np.stack(own[3:6], axis=1)[mesh], boundary.area[mesh])), mesh, 0, True)]
    low, high = np.array(case.domain.corner), np.array(case.domain.upper)
    depth = np.stack((low - places[:, :d], places[:, :d] - high))  # (end, W, d)
    for axis, (end, plane) in itertools.product(range(d), enumerate((low, high))):
        first = np.flatnonzero(~boundary.of_mesh & (depth[end, :, axis] > 0.0) & (depth[end, :, axis] < steps[axis]))
        table = np.zeros((len(first), 7))
        table[:, :3], table[:, axis], table[:, 3 + axis] = places[first], plane[axis], 1.0 - 2.0 * end
        table[:, 6] = np.prod(steps) / steps[axis]
        parts.append((table, first, axis, (depth[:, first] > 0.0).any(axis=0).sum(axis=1) == 1))
    spread = ([np.broadcast_to(value, len(own)) for value in rest] for _, own, *rest in parts)
    axes, real = (np.concatenate(columns) for columns in zip(*spread))
    return np.concatenate([table for table, *_ in parts]), np.concatenate([own for _, own, *_ in parts]), axes, real


def _refuse_twice(names, own) -> None:
    """CaseError where a face has two temperatures."""
    twice = own[:, own.sum(axis=0) > 1]
    if twice.size:
        first, second = (names[n] for n in np.flatnonzero(twice[:, 0])[:2])
        raise CaseError(
            f"{first} and {second} have a temperature each, and share a wall; leave one out, or make parts that do not "
            "overlap"
        )
