"""Points on surfaces: on those about an axis in rings, on any other in the middle of parts that are alike in size."""

from __future__ import annotations

import math

import numpy as np
import scipy

# places in a unit square that fill it evenly: Roberts 2018, after Korobov; 1/p and 1/p^2 of p^3 = p + 1
EVEN = np.array([0.7548776662466927, 0.5698402909980532])
SAMPLES = 16  # of the surface to a point: parts are then alike to a sixteenth or so; our choice
SETTLINGS = 8  # in which points come to the middle of their parts; 20 and 40 move none further (measured); our choice
GOLDEN = math.pi * (3.0 - math.sqrt(5.0))  # rad, turn from ring to ring, so that rings do not line up


def evened(places, facing, spacing: float) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Points (P, 3) of parts of a surface that are much alike in area, their normals, the nearest sample, and the area
    (P,) of each part over the mean. Normals count as lengths, so that no part goes round an edge or through a plate."""
    points, nearest, share = middles(np.hstack((places, spacing * facing)))
    normal = facing[nearest]
    off = np.einsum("ij,ij->i", points[:, :3] - places[nearest], normal)
    return points[:, :3] - off[:, None] * normal, normal, nearest, share


def middles(samples: np.ndarray, start: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Middles (P, k) of parts, SAMPLES of them each or one from each of `start` (P, k), of what samples (N, k) fill
    evenly, the sample that is nearest to each middle, and how much (P,) each part holds over the mean. The parts are
    those of the samples that are nearest to each point, which moves to their middle (Lloyd 1982, IEEE Trans. Inf.
    Theory 28, 129). They begin along a tree that halves the samples by place: in the order of facets, each SAMPLES-th
    of a mesh in rows may be in one column of it."""
    if start is None:
        start = samples[scipy.spatial.cKDTree(samples, SAMPLES).indices[SAMPLES // 2 :: SAMPLES]]
    points, count = start, len(start)
    for _ in range(SETTLINGS):
        own = scipy.spatial.cKDTree(points).query(samples)[1]
        number = np.bincount(own, minlength=count)
        sums = np.stack([np.bincount(own, column, minlength=count) for column in samples.T], axis=1)
        points = np.where(number[:, None] > 0, sums / np.maximum(number, 1)[:, None], points)
    held = np.bincount(scipy.spatial.cKDTree(points).query(samples)[1], minlength=count)
    return points, scipy.spatial.cKDTree(samples).query(points)[1], held * (count / max(len(samples), 1))


def rings(profile: np.ndarray, spacing: float) -> np.ndarray:
    """(N, 3) points on rings about the last axis, as many as their area asks for; profile (P, 3) radius, height and
    width [m]."""
    points = []
    for k, (radius, height, width) in enumerate(profile):
        count = max(1, round(2.0 * math.pi * radius * width / spacing**2))
        angle = 2.0 * math.pi * np.arange(count) / count + k * GOLDEN
        points.append(np.stack([radius * np.cos(angle), radius * np.sin(angle), np.full(count, height)], axis=1))
    return np.concatenate(points)


def arc(radius: float, height: float, first: float, last: float, spacing: float) -> np.ndarray:
    """(P, 3) of a circle about (0, height), polar angle from the top between `first` and `last`, cell-centred."""
    count = max(1, round(radius * (last - first) / spacing))
    angle = first + (np.arange(count) + 0.5) * (last - first) / count
    return np.stack(
        [radius * np.sin(angle), height + radius * np.cos(angle), np.full(count, radius * (last - first) / count)],
        axis=1,
    )


def line(radius: float, low: float, high: float, spacing: float) -> np.ndarray:
    count = max(1, round((high - low) / spacing))
    heights = low + (np.arange(count) + 0.5) * (high - low) / count
    return np.stack([np.full(count, radius), heights, np.full(count, (high - low) / count)], axis=1)


def disc(radius: float, height: float, spacing: float) -> np.ndarray:
    count = max(1, round(radius / spacing))
    radii = (np.arange(count) + 0.5) * radius / count
    return np.stack([radii, np.full(count, height), np.full(count, radius / count)], axis=1)
