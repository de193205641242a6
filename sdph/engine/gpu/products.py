"""Kernels of scalar products, whose values stay on the device: threads add up in one order, which no card changes."""

from __future__ import annotations

from sdph.engine.gpu.toolkit import cuda, kernel


@kernel
def multiply(a, others, part):
    """part (T, K): sums of a b over every T-th row, of each of T threads; others: K arrays b (N,)."""
    t = cuda.grid(1)
    for c in range(len(others)):
        found = 0.0
        for i in range(t, len(a), len(part)):
            found += a[i] * others[c][i]
        part[t, c] = found


@kernel
def put(part, sums, places):
    """Sums of the columns of part (T, K), at their places among sums; one thread."""
    for c in range(len(places)):
        found = 0.0
        for t in range(len(part)):
            found += part[t, c]
        sums[places[c]] = found
