"""Droplets of a spray that burst: heat from the rim to a bubble in the middle, flash of what is superheated, droplets
that a torn wall makes.

One temperature stands for a droplet, as in SDPH: the mean of the gel between a bubble and the rim. Where the profile
has settled (after R^2/(pi^2 alpha); the droplet warms evenly then) the bubble's temperature follows from it and from
the heat that comes in. Lengths are those of one droplet, a sphere.
"""

import math

from sdph.laws import grain_sizes
from sdph.laws.compiled import law

RAYLEIGH = 1.89  # diameter of a drop over that of the ligament that breaks into it: Rayleigh 1878, Proc. L. M. S. 10, 4


@law
def lags(inner, outer, conductivity):
    """(a, b) [K/W] of T_mean - T(inner) = a (P - Q) + b Q: heat P [W] into the rim, Q out into the bubble.

    Shell of gel between two radii [m] that warms evenly: k (r^2 T')' = s r^2 with s = (P - Q)/V [W/m3]. Means by
    volume: <r^2> = 3/5 (R^5 - r^5)/(R^3 - r^3), <1/r> = 3/2 (R^2 - r^2)/(R^3 - r^3). Carslaw & Jaeger
    1959, ch. 9 (settled part of the solution for a constant flux).
    """
    cubes = outer**3 - inner**3
    squared, inverse = 0.6 * (outer**5 - inner**5) / cubes, 1.5 * (outer * outer - inner * inner) / cubes
    warming = 0.5 * (squared - inner * inner) + inner**3 * (inverse - 1.0 / inner)
    around = 4.0 * math.pi * conductivity
    return warming / (around * cubes), (1.0 / inner - inverse) / around


@law
def flashed_share(heat_capacity, cooling, latent_heat):
    """Share of its mass [-] that a liquid boils off as it cools by so much [K]: 1 - exp(-c dT/L).

    m c dT = L dm, the vapour leaves at the temperature of the moment; c [J/(kg K)] and L [J/kg] constant. The heat of
    the first moment alone, c dT/L, would be a Jakob number, and more than all of it where dT > L/c.
    """
    return -math.expm1(-heat_capacity * cooling / latent_heat)


@law
def opening_time(radius, wall, tension, density):
    """Time [s] in which a torn wall [m] draws back over `radius` [m]: R/sqrt(2 sigma/(rho wall)).

    Taylor 1959, Proc. R. Soc. A 253, 313; Culick 1960, J. Appl. Phys. 31, 1128. tension sigma [N/m], density [kg/m3].
    """
    return radius / math.sqrt(2.0 * tension / (density * wall))


@law
def film_droplet(wall):
    """Diameter [m] of the droplets that a torn wall [m] makes: ligaments as thick as it is, broken by Rayleigh's law.

    That ligaments are as thick as the wall is our choice: no measurement of bursting gel droplets gives sizes.
    """
    return RAYLEIGH * wall


@law
def torn(second, third, thrown, ratio):
    """Droplets that one becomes when it tears, and mean d^2 [m2] and d^3 [m3] by number after it, from those before.

    A share `thrown` of its liquid becomes droplets of `ratio` times its diameter, thrown/ratio^3 of them; one droplet
    of the rest remains. The mass stays: number times mean d^3.
    """
    small = thrown / ratio**3
    remains, left = (1.0, 1.0 - thrown) if thrown < 1.0 else (0.0, 0.0)
    number = small + remains
    surface = thrown / ratio + (left ** (2.0 / 3.0) if left > 0.0 else 0.0)
    return number, second * surface / number, third / number


@law
def sauter(mean, variance):
    """<d^3>/<d^2> [m] of a log-normal with number mean [m] and variance [m2]. Aitchison & Brown 1957."""
    return mean * (1.0 + variance / (mean * mean)) ** 2


@law
def raw_moments(mean, variance):
    """(<d^2> [m2], <d^3> [m3]) by number of the same."""
    spread = 1.0 + variance / (mean * mean)
    return mean * mean * spread, (mean * spread) ** 3


@law
def torn_sizes(mean, variance, thrown, ratio):
    """Droplets that one becomes, number mean [m] and variance [m2] after it: the log-normal with the number, surface
    and volume of `torn`; the sum of the diameters is not kept (`grain_sizes.of_moments`)."""
    second, third = raw_moments(mean, variance)
    number, second, third = torn(second, third, thrown, ratio)
    mean, variance = grain_sizes.of_moments(second, third)
    return number, mean, variance
