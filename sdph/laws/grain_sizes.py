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


@law
def of_moments(second, third):
    """Number mean [m] and variance [m2] of the log-normal whose mean d^2 [m2] and mean d^3 [m3] by number are these:
    number, surface and volume of the drops that it stands for are exact, the sum of d is not (swirl-sheet.md, 9)."""
    spread = (third**2 / second**3) ** (1.0 / 3.0)  # 1 + (std/mean)^2, no less than 1 by Jensen's inequality
    return (second / spread) ** 0.5, second / spread * max(0.0, spread - 1.0)
