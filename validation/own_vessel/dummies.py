"""Points on walls of triangles: as many as their area asks for, evenly, whatever the triangles are."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from sdph.engine.walls import facets
from sdph.study.compare import check

SPACING = 0.05  # m
SIZES = (0.2, 1.0, 5.0, 50.0)  # edges of triangles, in spacings
SLIVER = 50.0  # length over width
AREA, NEAREST = 0.02, 0.35  # - of an even share of the area; spacings between two points at least


def sheet(size: float, length: float = 1.0) -> np.ndarray:
    """Triangles (F, 3, 3) [m] with a short side of `size` spacings and a long one of `length` times that: as many as
    cover four spacings each way, or one cell."""
    long = size * length
    counts = [max(1, round(4.0 / side)) for side in (long, size)]
    ticks = [SPACING * side * np.arange(n + 1) for n, side in zip(counts, (long, size))]
    x, y = np.meshgrid(*ticks, indexing="ij")
    points = np.stack([x, y, np.zeros_like(x)], axis=-1)
    a, b, c, d = points[:-1, :-1], points[1:, :-1], points[1:, 1:], points[:-1, 1:]
    return np.concatenate([np.stack([a, b, c], axis=2), np.stack([a, c, d], axis=2)]).reshape(-1, 3, 3)


def checks(folder: Path | None = None, _=(), reporter=None) -> list[dict]:
    """Checks of each size of triangles, and of slivers: points over the area, of the whole and of its quarters."""
    rows = []
    for name, corners in {
        **{f"triangles of {size:g} spacings": sheet(size) for size in SIZES},
        "slivers, 0.2 by 10 spacings": sheet(0.2, SLIVER),
        "slivers, 1 by 50 spacings": sheet(1.0, SLIVER),
    }.items():
        rows += [row | {"name": f"{name}: {row['name']}"} for row in _checks(corners)]
    return rows


def _checks(corners: np.ndarray) -> list[dict]:
    points, *_ = facets.spread(corners, SPACING)
    whole = facets.sizes(corners).sum() / SPACING**2
    nearest = cKDTree(points).query(points, k=2)[0][:, 1].min() / SPACING
    return [
        check(
            "points over the area in squares of a spacing, less 1 [-]",
            len(points) / whole - 1.0,
            0.0,
            max(AREA, 0.5 / whole),
        ),
        check("nearest two [spacings]", nearest, 1.0, 1.0 - NEAREST),
    ]
