"""Turbulence that a gas brings along, from numbers that are measured or guessed: intensity and mixing length.

The mixing length of a pipe or channel full of developed flow is 0.07 hydraulic diameters (Versteeg & Malalasekera 2007,
section 3.7.2).
"""

from __future__ import annotations

import math

C_MU = 0.09  # of k-epsilon, Launder & Spalding 1974


def kinetic_energy(speed, intensity):
    """Kinetic energy of turbulence [m2/s2]: k = 3/2 (I U)^2, of an intensity I = u'/U alike in all directions.

    Versteeg & Malalasekera 2007, section 3.7.2. Mean speed U [m/s].
    """
    return 1.5 * (intensity * speed) ** 2


def dissipation(energy, length):
    """Dissipation rate [m2/s3]: epsilon = C_mu^(3/4) k^(3/2)/l, C_mu = 0.09.

    Launder & Spalding 1974, Comput. Methods Appl. Mech. Eng. 3, 269. k [m2/s2], mixing length l [m].
    """
    return C_MU**0.75 * energy**1.5 / length


def frequency(energy, length):
    """Specific dissipation rate [1/s]: omega = sqrt(k)/(C_mu^(1/4) l), which is epsilon/(C_mu k).

    Wilcox 2006, Turbulence Modeling for CFD, section 4.3. k [m2/s2], mixing length l [m].
    """
    return math.sqrt(energy) / (C_MU**0.25 * length)
