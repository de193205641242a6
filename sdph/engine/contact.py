"""Contact between methods: particles of two kinds of matter that come nearer than a spacing push each other apart.

    F_ij = k dx (1 - r/dx) r_ij/r  for r < dx,   k = rho c^2 dx^(d-2)

a spring as stiff as the liquid around (our choice: a particle pressed in by half a spacing feels rho c^2/2 on its
face), equal and opposite, so that what one method loses the other gains. It is found once a window and holds over it.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.spatial import cKDTree

STEADY = 0.2  # of sqrt(m/k), the time of the spring: longest that its force may be held; our choice


class Contact:
    """Springs between the particles of two methods: `spacing` [m], `stiffness` k [N/m]."""

    def __init__(self, spacing: float, stiffness: float):
        self.spacing, self.stiffness = spacing, stiffness

    def limit(self, lightest: float) -> float:
        """Longest window [s] over which the force on a particle of a mass [kg] may hold."""
        return STEADY * math.sqrt(lightest / self.stiffness)

    def near(self, first: np.ndarray, second: np.ndarray) -> bool:
        """True where any two are so near, within two spacings, that they may touch in the next window."""
        return (
            bool(len(first) and len(second)) and cKDTree(first).count_neighbors(cKDTree(second), 2.0 * self.spacing) > 0
        )

    def forces(self, first: np.ndarray, second: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Forces (N, 3) and (M, 3) [N] on particles at `first` (N, 3) and `second` (M, 3) [m]."""
        on_first, on_second = np.zeros_like(first), np.zeros_like(second)
        if not len(first) or not len(second):
            return on_first, on_second
        found = cKDTree(first).sparse_distance_matrix(cKDTree(second), self.spacing, output_type="ndarray")
        i, j, r = found["i"], found["j"], found["v"]
        apart = (first[i] - second[j]) / np.maximum(r, np.finfo(float).tiny)[:, None]
        force = (self.stiffness * (self.spacing - r))[:, None] * apart
        np.add.at(on_first, i, force)
        np.add.at(on_second, j, -force)
        return on_first, on_second


def between(case) -> Contact:
    """Contact of grains with the liquid of a case, or of any method with it."""
    spacing, own = case.resolution.spacing, case.liquid
    return Contact(spacing, own.density * own.sound_speed**2 * spacing ** (case.dimensions - 2))
