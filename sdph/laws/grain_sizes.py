"""Log-normal grain sizes: ln d is normal with mean m and standard deviation s, by *number*.

Weighted by mass (d^3) it is again normal, with the same s and mean m + 3 s^2 (Hatch & Choate 1929). References:
Aitchison & Brown 1957, The Lognormal Distribution; Crowe et al. 2012, Multiphase Flows, ch. 3.
"""

import math

from sdph.laws.compiled import law


@law
def log_std(mean, std):
    """s [-] = sqrt(ln(1 + (std/mean)^2)) from number mean and standard deviation of d [m]."""
    return math.sqrt(math.log1p((std / mean) ** 2))


@law
def log_mean(mean, std):
    """m = ln(mean) - s^2/2 (d in m): mean of ln d by number; exp(m) is the median diameter."""
    return math.log(mean) - 0.5 * log_std(mean, std) ** 2
