"""The equations of liquids: loops over neighbours, one signed term per line.

Wall particles stand among the others. `volume` is negative for them, which tells them apart without a branch; their
`pressure` and velocity are extrapolated from the liquid in front (Adami, Hu & Adams 2012, J. Comput. Phys. 231, 7057).
Outputs are arguments of their own: numba drops writes to arrays of a tuple inside a prange without a word.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit, prange

from sdph import smoothing
from sdph.effects import density_diffusion, frame, gravity, laminar_viscosity, liquid_damping, shifting
from sdph.liquid import LIQUID
from sdph.neighbours import nearest_image

# Sums may be reordered and vectorised; nan and inf keep their meaning, so that a run that bursts is noticed.
SINGULAR = 1e-3  # determinant of a renormalisation matrix; 1 inside, 0.1-0.5 at a surface; our choice
FAST = {"reassoc", "nsz", "arcp", "contract", "afn"}


class WallP(NamedTuple):
    """Velocity [m/s] and acceleration [m/s2] of the walls in the frame; least pressure [Pa]; 1 for no slip, 0 for free slip."""

    u: float
    v: float
    w: float
    ax: float
    ay: float
    az: float
    least: float
    stick: float


@njit(cache=True, error_model="numpy")
def tait(compression, stiffness, exponent, background):
    """p [Pa]; the powers 7 and 1 without `pow`, which costs more than a pair."""
    if exponent == 7.0:
        cubed = compression * compression * compression
        return stiffness * (cubed * cubed * compression - 1.0) + background
    return stiffness * (compression**exponent - 1.0) + background


@njit(cache=True, parallel=True, error_model="numpy")
def state_of(fluids, s, active, pressure, volume):
    """Pressure [Pa] and volume [m^d] of liquid particles; `fluids` (4, K): rho_0, stiffness, exponent, background by kind."""
    for n in prange(len(active)):
        i = active[n]
        rho_0, stiffness, exponent, background = fluids[0, s.kind[i]], fluids[1, s.kind[i]], fluids[2, s.kind[i]], fluids[3, s.kind[i]]
        pressure[i] = tait(s.density[i] / rho_0, stiffness, exponent, background)
        volume[i] = s.mass[i] / s.density[i]


@njit(cache=True, error_model="numpy")
def body(gravity_p, frame_p, s, i, still):
    """Acceleration [m/s2] from outside of particle i, or at its place of what stands `still` in the frame."""
    gx, gy, gz = gravity.acceleration(gravity_p)
    z = s.z[i] if len(s.z) else 0.0
    w = s.w[i] if len(s.z) else 0.0
    moving = 0.0 if still else 1.0
    fx, fy, fz = frame.acceleration(frame_p, s.x[i], s.y[i], z, moving * s.u[i], moving * s.v[i], moving * w)
    return gx + fx, gy + fy, gz + fz


@njit(cache=True, parallel=True, error_model="numpy")
def near_liquid(kind, rows, walls, wet):
    """wet (W,): whether a wall particle's row holds liquid; the others need no pressure until rows are made anew."""
    for n in prange(len(walls)):
        wet[n] = False
        for k in range(rows.count[walls[n]]):
            wet[n] = wet[n] or kind[rows.index[walls[n], k]] >= LIQUID


