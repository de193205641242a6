"""Kernels of scalar products, whose value stays on the device: threads add up in one order, which no card changes."""

from __future__ import annotations

from sdph.engine.gpu.toolkit import cuda, kernel


@kernel
def multiply(a, b, part):
    """part (T, 1): sum a b of every T-th of (N,), of each of T threads."""
    t, found = cuda.grid(1), 0.0
    for i in range(t, len(a), len(part)):
        found += a[i] * b[i]
    part[t, 0] = found


@kernel
def put(part, sums, place):
    """sums[place] = the sum of part (T, 1); one thread."""
    found = 0.0
    for t in range(len(part)):
        found += part[t, 0]
    sums[place] = found
