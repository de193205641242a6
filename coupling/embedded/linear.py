"""Implicit exchange between neighbours: (D + sum K) x_c - sum K x_nb = b on any padded field, by conjugate gradients."""

from __future__ import annotations

import numpy as np
from numba import njit

ITERATIONS = 500  # of a solver; our choice: far above what any case of ours needed


def not_converged(name: str, time: float, residual: float) -> str:
    """What to say of an equation whose solver gave up."""
    return f"embedded gas solver: {name} did not converge at t = {time:g} s, residual {residual:.1e}; shorten the window"


@njit(cache=True, error_model="numpy")
def fill(field, ghosts):
    """Set the ghosts of a field: the value where pinned, else that of the node."""
    ghost, node, pinned, value = ghosts
    for n in range(len(ghost)):
        field[ghost[n]] = value[n] if pinned[n] else field[node[n]]


@njit(error_model="numpy")
def coupled(conductance, steps, x, c):
    """sum K of a node, and sum K x over its neighbours."""
    total, weighted = 0.0, 0.0
    for a in range(len(steps)):
        s = steps[a]
        lower, upper = conductance[a, c], conductance[a, c + s]
        total += lower + upper
        weighted += lower * x[c - s] + upper * x[c + s]
    return total, weighted


@njit(error_model="numpy")
def _begin(wide, active, conductance, diagonal, source, x, inverse, r, p):
    """Inverse diagonal, residual and first direction; returns r.p and the largest |x|."""
    rows, run, steps = wide
    largest, rho = 0.0, 0.0
    for row in rows:
        for c in range(row, row + run):
            total, weighted = coupled(conductance, steps, x, c)
            inverse[c] = 1.0 / (diagonal[c] + total) if active[c] else 0.0
            r[c] = source[c] + weighted - (diagonal[c] + total) * x[c] if active[c] else 0.0
            p[c] = inverse[c] * r[c]
        for c in range(row, row + run):
            rho += r[c] * p[c]
            largest = max(largest, abs(x[c] + p[c]))
    return rho, largest


@njit(error_model="numpy")
def _worst(wide, active, r, diagonal):
    """Largest change that `_settle` would make."""
    rows, run, _ = wide
    worst = 0.0
    for row in rows:
        for c in range(row, row + run):
            change = abs(r[c]) / diagonal[c] if active[c] else 0.0
            worst = max(worst, change)
    return worst


@njit(error_model="numpy")
def _apply(wide, active, conductance, diagonal, p, q):
    """q = A p, and p.q."""
    rows, run, steps = wide
    curvature = 0.0
    for row in rows:
        for c in range(row, row + run):
            total, weighted = coupled(conductance, steps, p, c)
            q[c] = (diagonal[c] + total) * p[c] - weighted if active[c] else 0.0
        for c in range(row, row + run):
            curvature += p[c] * q[c]
    return curvature


@njit(error_model="numpy")
def _iterate(wide, active, conductance, diagonal, rho, x, inverse, r, p, q):
    """One step of conjugate gradients with the diagonal as preconditioner; returns r.z."""
    rows, run, _ = wide
    step, new = rho / _apply(wide, active, conductance, diagonal, p, q), 0.0
    for row in rows:
        for c in range(row, row + run):
            x[c] += step * p[c]
            r[c] -= step * q[c]
        for c in range(row, row + run):
            new += r[c] * r[c] * inverse[c]
    for row in rows:
        for c in range(row, row + run):
            p[c] = inverse[c] * r[c] + new / rho * p[c]
    return new


@njit(error_model="numpy")
def _settle(wide, active, conductance, diagonal, source, x, through):
    """What every face lets through upwards, and x = (source + what came in)/D."""
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


@njit(cache=True, error_model="numpy")
def solve_implicit(wide, active, conductance, diagonal, source, x, tolerance):
    """Solve D x + sum K (x - x_nb) = source on the active nodes, in place; other nodes of x are given values.

    conductance (d, S) and diagonal (S,) in the same unit, source (S,) in that times x. Returns what every face let
    through upwards, K (x*_lower - x*_upper), (d, S), and the largest residual over D relative to the largest |x|.
    The last act writes x = (source + sum K (x*_nb - x*))/D, x* being the iterate: what neighbours give each other
    then cancels to round-off whatever the tolerance, and so does what D x exchanges with particles.
    """
    inverse, r, p, q = np.zeros_like(x), np.zeros_like(x), np.zeros_like(x), np.zeros_like(x)
    through = np.zeros_like(conductance)
    rho, largest = _begin(wide, active, conductance, diagonal, source, x, inverse, r, p)
    worst = _worst(wide, active, r, diagonal)
    for _ in range(ITERATIONS):
        if not worst > tolerance * largest:
            break
        rho = _iterate(wide, active, conductance, diagonal, rho, x, inverse, r, p, q)
        worst = _worst(wide, active, r, diagonal)
    _settle(wide, active, conductance, diagonal, source, x, through)
    return through, worst / largest if largest > 0.0 else 0.0