@njit(cache=True, error_model="numpy")
def apart(s, box, i, j):
    """r_i - r_j (3 components; the last 0 in two dimensions), through periodic boundaries."""
    dz = s.z[i] - s.z[j] if len(s.z) else 0.0
    return nearest_image(box, s.x[i] - s.x[j], s.y[i] - s.y[j], dz)


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
        for k in range(rows.count[i]):
            j = rows.index[i, k]
            dx, dy, dz = apart(s, box, i, j)
            value = smoothing.value(kernel, np.sqrt(dx * dx + dy * dy + dz * dz))
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
def push(
    kernel, s, rows, box, active, wall_p, gravity_p, frame_p, laminar_p, damping_p, diffusion_p, shifting_p,
    pressure, volume, least, acceleration, gradient_x, gradient_y, gradient_z, shift, twist,
):  # fmt: skip
    """Acceleration (N, 3) [m/s2] with body forces; corrected pressure gradient (N,) x 3 [Pa/m]; `least` (N,), smallest
    eigenvalue of the renormalisation matrix; `shift` (N, 3), sum V_j (1 + R (W/W0)^4) grad W [1/m]; `twist` (N, 9), corrected gradient dv_a/dx_b [1/s], a slowest."""
    for n in prange(len(active)):
        i = active[n]
        p_i = pressure[i]
        sign_i = shifting.sign(shifting_p, p_i, least[i] if len(least) else 1.0)
        ax = ay = az = gx = gy = gz = cx = cy = cz = 0.0
        xx = yy = zz = xy = yz = zx = 0.0
        ux = uy = uz = vx = vy = vz = wx = wy = wz = 0.0
        for k in range(rows.count[i]):
            j = rows.index[i, k]
            dx, dy, dz = apart(s, box, i, j)
            du, dv = s.u[i] - s.u[j], s.v[i] - s.v[j]
            dw = s.w[i] - s.w[j] if len(s.w) else 0.0
            r2 = dx * dx + dy * dy + dz * dz
            r = np.sqrt(r2)
            slope = smoothing.slope(kernel, r)
            signed, p_j = volume[j], pressure[j]
            wet, V = max(signed, 0.0), abs(signed)
            stick = 1.0 if signed > 0.0 else wall_p.stick
            closing = du * dx + dv * dy + dw * dz

            # rho_i dv_i/dt = -sum V_j (p_i + p_j) grad W + sum V_j 2 mu r.grad W/(r^2 + eta^2) v_ij
            along = -V * slope * (p_j + sign_i * p_i + stick * liquid_damping.pair(damping_p, closing, r2, 1.0 / (r + smoothing.TINY)))
            across = V * slope * stick * laminar_viscosity.pair(laminar_p)
            ax += along * dx + across * du
            ay += along * dy + across * dv
            az += along * dz + across * dw

            rise = wet * slope * (p_j - p_i)
            gx += rise * dx
            gy += rise * dy
            gz += rise * dz
            share = wet * slope
            xx -= share * dx * dx
            yy -= share * dy * dy
            zz -= share * dz * dz
            xy -= share * dx * dy
            yz -= share * dy * dz
            zx -= share * dz * dx
            ux -= share * du * dx
            uy -= share * du * dy
            uz -= share * du * dz
            vx -= share * dv * dx
            vy -= share * dv * dy
            vz -= share * dv * dz
            wx -= share * dw * dx
            wy -= share * dw * dy
            wz -= share * dw * dz
            crowd = V * slope * shifting.weight(shifting_p, smoothing.value(kernel, r))
            cx += crowd * dx
            cy += crowd * dy
            cz += crowd * dz
        bx, by, bz = body(gravity_p, frame_p, s, i, False)
        inverse = 1.0 / s.density[i]
        acceleration[i, 0] = ax * inverse + bx
        acceleration[i, 1] = ay * inverse + by
        acceleration[i, 2] = az * inverse + bz
        if len(diffusion_p) or len(shifting_p):
            zz = zz if len(s.z) else 1.0
            gradient_x[i], gradient_y[i], gradient_z[i] = solved(xx, yy, zz, xy, yz, zx, gx, gy, gz)
        if len(shifting_p):
            least[i] = smallest(xx, yy, zz, xy, yz, zx)
            shift[i, 0], shift[i, 1], shift[i, 2] = cx, cy, cz
            twist[i, 0], twist[i, 1], twist[i, 2] = solved(xx, yy, zz, xy, yz, zx, ux, uy, uz)
            twist[i, 3], twist[i, 4], twist[i, 5] = solved(xx, yy, zz, xy, yz, zx, vx, vy, vz)
            twist[i, 6], twist[i, 7], twist[i, 8] = solved(xx, yy, zz, xy, yz, zx, wx, wy, wz)


