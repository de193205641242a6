"""Walls of a tank: what their particles take over from the liquid in front, and what they feel of it.

Adami, Hu & Adams 2012, J. Comput. Phys. 231, 7057.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from numba import prange

from sdph.effects.around import frame, gravity
from sdph.effects.liquids import laminar_viscosity, liquid_damping, shifting
from sdph.engine import arrays
from sdph.engine import kernels as smoothing
from sdph.engine.geometry import apart, faster
from sdph.engine.rows import entry
from sdph.engine.state import INFLOW
from sdph.laws.compiled import fast_parallel, in_order
from sdph.laws.constants import TINY
from sdph.methods.liquids import correction, phases
from sdph.methods.liquids.forces import body, held_off, velocity


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


@fast_parallel
def extrapolate(
    kernel, s, rows, box, walls, wall_p, moving, gravity_p, frame_p, volume, pressure, wall_u, wall_v, wall_w
):
    """Pressure and velocity of wall particles: Adami et al. 2012, Eq. 23 and 27; without liquid near, pressure is 0.

    wall_u, wall_v, wall_w are s.u, s.v, s.w once more, as outputs.
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
        own = velocity(wall_p, moving, i)
        wall_u[i] = 2.0 * own[0] - u * inverse
        wall_v[i] = 2.0 * own[1] - v * inverse
        if len(s.w):
            wall_w[i] = 2.0 * own[2] - w * inverse


@fast_parallel
def surface_pressure(
    kernel, s, rows, box, chosen, wall_p, places, normals, gravity_p, frame_p, volume, pressure, found
):
    """found (P,) [Pa] at `places` (P, 3) [m] of the surface, each in front of one of the wall particles `chosen`, by
    the liquid that its plane of normals (P, 3) has in front: Adami et al. 2012, Eq. 27, to there."""
    for n in prange(len(chosen)):
        i = chosen[n]
        bx, by, bz = body(gravity_p, frame_p, s, i, True)
        bx, by, bz = bx - wall_p.ax, by - wall_p.ay, bz - wall_p.az
        ox, oy = s.x[i] - places[n, 0], s.y[i] - places[n, 1]
        oz = s.z[i] - places[n, 2] if len(s.z) else 0.0
        weight = push = 0.0
        for k in range(rows.number[i]):
            j = entry(rows, i, k)
            dx, dy, dz = apart(s, box, i, j)
            value = smoothing.value(kernel, math.sqrt(dx * dx + dy * dy + dz * dz))
            dx, dy, dz = dx - ox, dy - oy, dz - oz
            before = dx * normals[n, 0] + dy * normals[n, 1] + dz * normals[n, 2]
            value = value if volume[j] > 0.0 and before > 0.0 else 0.0
            weight += value
            push += value * (pressure[j] + s.density[j] * (bx * dx + by * dy + bz * dz))
        found[n] = max(push / weight, wall_p.least) if weight > 0.0 else 0.0


@fast_parallel
def wall_force(
    kernel, s, rows, box, flow, walls, wall_p, laminar_p, damping_p, shifting_p, phases_p, gravity_p, frame_p, excess,
    gain, felt,
):  # fmt: skip
    """felt (W, 8) by each wall particle: force (3 columns) [N], what `push` gives the liquid in front of it with the
    sign turned, power [W] that its pressure and its holding off give the liquid as it moves against the wall, with
    the velocities that it has after a gain (N, 3) [m/s], of a body its own; compression pays for the liquid's own
    pressure, of two phases for its correction too. The last three columns are what of the force is friction."""
    for n in prange(len(walls)):
        i = walls[n]
        fx = fy = fz = worked = held = rx = ry = rz = 0.0
        for k in range(rows.number[i]):
            j = entry(rows, i, k)
            dx, dy, dz = apart(s, box, i, j)
            du, dv, dw = faster(s, box, i, j)
            r2 = dx * dx + dy * dy + dz * dz
            r = math.sqrt(r2)
            inside = 0.0 if s.kind[j] == INFLOW else max(flow.volume[j], 0.0)  # what waits bears on no tank
            V = inside * abs(flow.volume[i]) * smoothing.slope(kernel, r)
            closing = du * dx + dv * dy + dw * dz
            sign_j = shifting.sign(shifting_p, flow.pressure[j], flow.enclosure[j] if len(flow.enclosure) else 1.0)
            rho_j = s.density[j]
            friction = laminar_viscosity.central(laminar_p, s, j, j, s.kind[j], s.kind[j], closing, r2)
            ringing = liquid_damping.pair(damping_p, closing, r2, 1.0 / (r + TINY))
            ringing *= phases.harmonic(phases_p, rho_j, rho_j)
            bx, by, bz = body(gravity_p, frame_p, s, j, False)
            expected = flow.pressure[j] + rho_j * (bx * dx + by * dy + bz * dz)
            p_i = phases.behind(phases_p, -1.0, flow.pressure[i], expected)
            over, p_j = held_off(wall_p, -1.0, rho_j, r), flow.pressure[j]
            along = -V * (p_i + sign_j * p_j + wall_p.stick * (ringing + friction) + over)
            across = V * wall_p.stick * laminar_viscosity.pair(laminar_p, s, j, j)
            drag = -V * wall_p.stick * (ringing + friction)
            rx, ry, rz = rx + drag * dx + across * du, ry + drag * dy + across * dv, rz + drag * dz + across * dw
            fx += along * dx + across * du
            fy += along * dy + across * dv
            fz += along * dz + across * dw
            u, v = s.u[j] + gain[j, 0] - gain[i, 0], s.v[j] + gain[j, 1] - gain[i, 1]
            w = s.w[j] + gain[j, 2] - gain[i, 2] if len(s.z) else 0.0
            nearing = u * dx + v * dy + w * dz
            worked += V * (p_i + (sign_j - 1.0) * p_j) * nearing
            held += V * over * nearing
            if len(excess):
                paid = p_j if len(phases_p) else 0.0
                ex, ey, ez = correction.extra(excess, j, j, p_i, sign_j * p_j - paid, dx, dy, dz)
                worked += V * (ex * u + ey * v + ez * w)
                ex, ey, ez = correction.extra(excess, j, j, p_i, sign_j * p_j, dx, dy, dz)
                fx, fy, fz = fx - V * ex, fy - V * ey, fz - V * ez
        felt[n, 0], felt[n, 1], felt[n, 2] = fx, fy, fz
        felt[n, 3], felt[n, 4] = worked, held
        felt[n, 5], felt[n, 6], felt[n, 7] = rx, ry, rz


