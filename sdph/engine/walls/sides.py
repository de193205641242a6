"""Walls of grains: dummy particles behind the sides of the domain, and behind any surface mesh."""

from __future__ import annotations

import itertools
import math
from typing import NamedTuple

import numpy as np
import scipy

from sdph.engine.geometry import SIDES
from sdph.engine.neighbours import Neighbours
from sdph.engine.rows import Rows
from sdph.engine.surface import unit
from sdph.engine.walls import corners as corners_of_mesh
from sdph.engine.walls import facets, hidden, parts
from sdph.engine.walls import mesh as sides
from sdph.engine.walls.dummies import BESIDE, Dummies, Wall, plain, seen, turned
from sdph.laws.kernels import SUPPORT

LAYERS = 3  # the support of the kernel is 2 h = 3 spacings
MESH = "mesh"  # name of all of `walls.mesh` in `run.forces`
WIDER = 0.25  # spacings by which the box of a part is wider: round-off of surfaces that its faces lie in; our choice
PAIR = 3  # rows from a surface point to one that a neighbour sees: to a particle, on to its neighbour, to the point
OWNED = 2  # of a dummy of the first boundary; those of a mesh that no boundary is are 1


class Boundary:
    """The dummies of a case and which of them each particle sees: none of a mesh that it stands behind."""

    def __init__(self, case):
        own = case.resolution.neighbour_skin
        skin = max(own, BESIDE - 1.0 + 0.5 * own)  # who is beside a wall is listed, until particles' rows are made anew
        self.search = Neighbours(SUPPORT * case.smoothing_length, case.domain.period, skin)
        placed, self.spacing = dummies(case), case.resolution.spacing
        places = placed.table[:, : case.dimensions].T
        order = self.search.sort(tuple(np.ascontiguousarray(column) for column in places))
        table, self.area, self.whose, self.feet, self.facing, curved = (own[order] for own in placed)
        self.dummies = Dummies(*(np.ascontiguousarray(column) for column in table.T))
        self.of_mesh = self.whose[:, 0] > 0
        if self.of_mesh.any():
            first, plain = self.area > 0.0, self.of_mesh & ~curved
            self.beyond = sides.beyond(self.dummies, first, plain, self.feet, self.facing, self.spacing)
            reach = PAIR * SUPPORT * case.smoothing_length * (1.0 + skin)
            self.faced = sides.faced(self.dummies, self.of_mesh, self.spacing, reach)

    def rows(self, state_axes):
        """Dummies near each particle; valid as long as the particles' own rows."""
        rows = plain(self.search.seen_from(_axes(self.dummies, len(state_axes)), state_axes))
        if self.of_mesh.any():
            sides.keep_in_front(self.dummies, self.of_mesh, self.beyond, sides.three(state_axes), rows)
        return rows

    def seen(self, rows, state_axes) -> tuple[Wall, Rows]:
        """Dummies for loops, and the rows of the particles that each of them has in front."""
        before, every = np.zeros_like(rows.number), rows.number
        if self.of_mesh.any():
            places = sides.three(state_axes)
            before, every = sides.count_once(self.dummies, self.of_mesh, self.beyond, places, rows)
        return seen(self.dummies, rows, before, every), turned(rows, len(self.dummies.x))

    def part(self, rows, wall_rows, state_axes) -> None:
        """Take the pairs out of the particles' rows that a mesh lies between."""
        if self.of_mesh.any():
            sides.part(self.dummies, self.of_mesh, self.faced, self.spacing, sides.three(state_axes), wall_rows, rows)

    def shares(self, case, chosen) -> dict[str, np.ndarray]:
        """Share (W, 3) in the force on each dummy, by its components, of those of `chosen` names that are walls of
        grains (sdph.engine.walls.parts)."""
        points, known = np.stack(_axes(self.dummies, case.dimensions), axis=1), names(case)
        of_box = parts.sides(points, case.domain.corner, case.domain.upper)
        of_box = {side: share * ~self.of_mesh[:, None] for side, share in of_box.items()}
        found = {name: self._share(case, name, points, of_box) for name in chosen if name in known}
        return {name: share for name, share in found.items() if share.any()}

    def _share(self, case, name: str, points, of_box: dict) -> np.ndarray:
        """The share (W, 3) of one name; dummies stand at `points` (W, d) [m], and `of_box` are shares of its sides."""
        if name in case.boundaries:
            number = list(case.boundaries).index(name)
            own = [share * (_owners(case, points, side) == number)[:, None] for side, share in of_box.items()]
            return sum(own, parts.of_facets(self.whose == OWNED + number, self.facing))
        if name in case.parts:
            return self._share_of_part(case, case.parts[name], points, of_box)
        return of_box[name] if name in of_box else np.repeat(self.of_mesh[:, None], 3, axis=1) * 1.0

    def _share_of_part(self, case, part, points, of_box: dict) -> np.ndarray:
        """The share (W, 3) of a box: of a corner what the sides have whose surface beside it lies in the box."""
        room = WIDER * self.spacing
        low, high = np.array(case.domain.corner), np.array(case.domain.upper)
        whole = (parts.within(part, self.feet[:, : case.dimensions], room) & self.of_mesh)[:, None] * np.ones(3)
        for side, share in of_box.items():
            axis, end = SIDES[side]
            beside = np.clip(points, low + 0.5 * self.spacing, high - 0.5 * self.spacing)
            beside[:, axis] = (low, high)[end][axis]
            whole += share * parts.within(part, beside, room)[:, None]
        return whole


