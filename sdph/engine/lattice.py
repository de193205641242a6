"""Points of square and cubic lattices."""

from __future__ import annotations

import itertools
import math

import numpy as np

from sdph.engine.world import ALONE


def grid(ticks: list[np.ndarray], world=ALONE) -> np.ndarray:
    """Points of a tensor grid, the first axis fastest (row-major numbering of the paper); each process of a world has
    its share of them."""
    if world.number > 1:
        sizes = [len(along) for along in ticks[::-1]]
        rows = np.unravel_index(np.arange(*world.ends(math.prod(sizes))), sizes)[::-1]
        return np.stack([along[row] for along, row in zip(ticks, rows)], axis=1)
    mesh = np.meshgrid(*ticks[::-1], indexing="ij")[::-1]
    return np.stack([m.ravel() for m in mesh], axis=1)


def lattice(region, spacing: float, dimensions: int, world=ALONE) -> np.ndarray:
    """(N, dimensions) points of a square or cubic lattice in a region, cell-centred on the region's centre or corner;
    each process of a world has a part of them, one after the other."""
    if region.shape == "box":
        counts = [max(1, round((b - a) / spacing)) for a, b in zip(region.lower, region.upper)]
        ticks = [a + (np.arange(n) + 0.5) * (b - a) / n for a, b, n in zip(region.lower, region.upper, counts)]
        return grid(ticks, world)
    reach = math.ceil(region.radius / spacing)
    points = grid([c + (np.arange(-reach, reach) + 0.5) * spacing for c in region.centre], world)
    return points[((points - np.array(region.centre)) ** 2).sum(axis=1) <= region.radius**2]


def rings(centre, inner: float, outer: float, spacing: float) -> tuple[np.ndarray, np.ndarray]:
    """Points (N, 2) [m] of a disc with a hole in circles about a spacing apart, along which they stand about a spacing
    apart too, and their areas (N,) [m2], which fill it."""
    layers = max(1, round((outer - inner) / spacing))
    edges = np.linspace(inner, outer, layers + 1)
    points, areas = [], []
    for low, high in itertools.pairwise(edges):
        count = max(1, round(math.pi * (low + high) / spacing))
        angle, middle = 2.0 * math.pi * (np.arange(count) + 0.5) / count, 0.5 * (low + high)
        points.append(np.stack([middle * np.cos(angle), middle * np.sin(angle)], axis=1))
        areas.append(np.full(count, math.pi * (high**2 - low**2) / count))
    return np.concatenate(points) + np.array(centre), np.concatenate(areas)


def pierced(centre, outer: float, holes, spacing: float) -> tuple[np.ndarray, np.ndarray]:
    """Points (N, 2) [m] of a disc with holes (each with centre and radius), in circles, and their areas (N,) [m2],
    which fill it: about one hole in its middle, or those of the whole disc that no hole takes."""
    if len(holes) == 1 and tuple(holes[0].centre) == tuple(centre):
        return rings(centre, holes[0].radius, outer, spacing)
    points, areas = rings(centre, 0.0, outer, spacing)
    kept = np.ones(len(points), bool)
    for hole in holes:
        kept &= np.hypot(*(points - np.array(hole.centre)).T) > hole.radius
    wanted = math.pi * (outer**2 - sum(hole.radius**2 for hole in holes))
    return points[kept], areas[kept] * (wanted / areas[kept].sum())
