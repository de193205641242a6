"""Part that r^2 + 0.01 h^2 in place of r^2 takes off the pairs of a cloud; limiters 11 and 34 of docs/limiters.md."""

from __future__ import annotations

import math

import numpy as np
from numba import prange

from sdph.engine import arrays
from sdph.engine import kernels as smoothing
from sdph.engine.geometry import apart
from sdph.engine.rows import entry
from sdph.laws.compiled import in_order, parallel
from sdph.laws.constants import SOFTENING

SAMPLE = 8  # of so many particles one is looked at: a mean over a cloud, which costs nothing then; our choice


@parallel
def sample(chosen, ident, mask):
    """mask (C,) of one in SAMPLE of the `chosen` particles, by its number: whatever their order, and whoever has
    them."""
    for n in prange(len(chosen)):
        mask[n] = ident[chosen[n]] % SAMPLE == 0


@in_order
def left_of(kernel, s, rows, box, chosen, sampled, weight, eta_squared):
    """sum_i sum_j w_j r^2 (dW/dr)/r, a diffusion's own weights, and what eta_squared [m2] in r^2/(r^2 + eta^2) leaves
    of it; over the `sampled` places in the `chosen` (C,) particles, and neighbours of weight (N,)."""
    whole = left = 0.0
    for n in prange(len(sampled)):
        i = chosen[sampled[n]]
        for k in range(rows.number[i]):
            j = entry(rows, i, k)
            dx, dy, dz = apart(s, box, i, j)
            r2 = dx * dx + dy * dy + dz * dz
            share = weight[j] * smoothing.slope(kernel, math.sqrt(r2)) * r2
            whole += share
            left += share * r2 / (r2 + eta_squared)
    return whole, left


def held(method, name, chosen, weight) -> dict[str, float]:
    """Column of history.csv of a stepper with the kernel `name`; chosen (A,) rows of its particles, of which one in
    SAMPLE, by its number, counts."""
    case, eta_squared = method.case, SOFTENING * method.case.smoothing_length**2
    around = (
        smoothing.smoothing(name, case.dimensions, case.smoothing_length),
        method.state,
        method.rows,
        method.neighbours.box,
    )
    mask = arrays.empty(len(chosen), chosen, np.bool_)
    sample(chosen, method.state.ident, mask)
    sums = left_of(*around, chosen, arrays.chosen(mask), weight, eta_squared)
    whole, left = method.neighbours.world.sum(np.array(sums))
    return {"softened_rel": float(1.0 - left / whole) if whole != 0.0 else 0.0}
