"""Outlets among the walls of a mesh: who is behind one of their facets."""

from __future__ import annotations

import functools
import os
from typing import NamedTuple

import numpy as np
from numba import prange

from sdph.engine import arrays
from sdph.engine.walls import facets
from sdph.laws.compiled import parallel

SLACK = 1e-9  # of a facet's size: round-off at an edge that two share


class Openings(NamedTuple):
    """Facets as planes (F, 1 + d, 4), n_x, n_y, n_z and c [m] of n.r > c: into the vessel, then within each edge; the
    number (F,) of the boundary that each is of."""

    planes: np.ndarray
    owner: np.ndarray


def read(path: str, dimensions: int) -> Openings:
    """Outlets of the walls of a mesh in metres, read once as long as the file is as it was."""
    return _read(path, dimensions, os.stat(path).st_mtime_ns)


@functools.lru_cache(maxsize=2)
def _read(path: str, dimensions: int, changed: int) -> Openings:
    every = facets.every(path, dimensions)
    found = every.those(every.open)
    corners, count = found.corners, len(found.owner)
    normals = facets.normals(corners)
    across = [(corners[:, k], corners[:, (k + 1) % dimensions]) for k in range(dimensions)]
    planes = np.zeros((count, 1 + dimensions, 4))
    for k, (one, other) in enumerate(across, start=1):
        inwards = other - one if dimensions == 2 else np.cross(normals, other - one)
        planes[:, k, :dimensions] = inwards / np.linalg.norm(inwards, axis=1, keepdims=True)
        planes[:, k, 3] = (planes[:, k, :dimensions] * one).sum(axis=1) - SLACK * np.linalg.norm(other - one, axis=1)
    planes[:, 0, :dimensions], planes[:, 0, 3] = normals, (normals * corners[:, 0]).sum(axis=1)
    return Openings(planes, found.owner.astype(np.int64))


def behind(found: Openings, state, deep: float):
    """(N,) number of the boundary whose facet each particle is behind, at most `deep` [m], and goes on away from; -1 of
    none."""
    number = arrays.empty(len(state.x), state.x, np.int64)
    look(state, found, deep, number)
    return number


@parallel
def look(s, found, deep, number):
    """number (N,) of `behind`; how many are behind one."""
    out = 0.0
    for i in prange(len(s.x)):
        z, w = (s.z[i], s.w[i]) if len(s.z) else (0.0, 0.0)
        number[i] = -1
        for f in range(len(found.owner)):
            n = found.planes[f, 0]
            height = n[0] * s.x[i] + n[1] * s.y[i] + n[2] * z - n[3]
            if height < 0.0 and height >= -deep and n[0] * s.u[i] + n[1] * s.v[i] + n[2] * w <= 0.0:
                inside = True
                for k in range(1, found.planes.shape[1]):
                    e = found.planes[f, k]
                    inside = inside and e[0] * s.x[i] + e[1] * s.y[i] + e[2] * z >= e[3]
                if inside:
                    number[i] = found.owner[f]
        out += 1.0 if number[i] >= 0 else 0.0
    return out
