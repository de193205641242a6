"""Pressure of moving particles without an equation to solve: a liquid that is slightly compressible, as a cross-check.

p = c^2 (rho - rho_0), drho/dt = -rho div u + delta l0 c lap rho, with the divergence and the Laplacian of the Poisson
method (swirl-sheet.md, 2 and section 4); the diffusion is that of Molteni & Colagrossi 2009 without its gradients. What
is drawn apart below rho_0 has no pressure and, where the case has none below 0, does not remember that it was.
"""

from __future__ import annotations

import math

from numba import prange

from sdph.engine.rows import entry
from sdph.engine.state import INFLOW
from sdph.laws.compiled import in_order, parallel
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
    s, cloud, domain = stepper.state, stepper.cloud, stepper.domain
    c = sound_speed(stepper.case, stepper.p["free_energy_tension"])
    divergence, evened = (stepper.room(name, len(s.x), s.x) for name in ("divergence", "evened"))
    diverge(*stepper.within, divergence)
    even(*stepper.within, evened)
    rates = map(domain.mine_of, (divergence, evened))
    found = condense(cloud, domain.own(s), *rates, c, dt, stepper.own.holds(stepper.case))
    domain.refresh(s.density, s.pressure)
    return c * c * stepper.world.sum(found)


@in_order
def condense(cloud, s, divergence, evened, c, dt, holds):
    """Density after `dt` [s] of its divergence (N,) [1/s] and what evens it (N,) [kg/m5], and pressure by it; what is
    below rest is at rest where it `holds`, and its sum [kg/m3] is returned."""
    found = 0.0
    for i in prange(len(s.x)):
        density = s.density[i] + dt * (DIFFUSION * cloud.spacing * c * evened[i] - s.density[i] * divergence[i])
        if s.kind[i] == INFLOW:
            density = cloud.density
        if holds and density < cloud.density:
            found += cloud.density - density
            density = cloud.density
        s.density[i], s.pressure[i] = density, c * c * (density - cloud.density)
    return found
