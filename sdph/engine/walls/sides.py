"""Walls of grains: dummy particles behind the sides of the domain, and behind any surface mesh."""

from __future__ import annotations

import itertools

import numpy as np

from sdph.engine.geometry import SIDES
from sdph.engine.rows import Neighbours, Rows
from sdph.engine.walls import facets
from sdph.engine.walls import mesh as sides
from sdph.engine.walls.dummies import Dummies, Wall, seen, turned
from sdph.laws.kernels import SUPPORT

LAYERS = 3  # the support of the kernel is 2 h = 3 spacings


class Boundary:
    """The dummies of a case and which of them each particle sees: none of a mesh that it stands behind."""

    def __init__(self, case):
        self.search = Neighbours(SUPPORT * case.smoothing_length, case.domain.period, case.resolution.neighbour_skin)
        table, self.spacing = dummies(case), case.resolution.spacing
        order = self.search.sort(tuple(np.ascontiguousarray(column) for column in table[:, : case.dimensions].T))
        self.dummies = Dummies(*(np.ascontiguousarray(column) for column in table[order, :-1].T))
        self.of_mesh = table[order, -1] > 0.0

    def rows(self, state_axes):
        """Dummies near each particle; valid as long as the particles' own rows."""
        rows = self.search.seen_from(_axes(self.dummies, len(state_axes)), state_axes)
        if self.of_mesh.any():
            sides.keep_in_front(self.dummies, self.of_mesh, sides.three(state_axes), rows)
        return rows

    def seen(self, rows) -> tuple[Wall, Rows]:
        """Dummies for loops, and the rows of the particles that each of them has in front."""
        return seen(self.dummies, rows), turned(rows, len(self.dummies.x))

    def part(self, rows, wall_rows, state_axes) -> None:
        """Take the pairs out of the particles' rows that a mesh lies between."""
        if self.of_mesh.any():
            sides.part(self.dummies, self.of_mesh, self.spacing, sides.three(state_axes), wall_rows, rows)


def _axes(dummies: Dummies, dimensions: int):
    return (dummies.x, dummies.y, dummies.z)[:dimensions]


def dummies(case) -> np.ndarray:
    """(W, 12) columns of `Dummies` of all dummies of a case; 1 for those of a mesh."""
    own, d = case.parameters["walls"], case.dimensions
    vessel = own.mesh and own.source == "gas"  # then all walls are the mesh's
    parts = [] if vessel else [np.pad(_box(case), ((0, 0), (0, 1)))]
    if own.mesh:
        corners, slip = facets.read(own.mesh, d, own.mesh_scale), facets.slips(own.mesh, d)
        parts += [
            np.pad(_behind_facets(corners[slip == slips], case, slips), ((0, 0), (0, 1)), constant_values=1.0)
            for slips in (False, True)
            if (slip == slips).any()
        ]
    return np.concatenate(parts)


def _box(case) -> np.ndarray:
    """Lattice points outside the box that lie behind a closed side, at most LAYERS deep."""
    d, spacing = case.dimensions, case.resolution.spacing
    counts = [max(1, round(length / spacing)) for length in case.domain.size]
    steps = [length / n for length, n in zip(case.domain.size, counts)]
    layers = [0 if period else LAYERS for period in case.domain.period]
    ticks = [(np.arange(-more, n + more) + 0.5) * step for n, step, more in zip(counts, steps, layers)]
    low, high = np.array(case.domain.corner), np.array(case.domain.upper)
    points = low + np.stack([m.ravel() for m in np.meshgrid(*ticks, indexing="ij")], axis=1)
    outside = np.stack([(points < low), (points > high)], axis=-1)  # (P, d, end)
    depth = np.maximum(low - points, points - high)
    closed = np.stack([_closed(case, points, side) for side in itertools.islice(SIDES, 2 * d)], axis=1).reshape(
        -1, d, 2
    )
    keep = outside.any(axis=(1, 2)) & (~outside | closed).all(axis=(1, 2))
    table = np.zeros((int(keep.sum()), len(Dummies._fields)))
    table[:, :d] = points[keep]
    single = outside[keep].sum(axis=(1, 2)) == 1
    table[:, 3 : 3 + d] = np.where(single[:, None], outside[keep, :, 0] * 1.0 - outside[keep, :, 1] * 1.0, 0.0)
    table[:, 6] = depth[keep].max(axis=1)
    slips = np.stack(
        [_behind(case, points, side, "slip_wall") for side in itertools.islice(SIDES, 2 * d)], axis=1
    ).reshape(-1, d, 2)
    table[:, 7] = (outside & ~slips)[keep].any(axis=(1, 2))  # in a corner the side that grips rules
    for side, behind in zip(SIDES, outside.reshape(len(points), 2 * d).T):
        for boundary in case.boundaries.values():
            if boundary.kind == "wall" and boundary.side == side and boundary.velocity:
                slides = behind & _within(points, SIDES[side][0], boundary.span)
                table[slides[keep] & single, 8 : 8 + d] = boundary.velocity[:d]  # corners are at rest
    return table


def _closed(case, points, side: str) -> np.ndarray:
    """Mask of the points in front of which a side holds grains back: all but pressure outlets do."""
    return ~_behind(case, points, side, "pressure_outlet")


def _behind(case, points, side: str, kind: str) -> np.ndarray:
    """Mask of the points in front of which a side is a boundary of `kind`."""
    axis, _ = SIDES[side]
    mask, rank = np.zeros(len(points), bool), np.zeros(len(points), int)
    for boundary in case.boundaries.values():  # a span before a whole side before what is left over
        if boundary.side in (side, None):
            level = 1 if boundary.side is None else 2 if boundary.span is None else 3
            own = _within(points, axis, boundary.span) & (rank < level)
            mask[own], rank[own] = boundary.kind == kind, level
    return mask


def _within(points, axis: int, span) -> np.ndarray:
    """Mask of the points within a span [m] on the tangential axes; everywhere without one."""
    if span is None:
        return np.ones(len(points), bool)
    spans = span if isinstance(span[0], tuple) else (span,)
    tangential = [a for a in range(points.shape[1]) if a != axis]
    return np.logical_and.reduce(
        [(points[:, a] >= low) & (points[:, a] <= high) for a, (low, high) in zip(tangential, spans)]
    )


def _behind_facets(corners: np.ndarray, case, slips: bool) -> np.ndarray:
    """Dummies in LAYERS behind facets (F, d, d) [m], which let grains slip or not."""
    spacing, d = case.resolution.spacing, case.dimensions
    points, normals = facets.spread(corners, spacing)
    depth = (np.repeat(np.arange(LAYERS), len(points)) + 0.5) * spacing
    normal = np.tile(normals, (LAYERS, 1))
    table = np.zeros((len(depth), len(Dummies._fields)))
    table[:, :d] = np.tile(points, (LAYERS, 1)) - depth[:, None] * normal
    table[:, 3 : 3 + d], table[:, 6], table[:, 7] = normal, depth, 0.0 if slips else 1.0
    return table