def names(case) -> list[str]:
    """Names of walls of grains that `run.forces` may hold: boundaries that hold grains back, sides of the domain that
    are walls, `mesh` for all of `walls.mesh`, parts."""
    own, period = case.parameters.get("walls"), case.domain.period
    if own is None:
        return []
    found = [name for name, boundary in case.boundaries.items() if not boundary.lets_out]
    if not _vessel(own):
        closed = [side for side, (axis, _) in SIDES.items() if axis < case.dimensions and not period[axis]]
        found += [name for name in (*closed, *([MESH] if own.mesh else [])) if name not in case.boundaries]
    return [*found, *case.parts]


def _vessel(own) -> bool:
    """True where all walls are a mesh's, that of the gas."""
    return bool(own.mesh) and own.source == "gas"


def _axes(dummies: Dummies, dimensions: int):
    return (dummies.x, dummies.y, dummies.z)[:dimensions]


class Placed(NamedTuple):
    """Dummies of a case: columns (W, 12) of `Dummies`; area (W,) [m^(d-1)] of a mesh in front, of its first layer, else
    0; whose (W, 3) they are: 0 of the domain's sides, 1 of a mesh, OWNED and more of a boundary's patch, in a corner of
    a mesh each of the facets that meet there; place (W, 3) [m] of the surface in front, where what presses them acts;
    of those in such a corner the normals (W, 3, 3) of the facets, else 0; and which (W,) are behind a round wall, away
    from edges that point at the grains."""

    table: np.ndarray
    area: np.ndarray
    whose: np.ndarray
    feet: np.ndarray
    facing: np.ndarray
    curved: np.ndarray


def dummies(case) -> Placed:
    """All dummies of a case."""
    own = case.parameters["walls"]
    found = [] if _vessel(own) else [_box(case)]
    if own.mesh:
        corners, slip, _, owner = facets.walls(own.mesh, case.dimensions, unit(own))
        found = [_in_sight(box, corners) for box in found]
        whose = OWNED + owner if _vessel(own) else np.full(len(slip), 1)
        behind = [
            _behind_facets(corners[slip == slips], whose[slip == slips], case, slips)
            for slips in (False, True)
            if (slip == slips).any()
        ]
        if behind:
            found += [_stretched(behind, corners, case), _beyond_facets(corners, whose, slip, case)]
    return Placed(*(np.concatenate(own) for own in zip(*found)))


