"""Flat pictures of cells of any shape, for comparisons: those that a cut through the middle meets."""

from __future__ import annotations

import numpy as np

from sdph.show import style


def axes(case) -> list[int]:
    """Two axes that are seen, sideways and up."""
    up = int(np.argmax(np.abs(case.domain.gravity))) if any(case.domain.gravity) else 1
    return [next(axis for axis in range(case.dimensions) if axis != up), up]


def cut(case, grid) -> tuple[list[np.ndarray], np.ndarray]:
    """Polygons (corners, 2) [m] of the cells that are seen, sideways and up, and the centres (P, D) [m] of these
    cells."""
    along, up = axes(case)
    across = 3 - along - up
    grid = grid.copy()
    grid.cell_data["centre"] = np.asarray(grid.cell_centers().points)
    if np.ptp(np.asarray(grid.bounds)[2 * across : 2 * across + 2]) > 0.0:
        middle = np.array(grid.center)
        middle[across] += 0.25 * case.resolution.cell  # not between two layers of a box
        grid = grid.slice(normal="xyz"[across], origin=middle if case.dimensions == 3 else grid.center)
    pieces = [np.asarray(grid.get_cell(i).points)[:, [along, up]] for i in range(grid.n_cells)]
    return [_round(piece) for piece in pieces], np.asarray(grid.cell_data["centre"])[:, : case.dimensions]


def _round(corners: np.ndarray) -> np.ndarray:
    """Corners (n, 2) of a convex piece, in turn."""
    way = corners - corners.mean(axis=0)
    return corners[np.argsort(np.arctan2(way[:, 1], way[:, 0]))]


def painted(axis, pieces, values, limits, field: str):
    """Polygons in the colours of a field between two limits, on axes without ticks."""
    from matplotlib.collections import PolyCollection

    image = PolyCollection(pieces, array=values, cmap=style.map_of(style.QUANTITIES[field].map), edgecolors="face")
    image.set_clim(*limits)
    axis.add_collection(image)
    axis.autoscale_view()
    axis.set(aspect="equal", xticks=[], yticks=[])
    return image
