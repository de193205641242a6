"""Implicit exchange between neighbours: (D + sum K) x_c - sum K x_nb = b on any padded field, by conjugate
gradients."""

from __future__ import annotations

import numpy as np

from sdph.laws.compiled import serial

ITERATIONS = 500  # of a solver; our choice: far above what any case of ours needed
NOTHING = float(np.finfo(float).tiny / np.finfo(float).eps)  # a field below this has residuals without digits


def not_converged(name: str, time: float, residual: float) -> str:
    """Message of an equation whose solver gave up."""
    return (
        f"embedded gas solver: {name} did not converge at t = {time:g} s, residual {residual:.1e}; shorten the window"
    )


@serial
def fill(field, ghosts):
    """Set the ghosts of a field: the value where pinned, else that of the node."""
    ghost, node, pinned, value = ghosts
    for n in range(len(ghost)):
        field[ghost[n]] = value[n] if pinned[n] else field[node[n]]


@serial
def coupled(conductance, steps, x, c):
    """sum K of a node, and sum K x over its neighbours."""
    total, weighted = 0.0, 0.0
    for a in range(len(steps)):
        s = steps[a]
        lower, upper = conductance[a, c], conductance[a, c + s]
        total += lower + upper
        weighted += lower * x[c - s] + upper * x[c + s]
    return total, weighted


@serial
def worst(nodes, r, scale):
    """Largest |r| over scale."""
    rows, run, _ = nodes
    found = 0.0
    for row in rows:
        for c in range(row, row + run):
            found = max(found, abs(r[c]) / scale[c])
    return found


@serial
def iterate(nodes, conductance, diagonal, rho, first, x, r, z, p, q):
    """One step of preconditioned conjugate gradients on x (S,), z (S,) being about A^-1 r, times any number, 0 on
    nodes that are given; returns r.z."""
    rows, run, steps = nodes
    new, curvature = 0.0, 0.0
    for row in rows:
        for c in range(row, row + run):
            new += r[c] * z[c]
    share = 0.0 if first else new / rho
    for row in rows:
        for c in range(row, row + run):
            p[c] = z[c] + share * p[c]
    for row in rows:
        for c in range(row, row + run):
            total, weighted = coupled(conductance, steps, p, c)
            q[c] = (diagonal[c] + total) * p[c] - weighted
        for c in range(row, row + run):
            curvature += p[c] * q[c]
    step = new / curvature
    for row in rows:
        for c in range(row, row + run):
            x[c] += step * p[c]
            r[c] -= step * q[c]
    return new


@serial
def _begin(nodes, active, conductance, diagonal, source, x, inverse, r):
    """Inverse diagonal, 0 on given nodes, and residual; returns the largest |x|."""
    rows, run, steps = nodes
    largest = 0.0
    for row in rows:
        for c in range(row, row + run):
            total, weighted = coupled(conductance, steps, x, c)
            inverse[c] = 1.0 / (diagonal[c] + total) if active[c] else 0.0
            r[c] = source[c] + weighted - (diagonal[c] + total) * x[c]
            largest = max(largest, abs(x[c] + inverse[c] * r[c]))
    return largest


@serial
def _settle(wide, active, conductance, diagonal, source, x, through):
    """Set the upward flux through every face, and x = (source + what came in)/D."""
    rows, run, steps = wide
    for a in range(len(steps)):
        s = steps[a]
        for row in rows:
            for c in range(row, row + run):
                through[a, c] = conductance[a, c] * (x[c - s] - x[c])
    for row in rows:
        for c in range(row, row + run):
            content = source[c]
            for a in range(len(steps)):
                content += through[a, c] - through[a, c + steps[a]]
            x[c] = content / diagonal[c] if active[c] else x[c]


@serial
def solve_implicit(wide, active, conductance, diagonal, source, x, tolerance):
    """Solve D x + sum K (x - x_nb) = source on the active nodes, in place; other nodes of x are given values.

    conductance (d, S) and diagonal (S,) in the same unit, source (S,) in that times x. Returns what every face let
    through upwards, K (x*_lower - x*_upper), (d, S), and the largest residual over D relative to the largest |x|.
    The last act writes x = (source + sum K (x*_nb - x*))/D, x* being the iterate: what neighbours give each other
    then cancels to round-off whatever the tolerance, and so does what D x exchanges with particles. Products of
    residuals are taken over the largest |x|: a field that has died away to 1e-160 would have squares that are 0.
    """
    inverse, r, z, p, q = np.zeros_like(x), np.zeros_like(x), np.zeros_like(x), np.zeros_like(x), np.zeros_like(x)
    through, scale, rho = np.zeros_like(conductance), np.where(active, diagonal, np.inf), 0.0
    largest = _begin(wide, active, conductance, diagonal, source, x, inverse, r) + NOTHING
    error = worst(wide, r, scale)
    for iteration in range(ITERATIONS):
        if not error > tolerance * largest:
            break
        z[:] = inverse * r / largest
        rho = iterate(wide, conductance, diagonal, rho, iteration == 0, x, r, z, p, q)
        error = worst(wide, r, scale)
    _settle(wide, active, conductance, diagonal, source, x, through)
    return through, error / largest
