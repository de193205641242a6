"""Points on surfaces: on those about an axis in rings, on any other moved along it until they lie evenly."""

from __future__ import annotations

import math

import numpy as np
import scipy

from sdph.laws import kernels

# from lattice points moved onto a sphere, 0.2 to 0.5 spacings apart at least, to 0.73 or more; 16 come no further; our
# choice
ROUNDS = 8
GOLDEN = math.pi * (3.0 - math.sqrt(5.0))  # rad, turn from ring to ring, so that rings do not line up
WIDTH = 1.5  # h over the spacing: the default of resolution.smoothing_ratio


def even_out(points, spacing: float, onto) -> np.ndarray:
    """(N, 3) after ROUNDS of r -= h^2/2 grad C, then `onto`(points) the surface; C the kernel's sum over points of area
    spacing^2.

    The coefficient is the largest stable one: Lind, Xu, Stansby & Rogers 2012, J. Comput. Phys. 231, 1499.
    """
    h = WIDTH * spacing
    for _ in range(ROUNDS):
        i, j = scipy.spatial.cKDTree(points).query_pairs(kernels.SUPPORT * h, output_type="ndarray").T
        apart = points[i] - points[j]
        slope = (
            -5.0
            * kernels.normalisation("wendland_c2", 2, h)
            / h**2
            * (1.0 - 0.5 / h * np.linalg.norm(apart, axis=1)) ** 3
        )
        rise, moved = spacing**2 * slope[:, None] * apart, points.copy()
        np.add.at(moved, i, -0.5 * h**2 * rise)
        np.add.at(moved, j, 0.5 * h**2 * rise)
        points = onto(moved)
    return points


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
