"""Liquid at rest that meets walls at a contact angle, in two dimensions: a drop on a plate, the surface between two
plates. Plain Python, not compiled."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import scipy

NODES = 2001  # of a meniscus, evenly spaced in its slope: 1e-9 of its height
FLAT = 1e-9  # rad: a surface that leans less is level


class Segment(NamedTuple):
    """Part of a disc: height, width of its base [m], mean square of the distance from its middle along the base
    [m2]."""

    height: float
    base: float
    spread: float


def segment(angle: float, area: float) -> Segment:
    """The segment of a disc that has an area [m2] and meets its base at an angle [rad]: a drop on a plate without
    gravity, as the pressure of its surface, sigma/R, is one everywhere."""
    sine, cosine = math.sin(angle), math.cos(angle)
    radius = math.sqrt(area / (angle - sine * cosine))
    fourth = 0.375 * angle - 0.25 * math.sin(2.0 * angle) + math.sin(4.0 * angle) / 32.0  # integral of sin^4
    return Segment(radius * (1.0 - cosine), 2.0 * radius * sine, 2.0 / 3.0 * radius**4 * fourth / area)


def meniscus(angle: float, half: float, length: float) -> tuple[np.ndarray, np.ndarray]:
    """(distance from the middle [m], height over the middle [m]) of a surface between two plates, `half` [m] from their
    middle, that it meets at a contact angle [rad]; length = sqrt(sigma/(rho g)) [m].

    d(sin phi)/dx = z/l^2, phi its slope, z its height over where the pressure is that of the gas, so that
    z^2 = z_0^2 + 2 l^2 (1 - cos phi) and dx = l^2 cos phi dphi/z. Landau & Lifshitz, Fluid Mechanics, section 61.
    """
    steepest = 0.5 * math.pi - angle
    if abs(steepest) < FLAT:
        return np.linspace(0.0, half, NODES), np.zeros(NODES)
    slope = np.linspace(0.0, abs(steepest), NODES)

    def along(lowest):
        height = np.sqrt(lowest**2 + 2.0 * (1.0 - np.cos(slope)))  # in l
        return scipy.integrate.cumulative_simpson(np.cos(slope) / height, x=slope, initial=0.0), height - lowest

    lowest = math.exp(scipy.optimize.brentq(lambda log: along(math.exp(log))[0][-1] - half / length, -12.0, 12.0))
    x, rise = along(lowest)
    return length * x, math.copysign(length, steepest) * rise
