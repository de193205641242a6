"""Wall particles of a tank: layers a spacing apart behind its surface, and behind that of its outlet pipe."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from sdph.engine.walls.shapes import Box, Capsule, Joined

# spacings: a wall particle of a pipe that is nearer to one of a flat floor stands for the same; our choice. Through a
# curved floor layers pass at an angle, and either of two so near that goes leaves a hole
SAME_WALL = 0.5


def wall_points(shape, spacing: float, layers: int) -> tuple[np.ndarray, np.ndarray]:
    """(W, d) wall particles of a tank in `layers`, the first half a spacing behind the surface, and (P, d) those of its
    outlet pipe."""
    if not isinstance(shape, Joined):
        own = _behind(shape, shape, spacing, layers)
        return own, own[:0]
    own, pipe = (_behind(part, shape, spacing, layers) for part in (shape.tank, shape.pipe))
    if isinstance(shape.tank, Capsule):
        return own, pipe
    return own, pipe[cKDTree(own).query(pipe)[0] >= SAME_WALL * spacing]


def volumes(shape, points, spacing: float) -> np.ndarray:
    """(W + P,) volumes [m^d] that wall particles stand for, from the two arrays of `wall_points`; a box has a lattice
    that is fitted to its sides."""
    parts = (shape.tank, shape.pipe) if isinstance(shape, Joined) else (shape, None)
    each = [part.steps(spacing)[1].prod() if isinstance(part, Box) else spacing ** points[0].shape[1] for part in parts]
    return np.repeat(each, [len(own) for own in points])


def _behind(part, whole, spacing: float, layers: int) -> np.ndarray:
    """Layers of `part`; of two shapes that meet, what lies in or too near to the other is left out."""
    points = []
    for layer in range(layers):
        depth = (layer + 0.5) * spacing
        shell = part.shell(depth, spacing)
        points.append(shell if part is whole else shell[whole.distance(shell) > depth - 0.25 * spacing])
    return np.concatenate(points)