def lattice(case) -> tuple[list[int], list[float]]:
    """Number of particles along each axis of the box, and their distances [m]."""
    counts = [max(1, round(length / case.resolution.spacing)) for length in case.domain.size]
    return counts, [length / n for length, n in zip(case.domain.size, counts)]


def _box(case) -> Placed:
    """Lattice points outside the box that lie behind a closed side, at most LAYERS deep."""
    d = case.dimensions
    counts, steps = lattice(case)
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
    table, feet = np.zeros((int(keep.sum()), len(Dummies._fields))), np.zeros((int(keep.sum()), 3))
    table[:, :d], feet[:, :d] = points[keep], np.clip(points[keep], low, high)
    table[:, -1] = case.resolution.spacing**d
    single = outside[keep].sum(axis=(1, 2)) == 1
    table[:, 3 : 3 + d] = np.where(single[:, None], outside[keep, :, 0] * 1.0 - outside[keep, :, 1] * 1.0, 0.0)
    table[:, 6] = depth[keep].max(axis=1)
    slips = np.stack(
        [_behind(case, points, side, lambda own: own.kind == "slip_wall") for side in itertools.islice(SIDES, 2 * d)],
        axis=1,
    ).reshape(-1, d, 2)
    table[:, 7] = (outside & ~slips)[keep].any(axis=(1, 2))  # in a corner the side that grips rules
    for side, behind in zip(SIDES, outside.reshape(len(points), 2 * d).T):
        for number, boundary in enumerate(case.boundaries.values()):
            if boundary.kind == "wall" and boundary.side == side and boundary.velocity:
                slides = behind & (_owners(case, points, side) == number)
                table[slides[keep] & single, 8 : 8 + d] = boundary.velocity[:d]  # corners are at rest
    none = np.zeros(len(table))  # the area is that of faces (sdph.engine.walls.faces)
    return Placed(table, none, np.zeros((len(table), 3), int), feet, np.zeros((len(table), 3, 3)), none > 0.0)


def _in_sight(box: Placed, corners: np.ndarray) -> Placed:
    """Dummies of the sides that do not stand behind the facets of a mesh, where its own do."""
    seen = ~hidden.behind(corners, box.table[:, : corners.shape[2]])
    return Placed(*(own[seen] for own in box))


def _closed(case, points, side: str) -> np.ndarray:
    """Mask of the points in front of which a side holds grains back: all but what lets them out do."""
    return ~_behind(case, points, side, lambda own: own.lets_out)


def _behind(case, points, side: str, meant) -> np.ndarray:
    """Mask of the points in front of which a side is a boundary that is `meant`."""
    owners = _owners(case, points, side)
    return np.isin(owners, [number for number, own in enumerate(case.boundaries.values()) if meant(own)])


def _owners(case, points, side: str) -> np.ndarray:
    """Number (P,) of the boundary that a side is in front of each of the points; -1 where it is none."""
    axis, _ = SIDES[side]
    owners, rank = np.full(len(points), -1), np.zeros(len(points), int)
    for number, boundary in enumerate(case.boundaries.values()):  # a span before a whole side before what is left over
        if boundary.side in (side, None):
            level = 1 if boundary.side is None else 2 if boundary.span is None else 3
            own = _within(points, axis, boundary.span) & (rank < level)
            owners[own], rank[own] = number, level
    return owners


def _within(points, axis: int, span) -> np.ndarray:
    """Mask of the points within a span [m] on the tangential axes; everywhere without one."""
    if span is None:
        return np.ones(len(points), bool)
    spans = span if isinstance(span[0], tuple) else (span,)
    tangential = [a for a in range(points.shape[1]) if a != axis]
    return np.logical_and.reduce(
        [(points[:, a] >= low) & (points[:, a] <= high) for a, (low, high) in zip(tangential, spans)]
    )


