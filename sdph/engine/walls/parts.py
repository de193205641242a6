"""Named parts of walls: which share of the force on each of their particles is theirs, and what has pushed them.

A corner of a box is a part of the sides that meet there: each has of its force what is along its own normal, and an
equal share of what is along the edge. In a corner of a mesh each facet has a share by the squares of its normal. So
all of them together have all of the force, once.
"""

from __future__ import annotations

import itertools

import numpy as np

from sdph.engine.geometry import SIDES


def sides(points: np.ndarray, low, high) -> dict[str, np.ndarray]:
    """Share (P, 3) of each side of a box, from `low` to `high` (d,) [m], in a force on points (P, d) [m], by its
    components; 0 of points that it is not in front of."""
    outside = np.stack([points < low, points > high], axis=-1)  # (P, d, end)
    behind = outside.any(axis=-1)
    along = np.where(behind, 0.0, 1.0 / np.maximum(behind.sum(axis=1, keepdims=True), 1))
    found = {}
    for side, (axis, end) in itertools.islice(SIDES.items(), 2 * points.shape[1]):
        share = np.zeros((len(points), 3))
        share[:, : points.shape[1]] = along
        share[:, axis] = 1.0
        found[side] = share * outside[:, axis, end, None]
    return found


def of_facets(own: np.ndarray, facing: np.ndarray) -> np.ndarray:
    """Share (P, 3), by components, in a force on points P of those of their three facets that are `own` (P, 3).
    Facets share by the squares of their normals `facing` (P, 3, 3), and alike where none has that component. At an edge
    the third facet is the second again and counts once; away from corners all normals are 0."""
    counts = np.ones((len(facing), 3, 1))
    counts[(facing[:, 1] == facing[:, 2]).all(axis=1), 2] = 0.0
    square = counts * facing**2
    whole = square.sum(axis=1, keepdims=True)
    alike = np.repeat(counts / counts.sum(axis=1, keepdims=True), 3, axis=2)
    weight = np.divide(square, whole, out=alike, where=whole > 1e-12)  # of 1; round-off
    return np.einsum("ij,ijk->ik", own, weight)


def within(part, places: np.ndarray, room: float) -> np.ndarray:
    """(P,) bool: which of `places` (P, d) [m] a part of a case holds, its box wider by `room` [m]."""
    return ((places >= np.array(part.lower) - room) & (places <= np.array(part.upper) + room)).all(axis=1)


def gathered(at: np.ndarray, pressed: np.ndarray, there: np.ndarray, rubbed: np.ndarray) -> np.ndarray:
    """(n, 3, 3) of n parts: what presses them, forces (n, P, 3) [N] `at` (P, 3) [m], what rubs them, (n, W, 3) `there`
    (W, 3), and the moment of both about the origin [N m]; of impulses [N s] and [N m s]."""
    moments = np.cross(at, pressed).sum(axis=1) + np.cross(there, rubbed).sum(axis=1)
    return np.stack([pressed.sum(axis=1), rubbed.sum(axis=1), moments], axis=1)


def told(name: str, matter: str, rubs: str, force: np.ndarray, dimensions: int) -> dict[str, float]:
    """Columns of the force of a matter on a part: (3, 3) as of `gathered`; `rubs` is what its second row is of."""
    found, axes = {}, "xyz"[:dimensions]
    for kind, own in zip(("pressure", rubs), force):
        found |= {f"{name}_{matter}_{kind}_force_{a}_N": float(value) for a, value in zip(axes, own)}
    about = zip("xyz", force[2]) if dimensions == 3 else [("z", force[2][2])]
    return found | {f"{name}_{matter}_moment_{a}_Nm": float(value) for a, value in about}


def counts(begun: float, end: float, start: float) -> bool:
    """Tell whether a window counts for means since `start` [s], at which a window ends but for round-off."""
    return begun + end >= 2.0 * start


class Pushed:
    """Impulses [N s] of a matter on named parts, and their moments about the origin [N m s]: since the last row of the
    history, and since the time `start` [s]; per metre of depth in two dimensions."""

    KEPT = ("sums", "times")  # see sdph.engine.kept

    def __init__(self, matter: str, rubs: str, names, dimensions: int, start: float = 0.0):
        self.matter, self.rubs, self.names, self.dimensions = matter, rubs, tuple(names), dimensions
        self.start = start
        self.sums, self.times = np.zeros((2, len(self.names), 3, 3)), np.zeros(2)  # times [s]

    def new_row(self) -> None:
        """Begin anew: the history has a row of now."""
        self.sums[0], self.times[0] = 0.0, 0.0

    def add(self, given: np.ndarray, begun: float, end: float) -> None:
        """Take what the time from `begun` to `end` [s] brought, (n, 3, 3) as of `gathered`."""
        counted = 2 if counts(begun, end, self.start) else 1
        self.sums[:counted] += given
        self.times[:counted] += end - begun

    def row(self) -> dict[str, float]:
        """Means since the last row by column; nan of no time."""
        return self._means(0)

    def summary(self) -> dict[str, float]:
        """Means since the time from which they are taken."""
        return {f"mean_{key}": value for key, value in self._means(1).items()}

    def _means(self, since: int) -> dict[str, float]:
        time = self.times[since] or np.nan
        found = {}
        for name, own in zip(self.names, self.sums[since]):
            found |= told(name, self.matter, self.rubs, own / time, self.dimensions)
        return found
