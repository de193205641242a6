"""Moving-particle method: weights, the sums that they have on a lattice, and the force that pulls a surface together.

Lengths in spacings l0 throughout; d dimensions. Koshizuka & Oka 1996, Nucl. Sci. Eng. 123, 421; tension by free
energy: Kondo, Koshizuka & Takimoto 2007, Trans. JSCES 20070021. Sums are those of the square or cubic lattice.
"""

from __future__ import annotations

import itertools
import math
from typing import NamedTuple

import numpy as np

from sdph.laws.compiled import law

CLOSE = (
    0.1  # l0: at smaller distances the weight, which has a pole at 0, is that of this one; swirl-sheet.md, section 8
)
REST = 1.5  # l0, r_0: where the force of tension turns round (swirl-sheet.md, 8)


@law
def weight(r, reach):
    """w [-] = r_e/r - 1 within the reach r_e, else 0."""
    return reach / r - 1.0 if r < reach else 0.0


@law
def tension(r, reach):
    """F/C [l0^2] of a pair: (r - r_0)(r - r_t) within the reach r_t; negative, an attraction, from r_0 on."""
    return (r - REST) * (r - reach) if r < reach else 0.0


@law
def cohesion(r, reach):
    """Energy over C [l0^3] that parts a pair, 0 at the reach and beyond: minus the integral of F/C from r to r_t."""
    return (r - 1.5 * REST + 0.5 * reach) * (r - reach) ** 2 / 3.0 if r < reach else 0.0


class Lattice(NamedTuple):
    """Sums: number density n_0 [-]; lambda [l0^2], the mean r^2 by weight."""

    number: float
    spread: float


def places(reach: float, dimensions: int) -> np.ndarray:
    """(N, d) points of the lattice within the reach of the origin, that left out."""
    ticks = range(-math.floor(reach), math.floor(reach) + 1)
    points = np.array([p for p in itertools.product(ticks, repeat=dimensions) if any(p)], float)
    return points[np.linalg.norm(points, axis=1) < reach]


def lattice(reach: float, dimensions: int) -> Lattice:
    """n_0 and lambda for a reach [l0]."""
    r = np.linalg.norm(places(reach, dimensions), axis=1)
    w = reach / r - 1.0
    return Lattice(float(w.sum()), float((r**2 * w).sum() / w.sum()))


def tension_coefficient(reach: float, dimensions: int) -> float:
    """C [sigma l0^(d-4)]: what two half spaces of lattice have as energy is what their two surfaces cost,
    2 sigma l0^(d-1) = C S, S of the pairs of one column below a plane with all above it (Kondo et al. 2007, Eq. 14)."""
    points = places(reach, dimensions)
    energy = [cohesion(float(np.linalg.norm(p)), reach) for p in points]
    return 2.0 / sum(max(0.0, p[-1]) * e for p, e in zip(points, energy))


def cohesion_pressure(reach: float, dimensions: int) -> float:
    """p_c [sigma/l0], negative: the virial sum r F/(2 d l0^d) of the lattice, which the pressure of the solver carries
    besides its own."""
    own = tension_coefficient(reach, dimensions)
    r = np.linalg.norm(places(reach, dimensions), axis=1)
    return own * float(sum(x * tension(float(x), reach) for x in r)) / (2.0 * dimensions)


def film_pull(reach: float, dimensions: int) -> float:
    """Pull of a resting film of lattice over 2 sigma with C as above: half the sum over its pairs of what they pull
    along it less what they pull through it, which the pressure takes up.

    It does not hang on the thickness from r_t on. A film is pulled together, and a rim withdraws, by this; so C is
    divided by it (swirl-sheet.md, section 5, "calibrate C").
    """
    layers, own = 2 * math.ceil(reach), tension_coefficient(reach, dimensions)
    found = 0.0
    for p, height in itertools.product(places(reach, dimensions), range(layers)):
        if 0 <= height + p[-1] < layers:
            r = float(np.linalg.norm(p))
            found -= 0.5 * own * tension(r, reach) * (p[0] ** 2 - p[-1] ** 2) / r
    return found / 2.0
