"""Grain sizes within one SPH particle: averages over its log-normal distribution by Gauss-Hermite quadrature."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from sdph.effects.effect import OFF
from sdph.laws import grain_sizes

CLASSES = 5  # quadrature nodes: moments of d up to order 9 exact in ln d; our choice


class Sizes(NamedTuple):
    """Nodes and weights (CLASSES,) of the standard normal."""

    node: np.ndarray
    weight: np.ndarray


def kernel(case):
    """Quadrature for kernels; OFF where all grains are alike."""
    return Sizes(*grain_sizes.gauss_hermite(CLASSES)) if case.grains.diameter_std > 0.0 else OFF


@njit(cache=True, error_model="numpy")
def classes(p):
    """Number of size classes to sum over."""
    if len(p) == 0:
        return 1
    return len(p.node)


@njit(cache=True, error_model="numpy")
def diameter(p, s, i, q):
    """Diameter [m] of size class q of particle i."""
    if len(p) == 0:
        return s.diameter[i]
    std = np.sqrt(s.diameter_variance[i])
    mean = grain_sizes.mass_log_mean(s.diameter[i], std)
    return grain_sizes.diameter_at(p.node[q], mean, grain_sizes.log_std(s.diameter[i], std))


@njit(cache=True, error_model="numpy")
def share(p, q):
    """Share of the particle's mass in size class q."""
    if len(p) == 0:
        return 1.0
    return p.weight[q]
