"""Patches of a tank's surface: each is what of it is nearest to one wall particle of the first layer, and together they
are all of it. Behind an edge stand wall particles that no patch is of."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from sdph.engine.walls import facets
from sdph.engine.walls.outline import Outline
from sdph.engine.walls.shapes import Box, Joined, Mesh

STEP = 1e-3  # spacings, to find the way to a surface by differences; our choice
FINE = 4  # places to a spacing, by which the area of a patch is told; our choice
PROBE, BENT = 0.25, 0.02  # spacings in front of a face, and how much nearer another may be there; our choice


class Patches(NamedTuple):
    """P patches: the number (P,) of the wall particle behind each and its middle (P, d) [m]; places (S, d) [m] on the
    surface, the area (S, d) [m^(d-1)] of each along the normal out of the liquid, and the patch (S,) that it is of."""

    particle: np.ndarray
    middle: np.ndarray
    places: np.ndarray
    area: np.ndarray
    whose: np.ndarray

    def sums(self, what: np.ndarray) -> np.ndarray:
        """(P, n) over the places of each patch, of (S, n)."""
        return np.stack([np.bincount(self.whose, own, len(self.particle)) for own in what.T], axis=1)


def found(shape, points: np.ndarray, spacing: float) -> Patches:
    """Patches in front of wall particles at `points` (W, d) [m] of a shape, about a spacing wide."""
    feet, normals, plain = _feet(shape, points, spacing)
    plain &= shape.distance(points) < spacing
    particle, tree = np.flatnonzero(plain), cKDTree(np.hstack((feet, spacing * normals))[plain])
    places, facing, size = _strewn(shape, spacing / FINE)
    whose = tree.query(np.hstack((places, spacing * facing)))[1]
    own = Patches(particle, feet[particle], places, size[:, None] * facing, whose)
    many = np.bincount(whose, minlength=len(particle))[:, None]
    return own._replace(middle=own.sums(places) / np.maximum(many, 1))


def _feet(shape, points, spacing: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Places (W, d) [m] of the surface in front of points, r - D grad D of the distance D, the gradient (W, d), and who
    (W,) is in front of no edge."""
    ways, distance = STEP * spacing * np.eye(points.shape[1]), shape.distance(points)
    rise = [shape.distance(points + way) - shape.distance(points - way) for way in ways]
    slope = np.stack(rise, axis=1) / (2.0 * STEP * spacing)
    feet = points - distance[:, None] * slope
    before = shape.distance(feet - PROBE * spacing * slope)
    steep = np.abs(np.linalg.norm(slope, axis=1) - 1.0) < BENT  # elsewhere two faces are as near
    return feet, slope, steep & (np.abs(before + PROBE * spacing) < BENT * spacing)


def _strewn(shape, spacing: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Places (S, d) [m] about a spacing apart on a surface, the normals there, and the area of each."""
    if isinstance(shape, Mesh):
        corners = shape.triangles.points[shape.triangles.regular_faces]
        places, normals, _, share = facets.spread(corners, spacing)
        return places, normals, share * (facets.sizes(corners).sum() / len(places))
    if isinstance(shape, Outline):
        return shape.strewn(spacing)
    own = shape.tank if isinstance(shape, Joined) else shape
    straight = isinstance(own, Box)
    feet, normals, plain = _feet(shape, own.shell(0.5 * spacing if straight else 0.0, spacing), spacing)
    feet, normals = feet[plain], normals[plain]
    if not straight:
        return feet, normals, np.full(len(feet), spacing ** (feet.shape[1] - 1))
    steps = own.steps(spacing)[1]
    return feet, normals, steps.prod() / steps[np.abs(normals).argmax(axis=1)]
