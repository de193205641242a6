"""Waves on a lattice of particles that an artificial viscosity damps."""

import itertools
import math

import numpy as np

from sdph.engine.kernels import slope, smoothing
from sdph.laws.constants import SOFTENING


def fastest(kernel: str, ratio: float, dimensions: int) -> float:
    """Largest rate over alpha c/h at which waves along axes and diagonals decay with h = `ratio` spacings, all pairs
    felt."""
    ways = [way for way in itertools.product((0.0, 1.0), repeat=dimensions) if any(way)]
    return max(_along(kernel, ratio, np.array(way)) for way in ways)


def _along(kernel: str, ratio: float, way) -> float:
    d, reach = len(way), math.ceil(2.0 * ratio)
    places = np.stack(np.meshgrid(*d * [np.arange(-reach, reach + 1.0)]), axis=-1).reshape(-1, d)
    places = places[places.any(axis=1)]
    own, r2 = smoothing(kernel, d, ratio), (places**2).sum(axis=1)
    pulls = np.array([slope(own, each) for each in np.sqrt(r2)])
    phases = np.linspace(0.01, 1.0, 100)[:, None] * math.pi * (places @ way)
    weights = -pulls / (r2 + SOFTENING * ratio**2) * (1.0 - np.cos(phases))
    return float(np.linalg.eigvalsh(np.einsum("wn,na,nb->wab", weights, places, places))[:, -1].max() * ratio**2)
