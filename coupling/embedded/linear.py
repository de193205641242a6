"""Implicit exchange between neighbours: (D + sum K) x_c - sum K x_nb = b on any padded field, by conjugate gradients."""

from __future__ import annotations

import numpy as np
from numba import njit

IMPLICIT = 1e-12  # relative tolerance of velocity, temperature and vapour; our choice
ITERATIONS = 500  # of a solver; our choice: far above what any case of ours needed


@njit(cache=True, error_model="numpy")
def fill(field, ghosts):
    """Set the ghosts of a field: the value where pinned, else that of the node."""
    ghost, node, pinned, value = ghosts
    for n in range(len(ghost)):
        field[ghost[n]] = value[n] if pinned[n] else field[node[n]]


@njit(error_model="numpy")
def coupled(conductance, strides, x, c):
    """sum K of a node, and sum K x over its neighbours."""
    total = 0.0
    weighted = 0.0
    for a in range(len(strides)):
        s = strides[a]
        lower, upper = conductance[a, c], conductance[a, c + s]
        total += lower + upper
        weighted += lower * x[c - s] + upper * x[c + s]
    return total, weighted


@njit(error_model="numpy")
def _dot(rows, run, a, b):
    total = 0.0
    for row in rows:
        for c in range(row, row + run):
            total += a[c] * b[c]
    return total


@njit(error_model="numpy")
def _let_through(rows, run, strides, active, conductance, x):
    through = np.zeros_like(conductance)
    for row in rows:
        for c in range(row, row + run):
            if active[c]:
                for a in range(len(strides)):
                    s = strides[a]
                    through[a, c] = conductance[a, c] * (x[c - s] - x[c])
                    through[a, c + s] = conductance[a, c + s] * (x[c] - x[c + s])
    return through


@njit(cache=True, error_model="numpy")
def solve_implicit(rows, run, strides, active, conductance, diagonal, source, x, tolerance):
    """Solve D x + sum K (x - x_nb) = source on the active nodes, in place; other nodes of x are given values.

    Conjugate gradients with the diagonal as preconditioner. conductance (d, S) and diagonal in the same unit,
    source (S,) in that times x. Returns what every face let through upwards, K (x*_lower - x*_upper), (d, S),
    the iterations, and the largest residual over the diagonal relative to the largest |x|. The last act writes x = (source + sum K (x*_nb - x*))/D, x* being the iterate: what
    neighbours give each other then cancels to round-off whatever the tolerance, and so does what D x exchanges
    with the particles.
    """
    inverse, r, p, q = np.zeros_like(x), np.zeros_like(x), np.zeros_like(x), np.zeros_like(x)
    largest = 0.0
    for row in rows:
        for c in range(row, row + run):
            if active[c]:
                total, weighted = coupled(conductance, strides, x, c)
                inverse[c] = 1.0 / (diagonal[c] + total)
                r[c] = source[c] + weighted - (diagonal[c] + total) * x[c]
                q[c] = inverse[c] * r[c]
                largest = max(largest, abs(x[c]), abs(q[c]))
    p[:] = q
    rho = _dot(rows, run, r, q)
    iterations, error = 0, np.inf
    while iterations < ITERATIONS:
        error = 0.0
        for row in rows:
            for c in range(row, row + run):
                error = max(error, abs(r[c]) * inverse[c])
        if not error > tolerance * largest:
            break
        iterations += 1
        for row in rows:
            for c in range(row, row + run):
                q[c] = 0.0
                if active[c]:
                    total, weighted = coupled(conductance, strides, p, c)
                    q[c] = (diagonal[c] + total) * p[c] - weighted
        step = rho / _dot(rows, run, p, q)
        old, rho = rho, 0.0
        for row in rows:
            for c in range(row, row + run):
                x[c] += step * p[c]
                r[c] -= step * q[c]
                rho += r[c] * r[c] * inverse[c]
        for row in rows:
            for c in range(row, row + run):
                p[c] = inverse[c] * r[c] + rho / old * p[c]
    given = _let_through(rows, run, strides, active, conductance, x)
    for row in rows:
        for c in range(row, row + run):
            if active[c]:
                content = source[c]
                for a in range(len(strides)):
                    content += given[a, c] - given[a, c + strides[a]]
                x[c] = content / diagonal[c]
    return given, iterations, error / largest if largest > 0.0 else 0.0
