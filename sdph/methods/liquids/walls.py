"""Walls of a tank: what their particles take over from the liquid in front, and what they feel of it.

Adami, Hu & Adams 2012, J. Comput. Phys. 231, 7057.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from numba import njit, prange

from sdph.effects.liquids import laminar_viscosity, liquid_damping, shifting
from sdph.engine import kernels as smoothing
from sdph.engine.geometry import FAST, apart, faster
from sdph.engine.rows import entry
from sdph.methods.liquids import correction, phases
from sdph.methods.liquids.forces import body, held_off


class WallP(NamedTuple):
    """Velocity [m/s] and acceleration [m/s2] of the walls in the frame; the rest as in
    sdph.effects.around.tank.TankP."""

    u: float
    v: float
    w: float
    ax: float
    ay: float
    az: float
    stick: float
    least: float
    near: float
    stiffness: float


@njit(cache=True, parallel=True, error_model="numpy", fastmath=FAST)
def extrapolate(kernel, s, rows, box, walls, wall_p, gravity_p, frame_p, volume, pressure, wall_u, wall_v, wall_w):
    """Pressure and velocity of wall particles: Adami et al. 2012, Eq. 23 and 27; without liquid near, both are 0.

    wall_u, wall_v, wall_w are s.u, s.v, s.w once more: a prange keeps no writes to arrays of a tuple.
    """
    for n in prange(len(walls)):
        i = walls[n]
        bx, by, bz = body(gravity_p, frame_p, s, i, True)
        bx, by, bz = bx - wall_p.ax, by - wall_p.ay, bz - wall_p.az
        weight = push = u = v = w = 0.0
        for k in range(rows.number[i]):
            j = entry(rows, i, k)
            dx, dy, dz = apart(s, box, i, j)
            value = smoothing.value(kernel, math.sqrt(dx * dx + dy * dy + dz * dz))
            value = value if volume[j] > 0.0 else 0.0
            weight += value
            push += value * (pressure[j] + s.density[j] * (bx * dx + by * dy + bz * dz))
            u += value * s.u[j]
            v += value * s.v[j]
            w += value * s.w[j] if len(s.w) else 0.0
        inverse = 1.0 / weight if weight > 0.0 else 0.0
        pressure[i] = max(push * inverse, wall_p.least)
        wall_u[i] = 2.0 * wall_p.u - u * inverse
        wall_v[i] = 2.0 * wall_p.v - v * inverse
        if len(s.w):
            wall_w[i] = 2.0 * wall_p.w - w * inverse


@njit(cache=True, parallel=True, error_model="numpy", fastmath=FAST)
def wall_force(
    kernel, s, rows, box, flow, walls, wall_p, laminar_p, damping_p, shifting_p, phases_p, gravity_p, frame_p, excess,
    force,
):  # fmt: skip
    """force (W, 3) [N] on each wall particle: what `push` gives the liquid in front of it, with the sign turned."""
    for n in prange(len(walls)):
        i = walls[n]
        fx = fy = fz = 0.0
        for k in range(rows.number[i]):
            j = entry(rows, i, k)
            dx, dy, dz = apart(s, box, i, j)
            du, dv, dw = faster(s, box, i, j)
            r2 = dx * dx + dy * dy + dz * dz
            r = math.sqrt(r2)
            V = max(flow.volume[j], 0.0) * abs(flow.volume[i]) * smoothing.slope(kernel, r)
            closing = du * dx + dv * dy + dw * dz
            sign_j = shifting.sign(shifting_p, flow.pressure[j], flow.least[j] if len(flow.least) else 1.0)
            rho_j = s.density[j]
            friction = laminar_viscosity.central(laminar_p, s, j, j, s.kind[j], s.kind[j], closing, r2)
            ringing = liquid_damping.pair(damping_p, closing, r2, 1.0 / (r + smoothing.TINY)) * phases.harmonic(
                phases_p, rho_j, rho_j
            )
            bx, by, bz = body(gravity_p, frame_p, s, j, False)
            p_i = phases.behind(
                phases_p, -1.0, flow.pressure[i], flow.pressure[j] + rho_j * (bx * dx + by * dy + bz * dz)
            )
            along = -V * (
                p_i + sign_j * flow.pressure[j] + wall_p.stick * (ringing + friction) + held_off(wall_p, -1.0, rho_j, r)
            )
            across = V * wall_p.stick * laminar_viscosity.pair(laminar_p, s, j, j)
            fx += along * dx + across * du
            fy += along * dy + across * dv
            fz += along * dz + across * dw
            if len(excess):
                ex, ey, ez = correction.extra(excess, j, j, p_i, sign_j * flow.pressure[j], dx, dy, dz)
                fx -= V * ex
                fy -= V * ey
                fz -= V * ez
        force[n, 0] = fx
        force[n, 1] = fy
        force[n, 2] = fz


@njit(cache=True, error_model="numpy")
def reaction(s, active, gravity_p, frame_p, acceleration, load):
    """load (10,): force [N] and moment [N m] of the liquid on its walls, -sum m (a - body), -sum r x m (a - body); body
    force, sum m body [N], and its power, sum m v.body [W]."""
    for i in active:
        bx, by, bz = body(gravity_p, frame_p, s, i, False)
        fx = s.mass[i] * (bx - acceleration[i, 0])
        fy = s.mass[i] * (by - acceleration[i, 1])
        fz = s.mass[i] * (bz - acceleration[i, 2])
        z = s.z[i] if len(s.z) else 0.0
        load[0] += fx
        load[1] += fy
        load[2] += fz
        load[3] += s.y[i] * fz - z * fy
        load[4] += z * fx - s.x[i] * fz
        load[5] += s.x[i] * fy - s.y[i] * fx
        load[6] += s.mass[i] * bx
        load[7] += s.mass[i] * by
        load[8] += s.mass[i] * bz
        load[9] += s.mass[i] * (s.u[i] * bx + s.v[i] * by + (s.w[i] * bz if len(s.w) else 0.0))
