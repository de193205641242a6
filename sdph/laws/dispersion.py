"""Dispersion of grains and droplets by the eddies of a turbulent gas that is known by k and epsilon alone.

Eddies push a particle by u' = sigma n in each direction, sigma^2 = 2k/3, n an Ornstein-Uhlenbeck process of variance 1
and memory T: dn = -n dt/T + d(sigma)/dx dt + sqrt(2/T) dW (Wilson, Legg & Thomson 1983, Boundary-Layer Meteorol. 27,
163: the drift keeps what is evenly mixed so). What follows the gas then spreads by Taylor's law (1921, Proc. London
Math. Soc. 20, 196), <x^2> = 2 sigma^2 T^2 (t/T - 1 + exp(-t/T)).
"""

import math

import numpy as np

from sdph.laws.compiled import law

LIFETIME = 0.15  # -, Lagrangian time scale over k/epsilon: Fluent's default (theory guide, discrete random walk)
CROSSING = 0.45  # -, of the slip in the time that a particle stays in eddies: Deutsch & Simonin 1991, ASME FED 110, 35
SMALL = 0.1  # of the window over the memory: below it a power series holds to 1e-8, where a difference loses digits

# Steele, Lea & Flood 2014, OOPSLA: splitmix64
GOLDEN, FIRST, SECOND = np.uint64(0x9E3779B97F4A7C15), np.uint64(0xBF58476D1CE4E5B9), np.uint64(0x94D049BB133111EB)
THIRTY, TWENTY_SEVEN, THIRTY_ONE, ELEVEN = (np.uint64(bits) for bits in (30, 27, 31, 11))
UNIT = 2.0**-53


@law
def fluctuation(k):
    """sigma [m/s] of the gas's velocity in each direction, sqrt(2k/3)."""
    return math.sqrt(2.0 * k / 3.0)


@law
def memory(k, epsilon, slip, lifetime):
    """T [s] for which a particle feels one eddy: lifetime k/epsilon of one that goes with the gas, shorter by
    sqrt(1 + 0.45 s^2/sigma^2) of one that falls through eddies at a slip s [m/s]. Deutsch & Simonin 1991."""
    return lifetime * k / epsilon / math.sqrt(1.0 + CROSSING * slip**2 / (2.0 * k / 3.0))


@law
def kept(x):
    """Share exp(-x) of n that is left after x = dt/T."""
    return math.exp(-x)


@law
def kept_in_mean(x):
    """Share (1 - exp(-x))/x of n that is in its mean over x = dt/T."""
    return -math.expm1(-x) / x if x > 0.0 else 1.0


@law
def spread(x):
    """Standard deviation of n after x = dt/T, sqrt(1 - exp(-2x))."""
    return math.sqrt(-math.expm1(-2.0 * x))


@law
def spreads_of_mean(x):
    """Parts of the standard deviation of the mean of n over x = dt/T: along that of n at its end,
    (1 - exp(-x))/x sqrt(tanh(x/2)), and apart from it, sqrt(2x - 4 tanh(x/2))/x.

    From variance (2x - 3 + 4 exp(-x) - exp(-2x))/x^2 and covariance (1 - exp(-x))^2/x of Gillespie 1996, Phys. Rev. E
    54, 2084.
    """
    half = math.tanh(0.5 * x)
    series = x * (1.0 / 6.0 - x**2 / 60.0 + 17.0 * x**4 / 10080.0)
    square = series if x < SMALL else (2.0 * x - 4.0 * half) / x**2
    return kept_in_mean(x) * math.sqrt(half), math.sqrt(square)


@law
def scrambled(word):
    """Word of 64 bits whose bits are mixed (splitmix64)."""
    word = (word ^ (word >> THIRTY)) * FIRST
    word = (word ^ (word >> TWENTY_SEVEN)) * SECOND
    return word ^ (word >> THIRTY_ONE)


@law
def two_normal(word):
    """Two independent normal numbers of a word of 64 bits (Box & Muller 1958)."""
    first = (scrambled(word + GOLDEN) >> ELEVEN) * UNIT
    second = (scrambled(word + GOLDEN + GOLDEN) >> ELEVEN) * UNIT
    size = math.sqrt(-2.0 * math.log(1.0 - first))
    return size * math.cos(2.0 * math.pi * second), size * math.sin(2.0 * math.pi * second)
