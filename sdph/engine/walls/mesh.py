"""Sides of a mesh that particles stand on: thin walls part the grains on their two sides from each other, and what lies
behind two facets at an edge is there once.

A mesh closes off what lies behind it, so that of a plate thinner than the kernel's reach both faces are near every
particle. Rows of neighbours are cleared of what a particle cannot meet when they are built; no kernel asks again.
Contact has put every particle in front of its surface by then, a quarter of a spacing or more.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import scipy

from sdph.engine.rows import entry, place, shorten
from sdph.engine.walls.corners import SHARP
from sdph.engine.walls.facets import ORDER
from sdph.laws.compiled import serial
from sdph.laws.constants import SAME

AROUND = 0.75  # spacings about a surface point that count as its own: points stand one spacing apart or closer
EDGE = math.cos(SHARP)
BATCH = 4096  # surface points that are asked at once for those near them, which bounds their lists; our choice
FEET = 16  # of the dummies nearest to one that are asked for a facet beyond an edge; our choice


def three(axes) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """x, y, z of places in two or three dimensions."""
    return (*axes, np.zeros(len(axes[0])))[:3]


@serial
def height(dummies, w, x, y, z):
    """Height [m] of a place over the surface that dummy w is behind."""
    along = (x - dummies.x[w]) * dummies.normal_x[w] + (y - dummies.y[w]) * dummies.normal_y[w]
    return along + (z - dummies.z[w]) * dummies.normal_z[w] - dummies.depth[w]


class Beyond(NamedTuple):
    """Facets beyond the edges of a mesh. Of a dummy behind a facet that beyond an edge which it is behind too:
    normal, and depth [m] behind it (W, 4), 0 where there is none; whether the dummy is nearer to it than to its own
    (W,), and whether the edge is blunt (W,): a facet that is turned against its own is the other face of a thin wall.
    Whether it stands in a corner instead (W,), its nearest place of the surface (W, 3) [m], and the normals (W, 3, 3)
    of the facets that meet there."""

    facet: np.ndarray
    nearer: np.ndarray
    blunt: np.ndarray
    corner: np.ndarray
    feet: np.ndarray
    facing: np.ndarray


def beyond(dummies, first, plain, feet, facing, spacing: float) -> Beyond:
    """The same of all dummies, `first` (W,) those of a mesh's first layer, `plain` (W,) those of a mesh behind a flat
    wall or near an edge, as about a round one volumes are counted once already; `feet` and `facing` as in Beyond. Of
    two facets that are as near, one owns the dummies of both. Round a hollow none is behind two: each stands aside of
    what faces it."""
    found, count = np.zeros((len(dummies.x), 4)), len(dummies.x)
    nearer, blunt, corner = np.zeros(count, bool), np.zeros(count, bool), facing.any(axis=(1, 2))
    own = np.flatnonzero(plain & ~corner)
    places = np.stack((dummies.x, dummies.y, dummies.z), axis=1)[own]
    every = np.stack((dummies.normal_x, dummies.normal_y, dummies.normal_z), axis=1)
    normals, depths, ahead = every[own], dummies.depth[own], every[first]
    nearest = scipy.spatial.cKDTree(feet[first]).query(places, range(1, min(FEET, first.sum()) + 1))[1]
    way = feet[first][nearest] - places[:, None]
    depth = np.einsum("ijk,ijk->ij", way, ahead[nearest])
    turned = np.einsum("ijk,ik->ij", ahead[nearest], normals)
    behind = (way**2).sum(axis=2) - depth**2 <= (AROUND * spacing) ** 2
    there = (turned < EDGE) & (depth > 0.0) & behind
    one = np.arange(len(own)), there.argmax(axis=1)
    normal, depth, there = ahead[nearest][one], depth[one], there[one]
    as_near = np.abs(depth - depths) < SAME * depths
    found[own[there]] = np.column_stack((normal, depth))[there]
    nearer[own] = there & np.where(as_near, normal @ ORDER > normals @ ORDER, depth < depths)
    nearer &= ~_alone(np.stack((dummies.x, dummies.y, dummies.z), axis=1), nearer, AROUND * spacing)
    if not dummies.normal_z.any():  # at a corner of a solid in space three faces meet, and one alone is known here
        blunt[own] = there & (turned[one] >= -EDGE)
    return Beyond(found, nearer, blunt, corner, feet, facing)


def _alone(places, left, reach: float) -> np.ndarray:
    """Mask (W,) of those of the dummies `left` out (W,) in whose place no other one stands within `reach` [m]: two
    faces may leave a place to each other, and then the first of them keeps it."""
    alone = np.zeros(len(left), bool)
    if not left.any() or left.all():
        return alone
    empty = np.flatnonzero(left)
    empty = empty[scipy.spatial.cKDTree(places[~left]).query(places[empty])[0] > reach]
    for n, near in zip(empty, scipy.spatial.cKDTree(places[empty]).query_ball_point(places[empty], reach)):
        alone[n] = not alone[empty[near]].any()
    return alone


@serial
def over(dummies, facet, w, x, y, z):
    """Height [m] of a place over the facet beyond an edge of dummy w."""
    along = (x - dummies.x[w]) * facet[w, 0] + (y - dummies.y[w]) * facet[w, 1]
    return along + (z - dummies.z[w]) * facet[w, 2] - facet[w, 3]


@serial
def within(beyond, w, x, y, z):
    """True where a place is in front of all facets that meet at the corner where dummy w stands."""
    dx, dy, dz = x - beyond.feet[w, 0], y - beyond.feet[w, 1], z - beyond.feet[w, 2]
    facing = beyond.facing[w]
    return ahead(facing[0], dx, dy, dz) and ahead(facing[1], dx, dy, dz) and ahead(facing[2], dx, dy, dz)


@serial
def ahead(normal, dx, dy, dz):
    """True where a way goes to the side of a normal."""
    return dx * normal[0] + dy * normal[1] + dz * normal[2] > 0.0


@serial
def keep_in_front(dummies, of_mesh, beyond, places, rows):
    """Take the dummies of a mesh out of the rows of particles that stand behind its surface, or not in the corner where
    they stand, but for those of a solid whose other face, beyond a blunt edge, the particles are in front of."""
    x, y, z = places
    for i in range(len(x)):
        kept = 0
        for k in range(rows.number[i]):
            w = entry(rows, i, k)
            if (
                not of_mesh[w]
                or (beyond.corner[w] and within(beyond, w, x[i], y[i], z[i]))
                or height(dummies, w, x[i], y[i], z[i]) > 0.0
                or (beyond.blunt[w] and not beyond.nearer[w] and over(dummies, beyond.facet, w, x[i], y[i], z[i]) > 0.0)
            ):
                rows.entries[place(rows, i, kept)] = w
                kept += 1
        rows.number[i] = kept


@serial
def count_once(dummies, of_mesh, beyond, places, rows):
    """Order rows: first dummies in corners and those that particles see round a blunt edge, then those in front of
    whose face they are, and behind the end those of the latter that are nearer to another face, whose own dummies stand
    there. So sums count what lies behind an edge once, by the same dummies from both sides of it, and contact asks for
    the last two.
    Returns how many each row has before those in front, and how many all are (N,)."""
    x, y, z = places
    before, every = np.zeros(len(x), rows.number.dtype), rows.number.copy()
    for i in range(len(x)):
        k = 0
        while k < rows.number[i]:
            here = place(rows, i, k)
            w = rows.entries[here]
            if of_mesh[w] and height(dummies, w, x[i], y[i], z[i]) <= 0.0:
                other = place(rows, i, before[i])
                before[i] += 1
                k += 1
            elif beyond.nearer[w] and (beyond.blunt[w] or over(dummies, beyond.facet, w, x[i], y[i], z[i]) > 0.0):
                rows.number[i] -= 1
                other = place(rows, i, rows.number[i])
            else:
                k += 1
                continue
            rows.entries[here], rows.entries[other] = rows.entries[other], w
    return before, every


def faced(dummies, of_mesh, spacing: float, reach: float) -> np.ndarray:
    """Mask (W,) of the surface points that one which is turned against them is within `reach` [m] of: where there are
    none a way goes in through no face and out through another."""
    first = np.flatnonzero(of_mesh & (dummies.depth <= spacing))
    places, normals = (
        np.stack([getattr(dummies, name)[first] for name in names], axis=1)
        for names in (("x", "y", "z"), ("normal_x", "normal_y", "normal_z"))
    )
    found, tree = np.zeros(len(dummies.x), bool), scipy.spatial.cKDTree(places)
    for begin in range(0, len(first), BATCH):
        near = tree.query_ball_point(places[begin : begin + BATCH], reach)
        own, other = np.repeat(begin + np.arange(len(near)), [len(one) for one in near]), np.concatenate(near)
        found[first[own[np.einsum("ij,ij->i", normals[own], normals[other.astype(int)]) < -EDGE]]] = True
    return found


@serial
def part(dummies, of_mesh, faced, spacing, places, wall_rows, rows):
    """Take the neighbours out of the particles' rows that stand on the other side of a thin wall. A way that is shorter
    than what lies between either end and the planes before it goes through none of them, and one between particles
    that see a wall, but none that others face (`faced`), goes through no thin one."""
    x, y, z = places
    clear = clearances(dummies, of_mesh, spacing, places, wall_rows)
    single = seen_alone(dummies, of_mesh, faced, spacing, places, wall_rows)
    for i in range(len(x)):
        kept = 0
        for k in range(rows.number[i]):
            j = entry(rows, i, k)
            way = (x[j] - x[i]) ** 2 + (y[j] - y[i]) ** 2 + (z[j] - z[i]) ** 2
            through = (way >= clear[i] ** 2 or way >= clear[j] ** 2) and not (single[i] and single[j])
            if not (through and parted(dummies, of_mesh, spacing, places, wall_rows, i, j)):
                rows.entries[place(rows, i, kept)] = j
                kept += 1
        shorten(rows, i, kept)


@serial
def clearances(dummies, of_mesh, spacing, places, wall_rows):
    """Height (N,) [m] of each particle over the nearest plane of a surface point that it is in front of; inf: none."""
    x, y, z = places
    found = np.full(len(x), math.inf)
    for i in range(len(x)):
        for k in range(wall_rows.number[i]):
            w = entry(wall_rows, i, k)
            if of_mesh[w] and dummies.depth[w] <= spacing:
                over = height(dummies, w, x[i], y[i], z[i])
                if 0.0 < over < found[i]:
                    found[i] = over
    return found


@serial
def seen_alone(dummies, of_mesh, faced, spacing, places, wall_rows):
    """Mask (N,) of the particles that see a surface point which they are in front of, and none that others face."""
    x, y, z = places
    found = np.zeros(len(x), np.bool_)
    for i in range(len(x)):
        sees, alone = False, True
        for k in range(wall_rows.number[i]):
            w = entry(wall_rows, i, k)
            if of_mesh[w] and dummies.depth[w] <= spacing:
                alone = alone and not faced[w]
                sees = sees or height(dummies, w, x[i], y[i], z[i]) > 0.0
        found[i] = sees and alone
    return found


@serial
def parted(dummies, of_mesh, spacing, places, wall_rows, i, j):
    """True where the way between two particles goes in through one face of a wall and out through another that is
    turned against it. Round a blunt edge they meet: what lies between them there is the wall's own, and to part them
    would leave a gap in the sums of both, which closes at once when one of them has come round."""
    a = crossed(dummies, of_mesh, spacing, places, wall_rows, i, j)
    b = crossed(dummies, of_mesh, spacing, places, wall_rows, j, i)
    if a < 0 and b < 0:
        return False
    if a < 0:
        a = nearest_point(dummies, of_mesh, spacing, places, wall_rows, i)
    if b < 0:
        b = nearest_point(dummies, of_mesh, spacing, places, wall_rows, j)
    if a < 0 or b < 0:
        return True
    facing = dummies.normal_x[a] * dummies.normal_x[b] + dummies.normal_y[a] * dummies.normal_y[b]
    return facing + dummies.normal_z[a] * dummies.normal_z[b] < -EDGE


@serial
def crossed(dummies, of_mesh, spacing, places, wall_rows, i, j):
    """The surface point, by its dummy, that the way from i, in front of it, to j, behind it, goes through; -1: none."""
    x, y, z = places
    found, nearest = -1, (AROUND * spacing) ** 2
    for k in range(wall_rows.number[i]):
        w = entry(wall_rows, i, k)
        if not of_mesh[w] or dummies.depth[w] > spacing:  # the first layer alone: it stands for the surface
            continue
        over, behind = height(dummies, w, x[i], y[i], z[i]), height(dummies, w, x[j], y[j], z[j])
        if over <= 0.0 or behind >= 0.0:
            continue
        share = over / (over - behind)
        way = x[i] + share * (x[j] - x[i]), y[i] + share * (y[j] - y[i]), z[i] + share * (z[j] - z[i])
        off = aside(dummies, w, way[0], way[1], way[2])
        if off <= nearest:
            found, nearest = w, off
    return found


@serial
def nearest_point(dummies, of_mesh, spacing, places, wall_rows, i):
    """The nearest surface point, by its dummy, that particle i is in front of; -1: it sees none."""
    x, y, z = places
    found, nearest = -1, math.inf
    for k in range(wall_rows.number[i]):
        w = entry(wall_rows, i, k)
        if of_mesh[w] and dummies.depth[w] <= spacing and height(dummies, w, x[i], y[i], z[i]) > 0.0:
            off = aside(dummies, w, x[i], y[i], z[i])
            if off < nearest:
                found, nearest = w, off
    return found


@serial
def aside(dummies, w, x, y, z):
    """Square of the distance [m2] of a place from the surface point of dummy w."""
    depth = dummies.depth[w]
    dx = x - dummies.x[w] - depth * dummies.normal_x[w]
    dy = y - dummies.y[w] - depth * dummies.normal_y[w]
    dz = z - dummies.z[w] - depth * dummies.normal_z[w]
    return dx * dx + dy * dy + dz * dz