@njit(cache=True, error_model="numpy")
def solved(xx, yy, zz, xy, yz, zx, gx, gy, gz):
    """Solution of M x = g for a symmetric M; 0 where M is close to singular (a line of particles, or spray)."""
    a, b, c = yy * zz - yz * yz, zx * yz - xy * zz, xy * yz - zx * yy
    determinant = xx * a + xy * b + zx * c
    if determinant < SINGULAR:
        return 0.0, 0.0, 0.0
    e, f, g = xx * zz - zx * zx, zx * xy - xx * yz, xx * yy - xy * xy
    scale = 1.0 / determinant
    return scale * (a * gx + b * gy + c * gz), scale * (b * gx + e * gy + f * gz), scale * (c * gx + f * gy + g * gz)


@njit(cache=True, error_model="numpy")
def smallest(xx, yy, zz, xy, yz, zx):
    """Smallest eigenvalue of a symmetric matrix, by its invariants (Smith 1961, Commun. ACM 4, 168)."""
    mean = (xx + yy + zz) / 3.0
    a, b, c = xx - mean, yy - mean, zz - mean
    spread = np.sqrt((a * a + b * b + c * c + 2.0 * (xy * xy + yz * yz + zx * zx)) / 6.0)
    if spread == 0.0:
        return mean
    half = (a * (b * c - yz * yz) - xy * (xy * c - yz * zx) + zx * (xy * yz - b * zx)) / (2.0 * spread**3)
    angle = np.arccos(min(max(half, -1.0), 1.0)) / 3.0
    return mean + 2.0 * spread * np.cos(angle + 2.0 * np.pi / 3.0)


@njit(cache=True, parallel=True, error_model="numpy", fastmath=FAST)
def compress(kernel, s, rows, box, active, wall_p, diffusion_p, pressure, gradient_x, gradient_y, gradient_z, volume, rate):
    """d rho/dt (N,) [kg/m3/s] = rho_i sum V_j v_ij.grad W + delta h c sum V_j psi_ij.grad W (Antuono et al. 2010)."""
    for n in prange(len(active)):
        i = active[n]
        p_i = pressure[i]
        growth = spread = 0.0
        for k in range(rows.count[i]):
            j = rows.index[i, k]
            dx, dy, dz = apart(s, box, i, j)
            signed, u_j, v_j = volume[j], s.u[j], s.v[j]  # read before they are chosen from: no branch
            w_j = s.w[j] if len(s.w) else 0.0
            du = s.u[i] - (u_j if signed > 0.0 else wall_p.u)
            dv = s.v[i] - (v_j if signed > 0.0 else wall_p.v)
            dw = s.w[i] - (w_j if signed > 0.0 else wall_p.w) if len(s.w) else 0.0
            slope = smoothing.slope(kernel, np.sqrt(dx * dx + dy * dy + dz * dz))
            growth += abs(signed) * slope * (du * dx + dv * dy + dw * dz)
            if len(diffusion_p):
                ramp = (gradient_x[i] + gradient_x[j]) * dx + (gradient_y[i] + gradient_y[j]) * dy
                ramp += (gradient_z[i] + gradient_z[j]) * dz if len(s.z) else 0.0
                spread += max(signed, 0.0) * slope * density_diffusion.pair(diffusion_p, pressure[j] - p_i, ramp)
        rate[i] = s.density[i] * growth + spread


@njit(cache=True, parallel=True, error_model="numpy")
def kick(active, acceleration, dt, u, v, w):
    """v += a dt."""
    for n in prange(len(active)):
        i = active[n]
        u[i] += dt * acceleration[i, 0]
        v[i] += dt * acceleration[i, 1]
        if len(w):
            w[i] += dt * acceleration[i, 2]


@njit(cache=True, parallel=True, error_model="numpy")
def drift(active, u, v, w, dt, x, y, z):
    """r += v dt."""
    for n in prange(len(active)):
        i = active[n]
        x[i] += dt * u[i]
        y[i] += dt * v[i]
        if len(w):
            z[i] += dt * w[i]


@njit(cache=True, parallel=True, error_model="numpy")
def densify(active, rate, dt, density):
    """rho += rate dt."""
    for n in prange(len(active)):
        density[active[n]] += dt * rate[active[n]]


