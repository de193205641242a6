"""Points beyond the hollow edges and corners where walls of a mesh meet, behind no facet: one spacing apart, as those
behind facets are; and what layers behind a round wall are longer or shorter than the wall itself.

They fill the part of space whose nearest point of the surface lies on that edge or corner (its normal cone): a wedge
beyond an edge, from the normal of one facet to that of the other, and beyond a corner what lies between the wedges of
its edges. A round wall of small facets has a narrow one at each, too narrow for points of their own: a share of those
behind the facets. About a tube what lies behind two facets is taken from them.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import scipy

from sdph.engine.walls import facets
from sdph.engine.walls.surface_points import SAMPLES, middles

# rad of turn from which on facets meet at an edge, and below go on as a round wall; a little beyond the 45 degrees of
# octagons and chamfers, whose edges are then all alike; our choice
SHARP = math.radians(46.0)
FLAT = 1e-3  # rad between facets that go on as one: 0.004 of a spacing is lacking three layers behind; our choice
NEARER = 1e-3  # of a distance from the surface: that of a mesh from VTK is as exact; our choice


class Ridges(NamedTuple):
    """Sides where two facets meet: the edge (R, d - 1, d) [m], a point in two dimensions, and the numbers of its ends
    (R, d - 1); the facets (R, 2) whose side it is; the direction (R, d) from it along the first; and the angle (R,)
    [rad] by which they turn, above 0 where grains stand in the hollow between them."""

    edge: np.ndarray
    ends: np.ndarray
    facets: np.ndarray
    along: np.ndarray
    turn: np.ndarray


class Beyond(NamedTuple):
    """Samples of what lies beyond edges and corners: place and its nearest point of the surface (N, d) [m], three
    facets (N, 3) that meet there, one of them twice at an edge, and the part (N,) of a spacing^d that each is, below 0
    where two facets count it."""

    place: np.ndarray
    foot: np.ndarray
    facets: np.ndarray
    part: np.ndarray

    def those(self, rows) -> Beyond:
        """The samples of these rows."""
        return Beyond(*(own[np.asarray(rows, int)] for own in self))


def spread(corners: np.ndarray, spacing: float, reach: float) -> Beyond:
    """Points beyond the sharp edges and corners of facets (F, d, d) [m], nearer than `reach` [m]: one for each
    spacing^d."""
    found = _samples(corners, spacing, reach, True)
    found = found.those(_alone(found, facets.Surface(corners)))
    middle, nearest, share = middles(found.place)
    return Beyond(middle, found.foot[nearest], found.facets[nearest], share)


def rounded(corners: np.ndarray, spacing: float, reach: float) -> Beyond:
    """Samples of what layers behind the round parts of facets (F, d, d) [m] have more or less than the wall, nearer
    than `reach` [m]."""
    return _samples(corners, spacing, reach, False)


def outwards(corners: np.ndarray, spacing: float) -> np.ndarray:
    """Places (N, d) [m], a spacing apart or less, along the sharp edges of facets (F, d, d) [m] that point at the
    grains."""
    ridges = _ridges(corners, facets.normals(corners), facets.numbered(corners))
    edge = ridges.edge[ridges.turn < -SHARP]
    count = 1 + np.ceil(np.linalg.norm(edge[:, -1] - edge[:, 0], axis=1) / spacing).astype(int)
    of = np.repeat(np.arange(len(edge)), count)
    share = (np.arange(len(of)) - (np.cumsum(count) - count)[of]) / np.where(count > 1, count - 1, 1)[of]
    return edge[of, 0] + share[:, None] * (edge[of, -1] - edge[of, 0])


def _samples(corners: np.ndarray, spacing: float, reach: float, sharp: bool) -> Beyond:
    """Samples beyond edges and corners that are sharp, or of those that are not."""
    normal, point = facets.normals(corners), facets.numbered(corners)
    ridges = _ridges(corners, normal, point)
    parts = [_beyond_edges(ridges, normal, spacing, reach, sharp)]
    if corners.shape[2] == 3:
        parts.append(_beyond_corners(corners, normal, point, ridges, spacing, reach, sharp))
    return Beyond(*(np.concatenate(own) for own in zip(*parts)))


def _alone(found: Beyond, surface) -> np.ndarray:
    """Rows of samples that are not nearer to another facet, whose own points stand there."""
    if not len(found.place):
        return np.zeros(0, int)
    off, away = surface.distance(found.place), np.linalg.norm(found.place - found.foot, axis=1)
    return np.flatnonzero((off > 0.0) | (-off > (1.0 - NEARER) * away))


def _ridges(corners, normal, point) -> Ridges:
    """Each facet with the one that is next to it, in front, along each of its sides; `point` (F, d): numbers of the
    corners."""
    d = corners.shape[2]
    facet = np.repeat(np.arange(len(corners)), d)
    if d == 2:  # a line begins at one point and ends at the other
        ends, ahead = point.reshape(-1, 1), np.tile([True, False], len(corners))
        edge = corners.reshape(-1, 1, 2)
        along = (np.roll(corners, 1, axis=1) - corners).reshape(-1, 2)
    else:
        ends = np.stack((point, np.roll(point, -1, axis=1)), axis=2).reshape(-1, 2)
        ahead, ends = ends[:, 0] < ends[:, 1], np.sort(ends, axis=1)
        edge = np.stack((corners, np.roll(corners, -1, axis=1)), axis=2).reshape(-1, 2, 3)
        along = np.cross(normal[facet], edge[:, 1] - edge[:, 0])
    along = along / np.linalg.norm(along, axis=1)[:, None]
    one, other = _met(ends @ (point.max() + 1) ** np.arange(d - 1), ahead)
    up = np.einsum("ij,ij->i", along[other], normal[facet[one]])
    angle = np.arctan2(up, np.einsum("ij,ij->i", along[other], along[one])) % (2.0 * math.pi)
    angle[angle < FLAT] += 2.0 * math.pi  # the rim of a sheet: grains stand all about it
    order = np.lexsort((angle, one))
    order = order[np.unique(one[order], return_index=True)[1]]  # of several sheets that meet, the next in front
    one, other = one[order], other[order]
    return Ridges(
        edge[one], ends[one], np.stack((facet[one], facet[other]), axis=1), along[one], math.pi - angle[order]
    )


def _met(key, ahead) -> tuple[np.ndarray, np.ndarray]:
    """All pairs of sides of one key (S,), the first of them walked ahead and the other one back."""
    back = np.flatnonzero(~ahead)
    back = back[np.argsort(key[back], kind="stable")]
    first = np.flatnonzero(ahead)
    begin, end = (np.searchsorted(key[back], key[first], side) for side in ("left", "right"))
    one = np.repeat(first, end - begin)
    rank = np.arange(len(one)) - np.repeat(np.cumsum(end - begin) - (end - begin), end - begin)
    return one, back[np.repeat(begin, end - begin) + rank]


def _beyond_edges(ridges: Ridges, normal, spacing: float, reach: float, sharp: bool) -> Beyond:
    """Samples of the wedges beyond edges, hollow ones where they are sharp."""
    d, size = normal.shape[1], np.abs(ridges.turn)
    own = Ridges(*(column[ridges.turn > SHARP if sharp else (size > FLAT) & (size <= SHARP)] for column in ridges))
    length = np.linalg.norm(own.edge[:, -1] - own.edge[:, 0], axis=1) if d == 3 else np.ones(len(own.turn))
    of, share = _drawn(0.5 * reach**2 * np.abs(own.turn) * length / spacing**d, d)
    one, other = own.facets[of].T
    turn = (own.turn[of] * share[:, 0])[:, None]
    away = reach * np.sqrt(share[:, 1:2]) * (np.cos(turn) * normal[one] + np.sin(turn) * own.along[of])
    foot = own.edge[of, 0] + share[:, -1:] * (own.edge[of, -1] - own.edge[of, 0])
    return Beyond(foot - away, foot, np.stack((one, other, other), axis=1), np.sign(own.turn[of]) / SAMPLES)


def _beyond_corners(corners, normal, point, ridges: Ridges, spacing: float, reach: float, sharp: bool) -> Beyond:
    """Samples of what lies beyond corners, triangle by triangle of the sphere of directions: each from the
    middle of the normals that meet there to two of them that are next to each other."""
    place = np.zeros((point.max() + 1, 3))
    place[point] = corners
    own, facet = _meeting(normal, point, _whole(point, ridges) & _alike(normal, point, ridges, sharp))
    middle = np.zeros_like(place)
    np.add.at(middle, own, normal[facet])
    middle = middle[own]
    middle /= np.linalg.norm(middle, axis=1)[:, None]
    axis = np.eye(3)[np.abs(middle).argmin(axis=1)]
    east = np.cross(middle, axis)
    north = np.cross(middle, east)
    around = np.arctan2(np.einsum("ij,ij->i", normal[facet], north), np.einsum("ij,ij->i", normal[facet], east))
    order = np.lexsort((around, own))
    own, facet, middle = own[order], facet[order], middle[order]
    second = _followers(own)
    a, b = normal[facet], normal[facet[second]]
    high = np.abs(np.einsum("ij,ij->i", middle, np.cross(a, b)))
    wide = 1.0 + np.einsum("ij,ij->i", middle, a + b) + np.einsum("ij,ij->i", a, b)
    solid_angle = 2.0 * np.arctan2(high, wide)  # Van Oosterom & Strackee 1983, IEEE Trans. Biomed. Eng. 30, 125
    of, share = _drawn(solid_angle * reach**3 / 3.0 / spacing**3, 3)
    side, along = np.sqrt(share[:, :1]), share[:, 1:2]
    way = (1.0 - side) * middle[of] + side * ((1.0 - along) * a[of] + along * b[of])
    away = reach * np.cbrt(share[:, 2:]) * way / np.linalg.norm(way, axis=1)[:, None]
    foot = place[own[of]]
    there = facet[np.stack((of, second[of], second[second[of]]), axis=1)]
    return Beyond(foot - away, foot, there, np.full(len(of), 1.0 / SAMPLES))


def _whole(point, ridges: Ridges) -> np.ndarray:
    """Mask (P,) of the corners at which no facet ends."""
    sides = np.unique(np.sort(np.stack((point, np.roll(point, -1, axis=1)), axis=2).reshape(-1, 2), axis=1), axis=0)
    size = point.max() + 1
    return np.bincount(sides.ravel(), minlength=size) == np.bincount(ridges.ends.ravel(), minlength=size)


def _alike(normal, point, ridges: Ridges, sharp: bool) -> np.ndarray:
    """Mask (P,) of hollow corners with a sharp edge, or pointed as the tip of a cone; or of the others that are hollow
    or stand out all around: a saddle has next to nothing beyond it."""
    size = point.max() + 1
    hollow, out, steep = (
        np.bincount(ridges.ends[mask].ravel(), minlength=size) > 0
        for mask in (ridges.turn > FLAT, ridges.turn < -FLAT, np.abs(ridges.turn) > SHARP)
    )
    middle = np.zeros((size, 3))
    np.add.at(middle, point.ravel(), np.repeat(normal, 3, axis=0))
    along, length = np.einsum("ijk,ik->ij", middle[point], normal), np.linalg.norm(middle[point], axis=2)
    pointed = np.bincount(point[along < math.cos(0.5 * SHARP) * length], minlength=size) > 0
    steep |= pointed & hollow & ~out
    return steep & ~out if sharp else ~steep & ~(hollow & out)


def _meeting(normal, point, chosen) -> tuple[np.ndarray, np.ndarray]:
    """Corners `chosen` (P,), and the facets that meet there: one row for each of them and each normal, in order of
    corners."""
    of_facet, known = np.repeat(np.arange(len(point)), 3), point.ravel()
    known, of_facet = known[chosen[known]], of_facet[chosen[known]]
    rows = np.column_stack((known, np.round(normal[of_facet] / FLAT)))
    _, first = np.unique(rows, axis=0, return_index=True)
    known, of_facet = known[first], of_facet[first]
    several = np.bincount(known, minlength=len(chosen))[known] >= 3
    return known[several], of_facet[several]


def _followers(own) -> np.ndarray:
    """The next row of each in its group, of rows in groups of one number (N,); of the last one the first."""
    follower = np.arange(1, len(own) + 1)
    begin = np.flatnonzero(np.diff(own, prepend=-1))
    follower[np.append(begin[1:], len(own))[: len(begin)] - 1] = begin
    return follower


def _drawn(volumes, dimensions: int) -> tuple[np.ndarray, np.ndarray]:
    """Parts, of these volumes (P,) in spacings^d, that samples (N,) are of, and evenly spread shares (N, d) in [0, 1)
    of each: SAMPLES to a spacing^d of all together."""
    ends = np.cumsum(volumes)
    count = round(SAMPLES * ends[-1]) if len(ends) else 0
    of = np.searchsorted(ends, (np.arange(count) + 0.5) * (ends[-1] / count), side="right") if count else []
    even = scipy.stats.qmc.Halton(dimensions, scramble=False).random(count + 1)[1:]  # 0 is first
    return np.minimum(np.array(of, int), max(len(ends) - 1, 0)), even