def _behind_facets(corners: np.ndarray, whose: np.ndarray, case, slips: bool) -> Placed:
    """Dummies in LAYERS behind facets (F, d, d) [m], which let grains slip or not, and whose (F,) each is."""
    spacing = case.resolution.spacing
    points, normals, facet, part = facets.spread(corners, spacing)
    depth = (np.repeat(np.arange(LAYERS), len(points)) + 0.5) * spacing
    feet, normal, owner = np.tile(points, (LAYERS, 1)), np.tile(normals, (LAYERS, 1)), np.tile(whose[facet], LAYERS)
    found = _placed(feet - depth[:, None] * normal, normal, depth, not slips, owner, feet, spacing)
    found.table[:, -1] *= np.tile(part, LAYERS)
    whole, here = np.bincount(whose, facets.sizes(corners)), np.bincount(whose[facet], part)
    share = part * (whole[: len(here)] / np.where(here > 0.0, here, 1.0))[whose[facet]]
    # all that is a patch's; what patches too small for a point have is everybody's
    found.area[: len(points)] = share * (whole.sum() / share.sum())
    for number, boundary in enumerate(case.boundaries.values()):
        if boundary.kind == "wall" and boundary.velocity:  # it slides along each of its facets
            own, velocity = owner == OWNED + number, np.array(boundary.velocity[: case.dimensions])
            along = velocity - (normal[own] @ velocity)[:, None] * normal[own]
            found.table[own, 8 : 8 + case.dimensions] = along
    return found


def _beyond_facets(corners: np.ndarray, whose: np.ndarray, slip: np.ndarray, case) -> Placed:
    """Dummies beyond edges and corners of facets, without a normal, as in those of a box."""
    spacing = case.resolution.spacing
    places, feet, of, part = corners_of_mesh.spread(corners, spacing, LAYERS * spacing)
    facing = np.zeros((len(of), 3, 3))
    facing[:, :, : case.dimensions] = facets.normals(corners)[of]
    depth, none = np.linalg.norm(feet - places, axis=1), np.zeros_like(places)
    found = _placed(places, none, depth, ~slip[of].all(axis=1), whose[of[:, 0]], feet, spacing)
    found.table[:, -1] *= part
    return found._replace(facing=facing, whose=whose[of])


def _stretched(behind: list[Placed], corners: np.ndarray, case) -> Placed:
    """Dummies behind facets with the volume that is theirs behind a round wall: more in the wall of a pipe, less in a
    tube, nothing where others fill all of their room."""
    found, spacing, d = Placed(*(np.concatenate(own) for own in zip(*behind))), case.resolution.spacing, case.dimensions
    places, feet, _, part = corners_of_mesh.rounded(corners, spacing, LAYERS * spacing)
    if not len(part):
        return found
    away = np.linalg.norm(feet - places, axis=1)
    own, other = (
        np.column_stack((place, spacing * normal, LAYERS * spacing * (depth // spacing)))  # layer by layer
        for place, normal, depth in (
            (found.table[:, :d], found.table[:, 3 : 3 + d], found.table[:, 6]),
            (places, (feet - places) / away[:, None], away),
        )
    )
    nearest = scipy.spatial.cKDTree(own).query(other)[1]
    share = 1.0 + np.bincount(nearest, part, len(own))
    found.table[:, -1] *= np.where(share > 0.0, share, 0.0)
    found.curved[nearest] = True
    if len(edges := corners_of_mesh.outwards(corners, spacing)):
        near = math.sqrt(2.0) * LAYERS * spacing  # what lies behind both faces of an edge
        found.curved[scipy.spatial.cKDTree(edges).query(found.table[:, :d])[0] < near] = False
    return found


def _placed(places, normal, depth, grips, owner, feet, spacing: float) -> Placed:
    """Dummies of a mesh at rest, in the dimensions of the case, each of spacing^d."""
    d, count = places.shape[1], len(places)
    table, own = np.zeros((count, len(Dummies._fields))), np.zeros((count, 3))
    table[:, -1] = spacing**d
    table[:, :d], table[:, 3 : 3 + d], table[:, 6], table[:, 7], own[:, :d] = places, normal, depth, grips, feet
    whose = np.repeat(owner[:, None], 3, axis=1)
    return Placed(table, np.zeros(count), whose, own, np.zeros((count, 3, 3)), np.zeros(count, bool))
