"""Polygons in the plane: area, and what lies within."""

from __future__ import annotations

import numpy as np

from sdph.laws.compiled import serial


def area(x, y) -> float:
    """Area [m2] of a polygon with corners (N,) [m], counterclockwise."""
    return 0.5 * float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum())


@serial
def holds(corner_x, corner_y, x, y):
    """(N,) bool: which points lie within a polygon, by the crossings of a line to the right."""
    within = np.zeros(len(x), np.bool_)
    last = len(corner_x) - 1
    for i in range(len(x)):
        b = last
        for a in range(len(corner_x)):
            ya, yb = corner_y[a], corner_y[b]
            if (ya > y[i]) != (yb > y[i]):
                crossing = corner_x[a] + (y[i] - ya) / (yb - ya) * (corner_x[b] - corner_x[a])
                if x[i] < crossing:
                    within[i] = not within[i]
            b = a
    return within
