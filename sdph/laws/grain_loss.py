"""Evaporation of a distribution of sizes: each grain by its own rate, the small ones vanish first.

With the Ranz-Marshall number, Sh = 2 (1 + c sqrt(d)), the square D = d^2 of a diameter falls as

    dD/dt = -a (1 + c D^(1/4)),     so     G(D, c) = G(D_0, c) - integral of a dt,
    G(D, c) = integral_0^D dD/(1 + c D^(1/4)) = D g(c D^(1/4)),     g(x) = integral_0^1 4 t^3/(1 + x t) dt.

In still gas (c = 0) this is the d^2 law, G = D. c [m^-1/2] = 0.3 (rho_g s/mu_g)^1/2 Sc^1/3.
"""

from __future__ import annotations

import math

import numpy as np

from sdph.laws.compiled import law
from sdph.laws.constants import CONVERGED

NODES = 8  # of the Gauss-Jacobi rule of g: relative error below 1e-6 for x up to 30; our choice
NEWTON_STEPS = 50  # Newton's iteration ends long before: it is monotone, its error squares


def _jacobi() -> tuple[np.ndarray, np.ndarray]:
    """Nodes and weights on [0, 1] for the weight 4 t^3: eigenvalues and vectors of the recurrence of Jacobi's
    polynomials with exponents 0 and 3 (Golub & Welsch 1969, Math. Comput. 23, 221). scipy.special has them too, and
    takes 0.3 s to import."""
    k, b = np.arange(NODES), 3.0
    middle = b * b / ((2 * k + b) * (2 * k + b + 2))
    beside = 2.0 * k * (k + b) / ((2 * k + b) * np.sqrt((2 * k + b + 1) * (2 * k + b - 1)))
    x, vectors = np.linalg.eigh(np.diag(middle) + np.diag(beside[1:], 1) + np.diag(beside[1:], -1))
    return 0.5 * (x + 1.0), vectors[0] ** 2


_T, _W = _jacobi()


@law
def loss_scale(square, c):
    """G [m2] of D = d^2 [m2] and c [m^-1/2]."""
    x, total = c * math.sqrt(math.sqrt(square)), 0.0
    for k in range(NODES):
        total += _W[k] / (1.0 + x * _T[k])
    return square * total


@law
def square_of_scale(scale, c):
    """D [m2] of G [m2]: Newton's iteration from below, where G is concave and it cannot overshoot; 0 for scale <= 0."""
    square = max(0.0, scale)
    if c == 0.0 or square == 0.0:
        return square
    for _ in range(NEWTON_STEPS):
        step = (scale - loss_scale(square, c)) * (1.0 + c * math.sqrt(math.sqrt(square)))
        square += step
        if abs(step) <= CONVERGED * square:
            break
    return square


@law
def square_after(square, loss, c):
    """D [m2] after a loss of integral a dt [m2]; exactly 0 once it is gone."""
    return square_of_scale(loss_scale(square, c) - loss, c)


@law
def ventilation(reynolds_per_diameter, schmidt):
    """c [m^-1/2]: Sh = 2 (1 + c sqrt(d)) is Ranz & Marshall's 2 + 0.6 Re^1/2 Sc^1/3; rho_g s/mu_g [1/m]."""
    return 0.3 * math.sqrt(reynolds_per_diameter) * schmidt ** (1.0 / 3.0)
