"""Log-normal grain sizes: moments, means, quadrature, and how many grains an SPH particle stands for.

ln d is normal with mean m and standard deviation s, by *number*. Weighted by mass (d^3) it is again normal with the
same s and mean m + 3 s^2. So one Gauss-Hermite rule serves both:

    sum_i w_i f(exp(m + s x_i)) = number mean of f(d),   with x, w = gauss_hermite(n) computed once.

References: Aitchison & Brown 1957, The Lognormal Distribution; Crowe et al. 2012, Multiphase Flows, ch. 3.
"""

from __future__ import annotations

import math

import numpy as np

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
def mass_log_mean(mean, std):
    """m + 3 s^2: mean of ln d by mass (Hatch & Choate 1929); exp of it is the mass median diameter."""
    return math.log(mean) + 2.5 * log_std(mean, std) ** 2


@law
def raw_moment(order, mean, std):
    """<d^k> by number [m^k] = mean^k (1 + (std/mean)^2)^(k(k-1)/2), k = `order`."""
    return mean**order * math.exp(0.5 * order * (order - 1.0) * log_std(mean, std) ** 2)


@law
def mass_moment(order, mean, std):
    """<d^k> by mass or volume [m^k] = <d^(k+3)>/<d^3> by number = mean^k (1 + (std/mean)^2)^(k(k+5)/2)."""
    return mean**order * math.exp(0.5 * order * (order + 5.0) * log_std(mean, std) ** 2)


@law
def sauter_diameter(mean, std):
    """d_32 [m] = <d^3>/<d^2> = mean (1 + (std/mean)^2)^2: same surface per volume as the whole."""
    return mean * math.exp(2.0 * log_std(mean, std) ** 2)


@law
def sphere_mass(density, mean, std):
    """Mean mass per grain [kg] = rho pi/6 <d^3>."""
    return density * math.pi / 6.0 * raw_moment(3.0, mean, std)


@law
def disc_mass(density, mean, std):
    """Mean mass per grain and metre of depth [kg/m] = rho pi/4 <d^2>: grains counted as discs (paper, 2-D)."""
    return density * math.pi / 4.0 * raw_moment(2.0, mean, std)


def gauss_hermite(n: int) -> tuple[np.ndarray, np.ndarray]:
    """Nodes x (n,) and weights w (n,), sum 1, of the standard normal: exact for polynomials in ln d of degree 2n-1."""
    x, w = np.polynomial.hermite.hermgauss(n)
    return math.sqrt(2.0) * x, w / math.sqrt(math.pi)


@law
def diameter_at(x, m, s):
    """Diameter [m] at the node x [-]: exp(m + s x), m = `log_mean` for averages over grains, `mass_log_mean` over
    mass."""
    return math.exp(m + s * x)


def number_quadrature(mean: float, std: float, n: int) -> tuple[np.ndarray, np.ndarray]:
    """Diameters (n,) [m] and weights (n,): sum w f(d) is the mean of f over grains."""
    x, w = gauss_hermite(n)
    return np.exp(log_mean(mean, std) + log_std(mean, std) * x), w


def mass_quadrature(mean: float, std: float, n: int) -> tuple[np.ndarray, np.ndarray]:
    """Diameters (n,) [m] and weights (n,): sum w f(d) is the mean of f over mass, such as of the drag per mass R'^k."""
    x, w = gauss_hermite(n)
    return np.exp(mass_log_mean(mean, std) + log_std(mean, std) * x), w


def particle_mass(alpha_p: float, density: float, spacing: float, dims: int) -> float:
    """Mass of an SPH particle [kg; kg per metre of depth in 2-D] = alpha_p rho_p dx^dims."""
    return alpha_p * density * spacing**dims


def sphere_count(alpha_p: float, spacing: float, dims: int, mean: float, std: float = 0.0) -> float:
    """Grains in an SPH particle (per metre of depth in 2-D) that give its mass back as spheres."""
    return particle_mass(alpha_p, 1.0, spacing, dims) / sphere_mass(1.0, mean, std)


def disc_count(alpha_p: float, spacing: float, mean: float, std: float = 0.0) -> float:
    """Grains in a 2-D SPH particle that give its mass back as discs of unit depth."""
    return particle_mass(alpha_p, 1.0, spacing, 2) / disc_mass(1.0, mean, std)


def paper_count(alpha_p: float, spacing: float, diameter: float) -> float:
    """alpha_p dx^2/d^2 [-], the count that Chen et al. 2014 report: pi/4 too small to give the mass back."""
    return alpha_p * (spacing / diameter) ** 2
