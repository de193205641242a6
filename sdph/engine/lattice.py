"""Points of square and cubic lattices."""

from __future__ import annotations

import math

import numpy as np


def lattice(region, spacing: float, dimensions: int) -> np.ndarray:
    """(N, dimensions) points of a square or cubic lattice in a region, cell-centred on the region's centre or
    corner."""
    if region.shape == "box":
        counts = [max(1, round((b - a) / spacing)) for a, b in zip(region.lower, region.upper)]
        ticks = [a + (np.arange(n) + 0.5) * (b - a) / n for a, b, n in zip(region.lower, region.upper, counts)]
        return grid(ticks)
    reach = math.ceil(region.radius / spacing)
    points = grid([c + (np.arange(-reach, reach) + 0.5) * spacing for c in region.centre])
    return points[((points - np.array(region.centre)) ** 2).sum(axis=1) <= region.radius**2]


def grid(ticks: list[np.ndarray]) -> np.ndarray:
    """Points of a tensor grid, the first axis fastest (row-major numbering of the paper)."""
    mesh = np.meshgrid(*ticks[::-1], indexing="ij")[::-1]
    return np.stack([m.ravel() for m in mesh], axis=1)
