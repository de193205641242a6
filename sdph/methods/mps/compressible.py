"""Pressure of moving particles without an equation to solve: a liquid that is slightly compressible, as a cross-check.

p = c^2 (rho - rho_0), drho/dt = -rho div u + delta l0 c lap rho, with the divergence and the Laplacian of the Poisson
method (swirl-sheet.md, 2 and section 4); the diffusion is that of Molteni & Colagrossi 2009 without its gradients. What
is drawn apart below rho_0 has no pressure and, where the case has none below 0, does not remember that it was.
"""

from __future__ import annotations

import math

import numpy as np
from numba import prange

from sdph.engine.rows import entry
from sdph.engine.state import INFLOW
from sdph.laws.compiled import parallel
from sdph.methods.mps.equations import diverge, seen

SOUND = 10.0  # c over the speed sqrt(cohesion/rho) that tension gives, so that rho varies by 1 %: swirl-sheet.md, 4
DIFFUSION = 0.1  # delta: Antuono et al. 2010, Comput. Phys. Commun. 181, 532
# of l0/c; waves on the lattice have omega <= 1.05 c/l0 for any reach (sums over the lattice), so that the step, which
# is symplectic, holds up to 1.9 l0/c: a quarter of it, as disorder makes omega larger; our choice
COURANT = 0.5


def sound_speed(case, tension_p) -> float:
    """c [m/s] by the cohesion pressure of the tension."""
    return SOUND * math.sqrt(abs(tension_p.cohesion) / case.liquid.density)


@parallel
def even(cloud, walls, s, rows, box, rate):
    """rate (N,) [kg/m5]: Laplacian of the density, (2 d/(lambda n_0)) sum (rho_j - rho_i) w (5)."""
    factor = 2.0 * cloud.dimensions / (cloud.spread * cloud.number)
    for i in prange(len(s.x)):
        total = 0.0
        for k in range(rows.number[i]):
            j = entry(rows, i, k)
            total += seen(cloud, s, box, i, j)[4] * (s.density[j] - s.density[i])
        rate[i] = factor * total


def pressed(stepper, dt: float) -> float:
    """Move the density of a stepper's state by `dt` [s] with its velocities, and set its pressure; returns the sum of
    what was below 0 and left out [Pa]."""
    s, cloud, rest = stepper.state, stepper.cloud, stepper.cloud.density
    c = sound_speed(stepper.case, stepper.p["free_energy_tension"])
    divergence, evened = np.empty(len(s.x)), np.empty(len(s.x))
    diverge(*stepper.around, divergence)
    even(*stepper.around, evened)
    s.density[:] += dt * (DIFFUSION * cloud.spacing * c * evened - s.density * divergence)
    s.density[s.kind == INFLOW] = rest
    below = s.density < rest if stepper.own.holds(stepper.case) else np.zeros(len(s.x), bool)
    clipped = c * c * float((rest - s.density[below]).sum())
    s.density[below] = rest
    s.pressure[:] = c * c * (s.density - rest)
    return clipped
