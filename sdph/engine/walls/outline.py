"""Tank in the plane whose wall goes from corner to corner: rooms, ramps, baffles as notches of the wall."""

from __future__ import annotations

import functools
import itertools
import math
from dataclasses import dataclass

import numpy as np

from sdph.engine import polygons
from sdph.engine.walls.facets import OPPOSITE
from sdph.schema import CaseError

FINE = 64  # samples a spacing, by which a layer of wall ends where another wall begins; our choice
ROUND_OFF = 1e-6  # share of a spacing: our choice


@dataclass(frozen=True)
class Outline:
    """Inside of a polygon with `corners` (C, 2) [m] counterclockwise, that does not cross itself; a shape as of
    sdph.engine.walls.shapes. The sides after the corners that are `open` (C,) have no wall."""

    corners: np.ndarray
    open: np.ndarray

    @functools.cached_property
    def along(self):
        """(C, 2) [m] from each corner to the next."""
        return np.roll(self.corners, -1, axis=0) - self.corners

    @functools.cached_property
    def outwards(self):
        """(C, 2) of length 1, at right angles to each side."""
        return np.stack([self.along[:, 1], -self.along[:, 0]], axis=1) / np.linalg.norm(self.along, axis=1)[:, None]

    def lies_at(self, axis: int, place: float):
        """(C,) bool: the sides both of whose corners lie at a place [m] of an axis."""
        here = np.isclose(self.corners[:, axis], place)
        return here & np.roll(here, -1)

    def nearest(self, points):
        """Distance [m] of points (N, 2) from the wall, and the number of the side that is nearest, (N,) each."""
        sides = []
        for corner, way in zip(self.corners, self.along):
            share = np.clip((points - corner) @ way / (way @ way), 0.0, 1.0)
            sides.append(np.linalg.norm(points - corner - share[:, None] * way, axis=1))
        return np.min(sides, axis=0), np.argmin(sides, axis=0)

    def distance(self, points):
        inside = polygons.holds(*self.corners.T.copy(), *points.T.copy())
        return np.where(inside, -1.0, 1.0) * self.nearest(points)[0]

    def shell(self, depth, spacing):
        """Points `depth` behind the sides and around the corners that stand out, where no other wall is nearer; evenly
        along each, a spacing apart."""
        fine, found = spacing / FINE, []
        for place, length in self._behind(depth):
            middles = (np.arange(max(1, round(length / fine))) + 0.5) * length / max(1, round(length / fine))
            free = self.distance(place(middles)) > depth * (1.0 - ROUND_OFF)
            for kept, run in itertools.groupby(zip(free, middles), key=lambda each: each[0]):
                if kept:
                    found.append(place(_evenly([middle for _, middle in run], length / len(middles), spacing)))
        return np.concatenate(found)

    def strewn(self, spacing):
        """Places (S, 2) [m] evenly along each side that has a wall, about a spacing apart, the normals there outwards,
        and the length (S,) [m] of each."""
        places, normals, each = [], [], []
        for corner, way, out, gone in zip(self.corners, self.along, self.outwards, self.open):
            length = math.hypot(*way)
            count = 0 if gone else max(1, round(length / spacing))
            places.append(corner + (np.arange(count)[:, None] + 0.5) / max(1, count) * way)
            normals.append(np.tile(out, (count, 1)))
            each.append(np.full(count, length / max(1, count)))
        return np.concatenate(places), np.concatenate(normals), np.concatenate(each)

    def _behind(self, depth):
        """The lines `depth` behind the wall, side by side: (function of ways (N,) [m] along it to points, its
        length)."""
        turned, last = np.roll(self.outwards, -1, axis=0), np.roll(self.open, -1)
        for corner, way, out, after, gone, ends in zip(
            self.corners, self.along, self.outwards, turned, self.open, last
        ):
            if gone:
                continue
            length = math.hypot(*way)
            yield lambda s, c=corner + depth * out, w=way / length: c + s[:, None] * w, length
            turn = math.atan2(out[0] * after[1] - out[1] * after[0], out @ after)
            if turn > 0.0 and not ends:
                start = math.atan2(out[1], out[0])
                yield lambda s, c=corner + way, a=start: c + depth * _unit(a + s / depth), depth * turn

    def thin(self, spacing):
        """Places (P, 2) [m] of the wall behind which it comes back within two spacings, as of `shapes.Mesh`."""
        found = []
        for k, (corner, way) in enumerate(zip(self.corners, self.along)):
            count = max(1, round(math.hypot(*way) / spacing))
            places = corner + (np.arange(count)[:, None] + 0.5) / count * way
            far, side = self.nearest(places + spacing * self.outwards[k])
            facing = self.outwards[side] @ self.outwards[k]
            found.append(places[(far < (1.0 - ROUND_OFF) * spacing) & (facing < OPPOSITE)])
        return np.concatenate(found)

    def surface(self):
        import pyvista

        points, first = np.pad(self.corners, ((0, 0), (0, 1))), np.flatnonzero(~self.open)
        lines = np.stack([np.full(len(first), 2), first, (first + 1) % len(points)], axis=1)
        return pyvista.PolyData(points, lines=lines.ravel())

    def furthest(self, direction):
        return float((self.corners @ direction).max())

    @property
    def volume(self):
        return polygons.area(*self.corners.T)


def outline(key: str, corners, open_at=()) -> Outline:
    """The outline with these corners, however they go around, without a wall where both corners of a side lie at one of
    the places `open_at`, (axis, [m]) each; CaseError, which names the `key`, for what is none."""
    if len(corners) < 3 or not all(isinstance(each, tuple) and len(each) == 2 for each in corners):
        raise CaseError(f"{key} = {list(corners)}; give the corners one after the other, [[x, y], ...], 3 at least")
    places = np.array(corners)
    if polygons.area(*places.T) < 0.0:
        places = places[::-1]
    count = len(places)
    for i, j in itertools.combinations(range(count), 2):
        a, b, c, d = (places[k % count] for k in (i, i + 1, j, j + 1))
        if (a == b).all() or (c == d).all() or (j - i not in (1, count - 1) and _meet(a, b, c, d)):
            raise CaseError(
                f"{key}: the side from {a.tolist()} to {b.tolist()} has no length or meets that from {c.tolist()} to "
                f"{d.tolist()}; give corners one after the other, around what it holds, each once"
            )
    whole = Outline(places, np.zeros(count, bool))
    return Outline(places, np.any([whole.open, *(whole.lies_at(*at) for at in open_at)], axis=0))


def _meet(a, b, c, d) -> bool:
    """True where segments ab and cd have a place in common."""
    if (np.maximum(a, b) < np.minimum(c, d)).any() or (np.maximum(c, d) < np.minimum(a, b)).any():
        return False
    return _turn(a, b, c) * _turn(a, b, d) <= 0.0 and _turn(c, d, a) * _turn(c, d, b) <= 0.0


def _turn(a, b, c) -> float:
    """Twice the area of a triangle, below 0 where it turns clockwise."""
    return float((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))


def _unit(angle):
    """(N, 2) of angles (N,) [rad]."""
    return np.stack([np.cos(angle), np.sin(angle)], axis=1)


def _evenly(middles, fine: float, spacing: float):
    """Ways [m] of points evenly over a run of samples `fine` apart, as many as spacings fit."""
    first, length = middles[0] - 0.5 * fine, len(middles) * fine
    count = round(length / spacing)
    return first + (np.arange(count) + 0.5) * length / max(1, count)
