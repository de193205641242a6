"""Longest sub-step that sound among the grains bears: von Neumann's, of waves on a lattice with summed density.

With densities summed over neighbours and pressures by density, a wave exp(i k.x) on a lattice swings with

    omega^2 = c^2 |sum V (dW/dr) r/r sin(k.r)|^2 + (2 p/rho) e(k),

e(k) the largest eigenvalue of sum V (second derivative of W) (1 - cos(k.r)). The second part is that of the pressure
itself, which is small where contacts are stiff: they bear nearly twice the step of grains whose pressure is rho c^2/2.
Velocities first, then places, bear omega dt = 2.
"""

from __future__ import annotations

import itertools
import math
from typing import NamedTuple

import numpy as np

from sdph.laws import kernels
from sdph.laws.compiled import law

# omega dt of a sub-step, of 2 that waves on a lattice bear; our choice, by convergence: at 1.0 the bed moves by less
# than 0.15 %, but grains on 30 degrees slide 1.5 % faster and those at rest on 20 creep (validation/granular_piles)
SWING = 0.6
WAVES = 200  # looked at in each direction, up to the shortest that a lattice has; our choice


class Waves(NamedTuple):
    """Fastest waves on a lattice: (omega h/c)^2 by compression, and (omega h)^2 rho/p by the pressure itself."""

    stretch: float
    press: float


def waves_of(case) -> Waves:
    """Waves along axes and diagonals of the lattice that a case begins with; its kernel is divided by its sum."""
    ratio, d = case.resolution.smoothing_ratio, case.dimensions
    sums = kernels.lattice_factor("cubic_spline", d, ratio)
    stretch, press = zip(*(fastest(ratio, way) for way in itertools.product((0.0, 1.0), repeat=d) if any(way)))
    return Waves(max(stretch) / sums**2, max(press) / sums)


def fastest(ratio: float, way) -> tuple[float, float]:
    """The two numbers of `Waves` of waves along `way` (d,) on a lattice with h = `ratio` spacings, kernel as it is."""
    d, reach = len(way), math.ceil(kernels.SUPPORT * ratio)
    place = np.stack(np.meshgrid(*d * [np.arange(-reach, reach + 1.0)]), axis=-1).reshape(-1, d)
    place = place[place.any(axis=1)]
    r = np.linalg.norm(place, axis=1)
    sigma = kernels.normalisation("cubic_spline", d, ratio)
    slope = np.array([kernels.cubic_spline_gradient(each, ratio, sigma) for each in r])  # (dW/dr)/r
    bend = np.array([kernels.cubic_spline_curvature(each, ratio, sigma) for each in r]) - slope
    unit = place / r[:, None]
    second = slope[:, None, None] * np.eye(d) + bend[:, None, None] * unit[:, :, None] * unit[:, None, :]
    phase = np.linspace(0.01, 1.0, WAVES)[:, None] * math.pi * (place @ np.array(way))
    stretch = ((np.sin(phase) @ (slope[:, None] * place)) ** 2).sum(axis=1).max()
    push = np.linalg.eigvalsh(np.einsum("wn,nab->wab", 1.0 - np.cos(phase), second))[:, -1].max()
    return float(stretch) * ratio**2, 2.0 * float(push) * ratio**2


@law
def swing(waves, squared, pressure_over_density):
    """omega h [m/s] of the fastest of `Waves`, from c^2 and p/rho [m2/s2]."""
    return math.sqrt(waves.stretch * squared + waves.press * pressure_over_density)


def limit(h: float, pace: float) -> float:
    """Longest sub-step [s] of `pace` [m/s], the largest omega h + 2 v of the particles: none goes further than half of
    h."""
    return SWING * h / pace
