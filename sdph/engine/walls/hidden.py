"""Walls behind a surface: where one lies in another, or touches it, it is there once."""

from __future__ import annotations

import numpy as np

from sdph.engine.walls.facets import Surface
from sdph.laws.constants import ROUND_OFF


def behind(corners: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Mask (N,) of places (N, d) [m] behind facets (F, d, d) [m]; not of those that are nearest to a rim, as beyond it
    goes on what the surface ends in."""
    surface = Surface(corners)
    depth, free = -surface.distance(places), surface.free()
    hidden = depth > 0.0
    if len(free) and len(places):
        hidden &= _away(free, places) > depth * (1.0 + ROUND_OFF)
    return hidden


def _away(sides: np.ndarray, places: np.ndarray) -> np.ndarray:
    """(N,) [m] from places (N, d) [m] to the nearest of sides (E, 2, 3) [m]."""
    import pyvista

    ends = 2 * np.arange(len(sides))
    lines = pyvista.PolyData(sides.reshape(-1, 3), lines=np.column_stack([np.full(len(ends), 2), ends, ends + 1]))
    flat = np.pad(places, ((0, 0), (0, 3 - places.shape[1])))
    return np.linalg.norm(lines.find_closest_cell(flat, return_closest_point=True)[1] - flat, axis=1)
