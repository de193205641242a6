"""Contact with a polyline in the plane: particles nearer to a chain of segments than a distance are pushed off it.

    F = k (a - r) n       r < a the distance to the nearest place of the chain, n from there to the particle
    -(1 - t) F and -t F   on the ends of the segment, t the share of the way from its first end at which the place lies

Ends are particles of a body: what lies between them, however far they part, lets nothing through. -F acts where F does
(the lever rule), so that momentum and angular momentum close, and F is what the energy k (a - r)^2/2 falls by: it comes
back. The distance is that to the whole chain, so that a particle before two segments is pushed once.
"""

from __future__ import annotations

import math

import numpy as np
import scipy

from sdph.laws.compiled import inlined, serial


def near(points, first, second, reach: float) -> np.ndarray:
    """Pairs (P, 2) of points (N, 2) [m] and segments from `first` to `second` (S, 2) [m] nearer than `reach` [m],
    sorted."""
    if not len(points) or not len(first):
        return np.zeros((0, 2), np.int64)
    along = second - first
    half = 0.5 * float(np.hypot(*along.T).max())
    found = scipy.spatial.cKDTree(points).query_ball_point(first + 0.5 * along, reach + half)
    segment = np.repeat(np.arange(len(first)), [len(own) for own in found])
    point = np.concatenate(found).astype(np.int64)
    own, way = points[point] - first[segment], along[segment]
    share = np.clip((own * way).sum(axis=1) / np.maximum((way**2).sum(axis=1), np.finfo(float).tiny), 0.0, 1.0)
    touches = np.hypot(*(own - share[:, None] * way).T) < reach
    pairs = np.stack([point, segment], axis=1)[touches]
    return pairs[np.lexsort(pairs.T[::-1])]


@inlined
def foot(x, y, i, a, b):
    """Way (2 values) [m] to particle i from the nearest place of the segment from a to b, share of the way there."""
    along_x, along_y = x[b] - x[a], y[b] - y[a]
    dx, dy = x[i] - x[a], y[i] - y[a]
    length2 = along_x * along_x + along_y * along_y
    share = (dx * along_x + dy * along_y) / length2 if length2 > 0.0 else 0.0
    share = 0.0 if share < 0.0 else (1.0 if share > 1.0 else share)
    return dx - share * along_x, dy - share * along_y, share


@serial
def press(stiffness, distance, x, y, segments, bears, pairs, force):
    """Add to force (N, 3) [N] on all particles; energy [J] of the springs.

    segments (S, 2) particles at the ends; bears (S,) bool: others give no reaction; pairs (P, 2) of a particle and a
    segment that may touch, sorted. What lies on a segment is pushed to its left, inwards of a counterclockwise chain.
    """
    energy, n = 0.0, 0
    while n < len(pairs):
        i, hit, nearest, dx, dy, share = pairs[n, 0], -1, distance, 0.0, 0.0, 0.0
        while n < len(pairs) and pairs[n, 0] == i:
            s = pairs[n, 1]
            if bears[s]:
                own_x, own_y, own_share = foot(x, y, i, segments[s, 0], segments[s, 1])
                r = math.sqrt(own_x * own_x + own_y * own_y)
                if r < nearest:
                    hit, nearest, dx, dy, share = s, r, own_x, own_y, own_share
            n += 1
        if hit < 0:
            continue
        a, b = segments[hit]
        if nearest == 0.0:
            dx, dy = y[a] - y[b], x[b] - x[a]
        size = stiffness * (distance - nearest) / math.sqrt(dx * dx + dy * dy)
        energy += 0.5 * stiffness * (distance - nearest) ** 2
        for axis, push in ((0, size * dx), (1, size * dy)):
            force[i, axis] += push
            force[a, axis] -= (1.0 - share) * push
            force[b, axis] -= share * push
    return energy
