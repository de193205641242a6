"""Moments of log-normal diameters d by their mean and standard deviation by number [m]: Aitchison & Brown 1957."""

from __future__ import annotations


def raw_moment(order: float, mean: float, std: float) -> float:
    """<d^k> by number [m^k] = mean^k (1 + (std/mean)^2)^(k(k-1)/2), k = `order`."""
    return mean**order * (1.0 + (std / mean) ** 2) ** (0.5 * order * (order - 1.0))


def mass_moment(order: float, mean: float, std: float) -> float:
    """<d^k> by mass [m^k] = <d^(k+3)>/<d^3> by number."""
    return raw_moment(order + 3.0, mean, std) / raw_moment(3.0, mean, std)
