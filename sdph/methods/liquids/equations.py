"""The equations of liquids: loops over neighbours, one signed term per line.

Wall particles stand among the others. `volume` is negative for them, which tells them apart without a branch; their
`pressure` and velocity are extrapolated from the liquid in front (sdph.methods.liquids.walls).
Outputs are arguments of their own.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import prange

from sdph.effects.liquids import density_diffusion, laminar_viscosity, liquid_damping, shifting
from sdph.engine import kernels as smoothing
from sdph.engine.geometry import apart, deep, faster
from sdph.engine.rows import entry, length
from sdph.engine.state import GAS, INFLOW, LIQUID, WALL
from sdph.laws.by_reference import by_reference
from sdph.laws.compiled import fast_inlined, fast_parallel, parallel, serial
from sdph.laws.constants import TINY
from sdph.laws.eos import tait_pressure
from sdph.laws.matrices import solved
from sdph.methods.liquids import correction, phases
from sdph.methods.liquids.forces import body, held_off, velocity


@by_reference
class Flow(NamedTuple):
    """Values that one loop of a step leaves to the next, in one flat group: indices of the particles that move (A,),
    pressure (N,) [Pa], volume (N,) [m^d], negative for walls, and smallest eigenvalue of the renormalisation matrix
    (N,) of the last step, without length where nothing is shifted."""

    active: np.ndarray
    pressure: np.ndarray
    volume: np.ndarray
    enclosure: np.ndarray


@serial
def pressure_at(fluids, kind, rho):
    """Pressure [Pa] of a kind at a density [kg/m3], as in `state_of`."""
    tension = fluids[4, kind] * rho * rho  # of Van der Waals
    return tait_pressure(rho / fluids[0, kind], fluids[1, kind], fluids[2, kind], fluids[3, kind]) - tension


@parallel
def state_of(fluids, s, active, pressure, volume):
    """Pressure [Pa] and volume [m^d] of liquid particles; `fluids` (5, K): rho_0, stiffness, exponent, background,
    cohesion by kind."""
    for n in prange(len(active)):
        i = active[n]
        pressure[i] = pressure_at(fluids, s.kind[i], s.density[i])
        volume[i] = s.mass[i] / s.density[i]


@parallel
def tell(kind, number, wet, wall):
    """Masks (N,) of liquid particles, and of those of walls that some liquid is near: `number` (N,) of neighbours."""
    for i in prange(len(kind)):
        wet[i] = kind[i] == LIQUID or kind[i] == GAS
        wall[i] = kind[i] == WALL and number[i] > 0


@parallel
def turn_inside(s, volume):
    """volume (N,) [m^d] of wall particles, with its sign turned."""
    for i in prange(len(s.kind)):
        if s.kind[i] == WALL:
            volume[i] = -s.mass[i] / s.density[i]


@fast_inlined
def by_pair(kernel, s, box, flow, wall_p, laminar_p, damping_p, phases_p, excess, i, j, own, outside):
    """Terms of a liquid particle i by another, j: force per volume (3 values) [N/m3]; share V_j (dW/dr)/r of liquid of
    its kind [1/m2], the rise of pressure to j [Pa], and r_ij (3 values) [m].

    own: pressure of i [Pa] with the sign that tension control gives it; outside (3 values): its acceleration [m/s2]."""
    rho_i, p_i = s.density[i], flow.pressure[i]
    dx, dy, dz = apart(s, box, i, j)
    du, dv, dw = faster(s, box, i, j)
    r2 = dx * dx + dy * dy + dz * dz
    r = math.sqrt(r2)
    slope = smoothing.slope(kernel, r)
    signed = flow.volume[j]
    wet, V = max(signed, 0.0), abs(signed)
    stick, behind = (1.0, j) if signed > 0.0 else (wall_p.stick, i)
    closing = du * dx + dv * dy + dw * dz
    kind_j = phases.kind(phases_p, signed, s.kind[i], s.kind[j])
    rho_j = phases.density(phases_p, signed, rho_i, s.density[j])
    weight = outside[0] * dx + outside[1] * dy + outside[2] * dz
    p_j = phases.behind(phases_p, signed, flow.pressure[j], p_i - rho_i * weight)
    mean = phases.harmonic(phases_p, rho_i, rho_j)
    ringing = liquid_damping.pair(damping_p, closing, r2, 1.0 / (r + TINY)) * mean
    friction = laminar_viscosity.central(laminar_p, s, i, behind, s.kind[i], kind_j, closing, r2)

    # rho_i dv_i/dt = -sum V_j (p_i + p_j) grad W + sum V_j 2 mu r.grad W/(r^2 + eta^2) v_ij
    pressed = phases.pressure(phases_p, own, p_j, rho_i, rho_j) + held_off(wall_p, signed, rho_i, r)
    along = -V * slope * (pressed + stick * (ringing + friction))
    across = V * slope * stick * laminar_viscosity.pair(laminar_p, s, i, behind)
    fx, fy, fz = along * dx + across * du, along * dy + across * dv, along * dz + across * dw
    if len(excess):  # B of a wall is that of the liquid in front
        parts = phases.share(phases_p, rho_i, rho_j) * own, phases.share(phases_p, rho_j, rho_i) * p_j
        ex, ey, ez = correction.extra(excess, i, behind, parts[0], parts[1], dx, dy, dz)
        fx, fy, fz = fx - V * slope * ex, fy - V * slope * ey, fz - V * slope * ez
    return fx, fy, fz, wet * slope * phases.like(phases_p, s.kind[i], kind_j), p_j - p_i, dx, dy, dz


@fast_parallel
def push(
    kernel, s, rows, box, flow, wall_p, gravity_p, frame_p, laminar_p, damping_p, diffusion_p, shifting_p, phases_p,
    excess, acceleration, gradient,
):  # fmt: skip
    """Acceleration (N, 3) [m/s2] with body forces; corrected pressure gradient (N, 3) [Pa/m], where something needs
    it."""
    for n in prange(len(flow.active)):
        i = flow.active[n]
        rho_i, p_i = s.density[i], flow.pressure[i]
        own = shifting.sign(shifting_p, p_i, flow.enclosure[i] if len(flow.enclosure) else 1.0) * p_i
        outside = body(gravity_p, frame_p, s, i, False)
        ax = ay = az = gx = gy = gz = xx = yy = zz = xy = yz = zx = 0.0
        for k in range(length(rows, i)):
            fx, fy, fz, share, rise, dx, dy, dz = by_pair(
                kernel, s, box, flow, wall_p, laminar_p, damping_p, phases_p, excess, i, entry(rows, i, k), own,
                outside,
            )  # fmt: skip
            ax += fx
            ay += fy
            az += fz
            gx += share * rise * dx
            gy += share * rise * dy
            gz += share * rise * dz
            xx -= share * dx * dx
            yy -= share * dy * dy
            zz -= share * dz * dz
            xy -= share * dx * dy
            yz -= share * dy * dz
            zx -= share * dz * dx
        acceleration[i, 0] = ax / rho_i + outside[0]
        acceleration[i, 1] = ay / rho_i + outside[1]
        acceleration[i, 2] = az / rho_i + outside[2]
        if len(diffusion_p) or len(shifting_p):
            steep = solved(xx, yy, zz if len(s.z) else 1.0, xy, yz, zx, gx, gy, gz)
            gradient[i, 0] = steep[0]
            gradient[i, 1] = steep[1]
            gradient[i, 2] = steep[2]


@fast_parallel
def unreturned(kernel, s, rows, box, flow, shifting_p, excess, gain, made):
    """made (N, 7) by control of tension: force (3 columns) [N] on each particle that no other of the liquid gets back,
    (1 - sign_i) p_i B_i V_i sum V_j grad W, its moment about the origin (3) [N m], and power [W] that it takes, with
    velocities after a gain (N, 3) [m/s].

    A pair pushes i by p_j - p_i and j by p_i - p_j: both the same way. Walls and what waits get what they give."""
    for n in prange(len(flow.active)):
        i = flow.active[n]
        p_i = flow.pressure[i]
        odd = (1.0 - shifting.sign(shifting_p, p_i, flow.enclosure[i])) * p_i * flow.volume[i]
        if odd == 0.0:
            continue
        x = y = z = waiting_x = waiting_y = waiting_z = 0.0
        for k in range(rows.number[i]):
            j = entry(rows, i, k)
            dx, dy, dz = apart(s, box, i, j)
            share = max(flow.volume[j], 0.0) * smoothing.slope(kernel, math.sqrt(dx * dx + dy * dy + dz * dz))
            waits = share if s.kind[j] == INFLOW else 0.0
            x, y, z = x + share * dx, y + share * dy, z + share * dz
            waiting_x, waiting_y, waiting_z = waiting_x + waits * dx, waiting_y + waits * dy, waiting_z + waits * dz
        ax, ay, az = correction.extra(excess, i, i, odd, 0.0, x, y, z)
        bx, by, bz = correction.extra(excess, i, i, odd, 0.0, waiting_x, waiting_y, waiting_z)
        fx, fy, fz = odd * x + ax, odd * y + ay, odd * z + az
        made[i, 0] = fx - odd * waiting_x - bx
        made[i, 1] = fy - odd * waiting_y - by
        made[i, 2] = fz - odd * waiting_z - bz
        tx, ty, tz = made[i, 0], made[i, 1], made[i, 2]
        z_i, w_i = (s.z[i], s.w[i] + gain[i, 2]) if deep(box) else (0.0, 0.0)
        made[i, 3], made[i, 4], made[i, 5] = s.y[i] * tz - z_i * ty, z_i * tx - s.x[i] * tz, s.x[i] * ty - s.y[i] * tx
        made[i, 6] = -fx * (s.u[i] + gain[i, 0]) - fy * (s.v[i] + gain[i, 1]) - fz * w_i


@fast_parallel
def sum_up(kernel, s, rows, box, active, lattice, density):
    """rho (N,) [kg/m3] = m sum W, walls included, over what the sum is on a lattice: Hu & Adams 2006, Eq. 7."""
    for n in prange(len(active)):
        i = active[n]
        number = smoothing.value(kernel, 0.0)
        for k in range(rows.number[i]):
            dx, dy, dz = apart(s, box, i, entry(rows, i, k))
            number += smoothing.value(kernel, math.sqrt(dx * dx + dy * dy + dz * dz))
        density[i] = s.mass[i] * number / lattice


@fast_parallel
def compress(kernel, s, rows, box, flow, wall_p, moving, diffusion_p, phases_p, excess, gradient, rate):
    """d rho/dt (N,) [kg/m3/s] = rho_i sum V_j v_ij.B_i grad W + delta h c sum V_j psi_ij.grad W (Antuono et al. 2010);
    B_i - 1 is `excess` (sdph.methods.liquids.correction), () for B_i = 1."""
    for n in prange(len(flow.active)):
        i = flow.active[n]
        p_i, rho_i = flow.pressure[i], s.density[i]
        growth = spread = 0.0
        for k in range(length(rows, i)):
            j = entry(rows, i, k)
            dx, dy, dz = apart(s, box, i, j)
            signed, u_j, v_j = flow.volume[j], s.u[j], s.v[j]  # read before they are chosen from: no branch
            w_j = s.w[j] if deep(box) else 0.0
            wall_u, wall_v, wall_w = velocity(wall_p, moving, j)
            du = s.u[i] - (u_j if signed > 0.0 else wall_u)
            dv = s.v[i] - (v_j if signed > 0.0 else wall_v)
            dw = s.w[i] - (w_j if signed > 0.0 else wall_w) if deep(box) else 0.0
            slope = smoothing.slope(kernel, math.sqrt(dx * dx + dy * dy + dz * dz))
            rho_j = phases.density(phases_p, signed, rho_i, s.density[j])
            share = phases.share(phases_p, rho_i, rho_j)
            ex, ey, ez = correction.extra(excess, i, i, 1.0, 0.0, dx, dy, dz)
            growth += abs(signed) * slope * share * (du * (dx + ex) + dv * (dy + ey) + dw * (dz + ez))
            if len(diffusion_p):
                ramp = (gradient[i, 0] + gradient[j, 0]) * dx + (gradient[i, 1] + gradient[j, 1]) * dy
                ramp += (gradient[i, 2] + gradient[j, 2]) * dz if deep(box) else 0.0
                same = max(signed, 0.0) * phases.like(phases_p, s.kind[i], s.kind[j])
                spread += same * slope * density_diffusion.pair(diffusion_p, flow.pressure[j] - p_i, ramp)
        rate[i] = rho_i * growth + spread * phases.slowness(phases_p, s.kind[i])
