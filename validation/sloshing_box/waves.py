"""Level of an ideal liquid in a box that is moved sideways: level and surface potential in cosines, the vertical speed
by expansion about the level at rest (Dommermuth & Yue 1987, J. Fluid Mech. 184, 267).

Of the tank of `shaken.py` the first four crests are the same within 1 % with 12 to 16 modes and orders 3 to 6; the
fifth is 0.13 to 0.16 m, and with 18 modes or more the expansion fails after the steep second crest.
"""

from __future__ import annotations

import math

import numpy as np

MODES, ORDER, STEP = 14, 5, 2.5e-3  # cosines, powers of the level, s: see above


def level(length, depth, gravity, shaken, end, place):
    """Times (N,) [s] and levels (N,) [m] over that at rest at `place` [m] from a wall, up to `end` [s]; length, depth
    of the liquid [m], `shaken(t)` [m/s2] the acceleration of the box."""
    count = 2 * MODES  # points: products of two sums have no wave that is taken for another
    x = (np.arange(count) + 0.5) * length / count
    k = np.arange(MODES) * math.pi / length
    cosine, sine, rise = np.cos(np.outer(x, k)), np.sin(np.outer(x, k)), np.tanh(k * depth)
    share = np.full(MODES, 2.0 / count)
    share[0] *= 0.5

    def modes(values):
        return share * (cosine.T @ values)

    def rates(eta, surface, t):
        potential = [modes(surface)]  # at the level at rest, order by order
        for m in range(1, ORDER):
            known = sum(_power(eta, n) * (cosine @ (_normal(k, rise, n) * potential[m - n])) for n in range(1, m + 1))
            potential.append(modes(-known))
        up = sum(
            _power(eta, n) * (cosine @ (_normal(k, rise, n + 1) * potential[m - n]))
            for m in range(ORDER)
            for n in range(m + 1)
        )
        slope, along = -sine @ (k * modes(eta)), -sine @ (k * modes(surface))
        steep = 1.0 + slope**2
        pressed = -gravity * eta - 0.5 * along**2 + 0.5 * steep * up**2 - shaken(t) * (x - 0.5 * length)
        return np.stack([cosine @ modes(steep * up - slope * along), cosine @ modes(pressed)])

    times, state = np.arange(0.0, end + 0.5 * STEP, STEP), np.zeros((2, count))
    found = np.empty(len(times))
    for each, t in enumerate(times):
        found[each] = modes(state[0]) @ np.cos(k * place)
        first = rates(*state, t)
        second = rates(*(state + 0.5 * STEP * first), t + 0.5 * STEP)
        third = rates(*(state + 0.5 * STEP * second), t + 0.5 * STEP)
        state = state + STEP / 6.0 * (first + 2.0 * (second + third) + rates(*(state + STEP * third), t + STEP))
    return times, found


def _power(eta, n: int):
    """Factor of the n-th derivative in Taylor's series."""
    return eta**n / math.factorial(n)


def _normal(k, rise, n: int):
    """n-th derivative upwards of cosh(k (z + depth))/cosh(k depth) at the level at rest."""
    return k**n * (rise if n % 2 else 1.0)
