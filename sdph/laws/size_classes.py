"""Distributions of drop sizes cut into classes of equal mass, each with the mass, surface and number of its part.

`rosin_rammler` has its share of the mass in drops above d as exp(-(d/X)^q) (Rosin & Rammler 1933, J. Inst. Fuel 7, 29;
Lefebvre & McDonell 2017, Atomization and Sprays, ch. 3); X has 36.8 % of the mass above it, q is some 1.5 to 4. The
number of drops, the mean of d^-3 by mass, is finite only from a smallest drop on: one must be given. `log_normal` is
that of sdph.laws.grain_sizes.
"""

from __future__ import annotations

import itertools
import math
from statistics import NormalDist

import numpy as np

from sdph.laws import grain_sizes

NOTHING = 40.0  # of (d/X)^q beyond that of the smallest drop: 4e-18 of the mass is above, less than round-off
NODES, PANEL = 16, 1.0  # of the Gauss-Legendre rule, and how much of ln t is under it: moments to 1e-10 (tests/laws)


def rosin_rammler(size: float, exponent: float, least: float, most: float, classes: int) -> list[tuple[float, float]]:
    """Number mean [m] and variance [m2] of each class of equal mass, from X [m], q, smallest and largest drop [m]."""
    low = (least / size) ** exponent
    high = min((most / size) ** exponent, low + NOTHING)
    return [of_means(*_means(*part, size, exponent)) for part in zip(*_cuts(low, high, classes))]


def cut_away(size: float, exponent: float, least: float, most: float) -> tuple[float, float]:
    """Shares of the mass of the whole distribution in drops below the smallest and above the largest [m]."""
    return -math.expm1(-((least / size) ** exponent)), math.exp(-((most / size) ** exponent))


def _cuts(low: float, high: float, classes: int) -> tuple[np.ndarray, np.ndarray]:
    """Begin and end of each class of equal mass, in t = (d/X)^q: the mass above t is exp(-t)."""
    begin = low - np.log1p(np.arange(classes) / classes * math.expm1(low - high))
    return begin, np.append(begin[1:], high)


def _means(low: float, high: float, size: float, exponent: float) -> tuple[float, float]:
    """Means by mass of d^-3 [m^-3] and d^-1 [1/m] of the drops between two t."""
    nodes, weights = np.polynomial.legendre.leggauss(NODES)
    panels = math.ceil(math.log(high / low) / PANEL)
    edges = np.linspace(math.log(low), math.log(high), panels + 1)
    half = 0.5 * np.diff(edges)[:, None]
    t = np.exp(0.5 * (edges[1:] + edges[:-1])[:, None] + half * nodes)
    mass = half * weights * t * np.exp(-t)
    d = size * t ** (1.0 / exponent)
    return float((mass / d**3).sum() / mass.sum()), float((mass / d).sum() / mass.sum())


def log_normal(mean: float, std: float, classes: int) -> list[tuple[float, float]]:
    """The same of a log-normal of number mean and standard deviation [m]; it has neither a smallest nor a largest."""
    if classes == 1 or std == 0.0:
        return [(mean, std**2)] * classes
    m, s = grain_sizes.log_mean(mean, std), grain_sizes.log_std(mean, std)
    inner = [NormalDist().inv_cdf(k / classes) for k in range(1, classes)]
    edges = [-math.inf, *inner, math.inf]  # of (ln d - m)/s - 3 s, which is normal by mass
    found = []
    for low, high in itertools.pairwise(edges):
        number, surface = (_between(low + shift * s, high + shift * s) for shift in (3.0, 1.0))
        third, first = math.exp(-3.0 * m - 4.5 * s * s), math.exp(-m - 2.5 * s * s)
        found.append(of_means(classes * number * third, classes * surface * first))
    return found


def _between(low: float, high: float) -> float:
    """Share of a normal distribution between two values, without loss of digits in its tails."""
    if low > 0.0:
        low, high = -high, -low
    return 0.5 * (math.erfc(-high / math.sqrt(2.0)) - math.erfc(-low / math.sqrt(2.0)))


def of_means(inverse_cube: float, inverse: float) -> tuple[float, float]:
    """Number mean [m] and variance [m2] of the log-normal with these means of d^-3 [m^-3] and d^-1 [1/m] by mass."""
    return grain_sizes.of_moments(inverse / inverse_cube, 1.0 / inverse_cube)