@in_order
def reaction(s, active, gravity_p, frame_p, acceleration, ahead):
    """(11,) force [N] and moment [N m] of the liquid on its walls, -sum m (a - body), -sum r x m (a - body); of
    velocities that the accelerations lead to in `ahead` [s] the body force, sum m body [N], and the power of gravity
    and of the frame, sum m v.body [W]."""
    gx, gy, gz = gravity.acceleration(gravity_p)
    x = y = z = mx = my = mz = outside_x = outside_y = outside_z = by_gravity = by_frame = 0.0
    for n in prange(len(active)):
        i = active[n]
        bx, by, bz = body(gravity_p, frame_p, s, i, False)
        fx = s.mass[i] * (bx - acceleration[i, 0])
        fy = s.mass[i] * (by - acceleration[i, 1])
        fz = s.mass[i] * (bz - acceleration[i, 2])
        height = s.z[i] if len(s.z) else 0.0
        x += fx
        y += fy
        z += fz
        mx += s.y[i] * fz - height * fy
        my += height * fx - s.x[i] * fz
        mz += s.x[i] * fy - s.y[i] * fx
        u, v = s.u[i] + ahead * acceleration[i, 0], s.v[i] + ahead * acceleration[i, 1]
        w = s.w[i] + ahead * acceleration[i, 2] if len(s.w) else 0.0
        ex, ey, ez = frame.acceleration(frame_p, s.x[i], s.y[i], height, u, v, w)
        outside_x += s.mass[i] * (gx + ex)
        outside_y += s.mass[i] * (gy + ey)
        outside_z += s.mass[i] * (gz + ez)
        by_gravity += s.mass[i] * (gx * u + gy * v + gz * w)
        by_frame += s.mass[i] * (ex * u + ey * v + ez * w)
    return x, y, z, mx, my, mz, outside_x, outside_y, outside_z, by_gravity, by_frame


def feel(stepper, chosen, ahead: float):
    """(W, 8) of the wall particles `chosen` of a stepper, as `wall_force` has it; `ahead` [s] of a kick."""
    p, felt, gain = (
        stepper.p,
        arrays.zeros((len(chosen), 8), chosen),
        arrays.times(ahead, stepper.acceleration),
    )
    if stepper.bodies:
        stepper.bodies.add_velocities(gain)
    wall_force(
        stepper.kernel, stepper.state, stepper.rows, stepper.neighbours.box, stepper.flow, chosen, stepper.wall,
        stepper.viscous, p["liquid_damping"], p["shifting"], stepper.phases, p["gravity"], stepper.frame,
        stepper.excess, gain, felt,
    )  # fmt: skip
    return felt


def on_surface(stepper, chosen, places, normals):
    """(P,) [Pa] of `surface_pressure`, of a stepper."""
    found = arrays.zeros(len(chosen), chosen)
    surface_pressure(
        stepper.kernel, stepper.state, stepper.rows, stepper.neighbours.box, chosen, stepper.wall, places, normals,
        stepper.p["gravity"], stepper.frame, stepper.flow.volume, stepper.flow.pressure, found,
    )  # fmt: skip
    return found