@njit(cache=True, parallel=True, error_model="numpy")
def fastest(s, active, acceleration):
    """Largest v^2 [m2/s2] and a^2 [m2/s4] of the liquid."""
    speed = force = 0.0
    for n in prange(len(active)):
        i = active[n]
        w = s.w[i] if len(s.w) else 0.0
        speed = max(speed, s.u[i] ** 2 + s.v[i] ** 2 + w * w)
        force = max(force, acceleration[i, 0] ** 2 + acceleration[i, 1] ** 2 + acceleration[i, 2] ** 2)
    return speed, force


@njit(cache=True, parallel=True, error_model="numpy")
def momentum(s, active):
    """Momentum of the liquid [kg m/s], three components."""
    x = y = z = 0.0
    for n in prange(len(active)):
        i = active[n]
        x += s.mass[i] * s.u[i]
        y += s.mass[i] * s.v[i]
        z += s.mass[i] * s.w[i] if len(s.w) else 0.0
    return x, y, z


@njit(cache=True, parallel=True, error_model="numpy")
def travelled(x, y, z, x0, y0, z0):
    """Largest squared distance [m2] between two sets of places."""
    most = 0.0
    for i in prange(len(x)):
        dz = z[i] - z0[i] if len(z) else 0.0
        most = max(most, (x[i] - x0[i]) ** 2 + (y[i] - y0[i]) ** 2 + dz * dz)
    return most


@njit(cache=True, parallel=True, error_model="numpy")
def displace(p, active, least, shift, gradient_x, gradient_y, gradient_z, twist, inverse_c2, dt, x, y, z, u, v, w, density):
    """r -= dt D sum V_j (1 + R (W/W0)^4) grad W, no faster than the parameters allow, inside the liquid alone.

    Velocity and density are taken along their gradients, so that moving a particle does not move the field.
    """
    for n in prange(len(active)):
        i = active[n]
        dx, dy, dz = -p.strength * shift[i, 0], -p.strength * shift[i, 1], -p.strength * shift[i, 2]
        speed = np.sqrt(dx * dx + dy * dy + dz * dz)
        scale = dt * min(1.0, p.largest / speed) if speed > 0.0 and least[i] > shifting.INTERIOR else 0.0
        dx, dy, dz = scale * dx, scale * dy, scale * dz
        x[i] += dx
        y[i] += dy
        u[i] += twist[i, 0] * dx + twist[i, 1] * dy + twist[i, 2] * dz
        v[i] += twist[i, 3] * dx + twist[i, 4] * dy + twist[i, 5] * dz
        density[i] += inverse_c2 * (gradient_x[i] * dx + gradient_y[i] * dy + gradient_z[i] * dz)
        if len(z):
            z[i] += dz
            w[i] += twist[i, 6] * dx + twist[i, 7] * dy + twist[i, 8] * dz


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


@njit(cache=True, parallel=True, error_model="numpy", fastmath=FAST)
def wall_force(kernel, s, rows, box, walls, wall_p, laminar_p, damping_p, shifting_p, least, pressure, volume, force):
    """force (W, 3) [N] on each wall particle: what `push` gives the liquid in front of it, with the sign turned."""
    for n in prange(len(walls)):
        i = walls[n]
        fx = fy = fz = 0.0
        for k in range(rows.count[i]):
            j = rows.index[i, k]
            dx, dy, dz = apart(s, box, i, j)
            du, dv = s.u[i] - s.u[j], s.v[i] - s.v[j]
            dw = s.w[i] - s.w[j] if len(s.w) else 0.0
            r2 = dx * dx + dy * dy + dz * dz
            r = np.sqrt(r2)
            V = max(volume[j], 0.0) * abs(volume[i]) * smoothing.slope(kernel, r)
            closing = du * dx + dv * dy + dw * dz
            sign_j = shifting.sign(shifting_p, pressure[j], least[j] if len(least) else 1.0)
            ringing = wall_p.stick * liquid_damping.pair(damping_p, closing, r2, 1.0 / (r + smoothing.TINY))
            along = -V * (pressure[i] + sign_j * pressure[j] + ringing)
            across = V * wall_p.stick * laminar_viscosity.pair(laminar_p)
            fx += along * dx + across * du
            fy += along * dy + across * dv
            fz += along * dz + across * dw
        force[n, 0] = fx
        force[n, 1] = fy
        force[n, 2] = fz
