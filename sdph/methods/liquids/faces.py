"""Faces of bubbles: which particles are at one, and the push of a pressure on it."""

from __future__ import annotations

import math

import numpy as np
from numba import prange

from sdph.engine import kernels as smoothing
from sdph.engine.geometry import apart
from sdph.engine.rows import entry, length
from sdph.laws.compiled import fast_parallel

# of 1/h: |sum V_j grad W| from which on a particle is at a face; 0.6 half a spacing behind a plane one, 0.2 another
# spacing on, disorder below 0.1; our choice
AT_FACE = 0.25


def at(stepper, near) -> np.ndarray:
    """(N,) [1/m] how much of a face particles have, of those that are `near` (N,) one; 0 of those within, whose sum
    V_j grad W is but disorder: through that the whole liquid would boil."""
    facing = np.where(near, stepper.facing, 0.0)
    return np.where(facing * stepper.kernel.h > AT_FACE, facing, 0.0)


def share_of(depth, reach: float) -> np.ndarray:
    """(N,) share of the pressure at depths (N,) [m] behind a face: 1 within the kernel's reach [m], and down to 0 over
    another. Where it is 1 nothing keeps particles apart, and where it is 0 a gap in the liquid closes; were it 1 all
    over, a shell would leave the liquid behind."""
    return np.clip(2.0 - depth / reach, 0.0, 1.0)


@fast_parallel
def press(kernel, s, rows, box, active, volume, outside, inflating, facing):
    """inflating (N, 3) [m/s2] = 2 p_b/rho sum V_j grad W of a pressure `outside` (N,) [Pa]; facing (N,) [1/m] the
    length of that sum."""
    for n in prange(len(active)):
        i = active[n]
        x = y = z = 0.0
        for k in range(length(rows, i)):
            j = entry(rows, i, k)
            dx, dy, dz = apart(s, box, i, j)
            share = abs(volume[j]) * smoothing.slope(kernel, math.sqrt(dx * dx + dy * dy + dz * dz))
            x += share * dx
            y += share * dy
            z += share * dz
        scale = 2.0 * outside[i] / s.density[i]
        inflating[i, 0], inflating[i, 1], inflating[i, 2] = scale * x, scale * y, scale * z
        facing[i] = math.sqrt(x * x + y * y + z * z)
