"""Outlets among the walls of a mesh: who is behind one of their facets."""

from __future__ import annotations

import functools
import os
from typing import NamedTuple

import numpy as np
from numba import prange

from sdph.engine import arrays
from sdph.engine.walls import facets
from sdph.laws.compiled import inlined, parallel

SLACK = 1e-9  # of a facet's size: round-off at an edge that two share


class Openings(NamedTuple):
    """Facets as planes (F, 1 + d, 4), n_x, n_y, n_z and c [m] of n.r > c: into the vessel, then within each edge; of
    each of B boundaries its number (B,), its first facet and one after its last (B, 2), and the corners (B, 2, 3) [m]
    of the box around them."""

    planes: np.ndarray
    owner: np.ndarray
    facets: np.ndarray
    box: np.ndarray


def read(path: str, dimensions: int) -> Openings:
    """Outlets of the walls of a mesh in metres, read once as long as the file is as it was."""
    return _read(path, dimensions, os.stat(path).st_mtime_ns)


@functools.lru_cache(maxsize=2)
def _read(path: str, dimensions: int, changed: int) -> Openings:
    every = facets.every(path, dimensions)
    found = every.those(every.open)
    found = found.those(np.argsort(found.owner, kind="stable"))
    corners, count = found.corners, len(found.owner)
    normals = facets.normals(corners)
    across = [(corners[:, k], corners[:, (k + 1) % dimensions]) for k in range(dimensions)]
    planes = np.zeros((count, 1 + dimensions, 4))
    for k, (one, other) in enumerate(across, start=1):
        inwards = other - one if dimensions == 2 else np.cross(normals, other - one)
        planes[:, k, :dimensions] = inwards / np.linalg.norm(inwards, axis=1, keepdims=True)
        planes[:, k, 3] = (planes[:, k, :dimensions] * one).sum(axis=1) - SLACK * np.linalg.norm(other - one, axis=1)
    planes[:, 0, :dimensions], planes[:, 0, 3] = normals, (normals * corners[:, 0]).sum(axis=1)
    owner, first, many = np.unique(found.owner, return_index=True, return_counts=True)
    box = np.zeros((len(owner), 2, 3))
    for k, start in enumerate(first):
        own = corners[start : start + many[k]].reshape(-1, dimensions)
        box[k, 0, :dimensions], box[k, 1, :dimensions] = own.min(axis=0), own.max(axis=0)
    return Openings(planes, owner.astype(np.int64), np.stack([first, first + many], axis=1), box)


def behind(found: Openings, state, deep: float):
    """(N,) number of the boundary whose facet each particle is behind, at most `deep` [m], and goes on away from; -1 of
    none."""
    owner = arrays.empty(len(state.x), state.x, np.int64)
    look(state, found, deep, owner)
    return owner


@parallel
def look(s, found, deep, owner):
    """owner (N,): the numbers of `behind`."""
    for i in prange(len(s.x)):
        z, w = (s.z[i], s.w[i]) if len(s.z) else (0.0, 0.0)
        place, velocity = (s.x[i], s.y[i], z), (s.u[i], s.v[i], w)
        owner[i] = -1
        for b in range(len(found.owner)):
            if near(found.box[b], place, deep) and through(found.planes, found.facets[b], place, velocity, deep):
                owner[i] = found.owner[b]


@inlined
def near(box, place, deep):
    """True where a place (3) [m] is no further than `deep` [m] out of a box (2, 3) along any axis."""
    x, y, z = place
    within = x >= box[0, 0] - deep and x <= box[1, 0] + deep and y >= box[0, 1] - deep and y <= box[1, 1] + deep
    return within and z >= box[0, 2] - deep and z <= box[1, 2] + deep


@inlined
def through(planes, ends, place, velocity, deep):
    """True where a place (3) [m] is behind one of the facets from the first to before the second of `ends`, at most
    `deep` [m], and its velocity (3) leads away."""
    for f in range(ends[0], ends[1]):
        n = planes[f, 0]
        height = n[0] * place[0] + n[1] * place[1] + n[2] * place[2] - n[3]
        if height < 0.0 and height >= -deep and n[0] * velocity[0] + n[1] * velocity[1] + n[2] * velocity[2] <= 0.0:
            inside = True
            for k in range(1, planes.shape[1]):
                e = planes[f, k]
                inside = inside and e[0] * place[0] + e[1] * place[1] + e[2] * place[2] >= e[3]
            if inside:
                return True
    return False
