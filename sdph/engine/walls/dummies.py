"""Dummy particles behind the walls of grains: where they stand, and how far particles are from them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from sdph.engine.geometry import nearest_image


class Dummies(NamedTuple):
    """W dummies: place [m], unit normal (0 in corners, where two walls meet), depth behind the surface [m], 0 where
    the surface lets grains slip and else 1."""

    x: np.ndarray
    y: np.ndarray
    z: np.ndarray
    normal_x: np.ndarray
    normal_y: np.ndarray
    normal_z: np.ndarray
    depth: np.ndarray
    stick: np.ndarray


@njit(cache=True, error_model="numpy")
def offset(box, dummies, w, s, i):
    """r_i - r_w, three components, through periodic boundaries."""
    dz = s.z[i] - dummies.z[w] if len(s.z) else 0.0
    return nearest_image(box, s.x[i] - dummies.x[w], s.y[i] - dummies.y[w], dz)


@njit(cache=True, error_model="numpy")
def distance(box, dummies, w, s, i):
    dx, dy, dz = offset(box, dummies, w, s, i)
    return np.sqrt(dx * dx + dy * dy + dz * dz)


@njit(cache=True, error_model="numpy")
def normal_part(dummies, w, dx, dy, dz):
    """The part of a vector along the normal of a wall, or all of it in a corner, where none is known."""
    nx, ny, nz = dummies.normal_x[w], dummies.normal_y[w], dummies.normal_z[w]
    along, corner = dx * nx + dy * ny + dz * nz, 1.0 - (nx * nx + ny * ny + nz * nz)
    return along * nx + corner * dx, along * ny + corner * dy, along * nz + corner * dz
