"""Power that pairs of particles take out of the motion and the compression of a liquid, by cause.

Terms as in `sdph.methods.liquids.equations`, taken one by one. The pairs' pressure gives back by compression what it
takes from the motion, as the continuity equation is its conjugate; what is not conjugate is counted here too.
"""

from __future__ import annotations

import math

from numba import prange

from sdph.effects.liquids import density_diffusion, laminar_viscosity, liquid_damping
from sdph.engine import kernels as smoothing
from sdph.engine.geometry import apart, deep, faster
from sdph.engine.rows import entry, length
from sdph.laws.compiled import fast_parallel, inlined, serial
from sdph.laws.constants import TINY
from sdph.methods.liquids import correction, phases

# of their sum: viscosity of the liquid, artificial viscosity, diffusion of density, corrected gradient of pressure
CAUSES = ("viscosity_J", "damping_J", "diffusion_J", "gradient_correction_J")


@serial
def rubbed(laminar_p, damping_p, phases_p, s, i, j, signed, d, dv, v):
    """Losses of a pair, over V_i V_j (dW/dr)/r stick: power [J m2/s] lost to the viscosity of the liquid, and to the
    artificial one; d, dv = r_ij, v_ij; v velocity of i, past a body that over the body's."""
    dx, dy, dz = d
    du, dv_, dw = dv
    r2 = dx * dx + dy * dy + dz * dz
    closing, parting = du * dx + dv_ * dy + dw * dz, v[0] * dx + v[1] * dy + v[2] * dz
    other = j if signed > 0.0 else i
    kind_j = phases.kind(phases_p, signed, s.kind[i], s.kind[j])
    rho_j = phases.density(phases_p, signed, s.density[i], s.density[j])
    friction = laminar_viscosity.central(laminar_p, s, i, other, s.kind[i], kind_j, closing, r2)
    across = laminar_viscosity.pair(laminar_p, s, i, other)
    ringing = liquid_damping.pair(damping_p, closing, r2, 1.0 / (math.sqrt(r2) + TINY))
    ringing *= phases.harmonic(phases_p, s.density[i], rho_j)
    return friction * parting - across * (du * v[0] + dv_ * v[1] + dw * v[2]), ringing * parting


@inlined
def moved(moving, j):
    """Velocity [m/s] (3 components) of what j belongs to where it is of a body, else 0."""
    if len(moving) == 0:
        return 0.0, 0.0, 0.0
    return moving.u[j], moving.v[j], moving.w[j]


@serial
def spread(diffusion_p, phases_p, box, s, pressure, gradient, i, j, d):
    """Spread by a pair, over V_j (dW/dr)/r: what diffusion of density does to the density of i (`compress`)."""
    if len(diffusion_p) == 0:
        return 0.0
    ramp = (gradient[i, 0] + gradient[j, 0]) * d[0] + (gradient[i, 1] + gradient[j, 1]) * d[1]
    ramp += (gradient[i, 2] + gradient[j, 2]) * d[2] if deep(box) else 0.0
    alike = phases.like(phases_p, s.kind[i], s.kind[j]) * phases.slowness(phases_p, s.kind[i])
    return alike * density_diffusion.pair(diffusion_p, pressure[j] - pressure[i], ramp)


@serial
def unmatched(excess, phases_p, s, pressure, i, j, d, v):
    """Loss of a pair of liquid, over V_i V_j (dW/dr)/r: power lost by the corrected gradient of pressure."""
    if len(excess) == 0:
        return 0.0
    own = phases.share(phases_p, s.density[i], s.density[j]) * pressure[i]
    other = phases.share(phases_p, s.density[j], s.density[i]) * pressure[j]
    ex, ey, ez = correction.extra(excess, i, j, own, other, d[0], d[1], d[2])
    return ex * v[0] + ey * v[1] + ez * v[2]


@fast_parallel
def losses(
    kernel, s, rows, box, flow, wall_p, laminar_p, damping_p, diffusion_p, phases_p, excess, gradient, acceleration,
    moving, ahead,
):  # fmt: skip
    """Power [W] lost by the CAUSES: forces of now, times velocities that the accelerations lead to in `ahead` [s]."""
    by_viscosity = by_damping = by_diffusion = by_correction = 0.0
    for n in prange(len(flow.active)):
        i = flow.active[n]
        p_i, V_i = flow.pressure[i], flow.volume[i]
        w = s.w[i] + ahead * acceleration[i, 2] if deep(box) else 0.0
        v = (s.u[i] + ahead * acceleration[i, 0], s.v[i] + ahead * acceleration[i, 1], w)
        viscous = damped = diffused = corrected = 0.0
        for k in range(length(rows, i)):
            j = entry(rows, i, k)
            d, dv = apart(s, box, i, j), faster(s, box, i, j)
            slope = smoothing.slope(kernel, math.sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]))
            signed = flow.volume[j]
            wet, grip = max(signed, 0.0) * slope, (signed if signed > 0.0 else -wall_p.stick * signed) * slope
            wall = moved(moving, j)
            past = (v[0] - wall[0], v[1] - wall[1], v[2] - wall[2])
            friction, ringing = rubbed(laminar_p, damping_p, phases_p, s, i, j, signed, d, dv, past)
            viscous += grip * friction
            damped += grip * ringing
            diffused -= wet * spread(diffusion_p, phases_p, box, s, flow.pressure, gradient, i, j, d)
            corrected += wet * unmatched(excess, phases_p, s, flow.pressure, i, j, d, v)
        by_viscosity += V_i * viscous
        by_damping += V_i * damped
        by_diffusion += V_i * p_i / s.density[i] * diffused
        by_correction += V_i * corrected
    return by_viscosity, by_damping, by_diffusion, by_correction
