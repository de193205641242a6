"""The equations of solids: loops over the neighbours of the undeformed body, one signed term per line.

Rows stay as they are for good (sdph.methods.solids.weights). Tensors are rows of an array, (N, 9)
xx, xy, xz, yx, ... zz; symmetric ones (N, 6) xx, yy, zz, xy, yz, zx. Two dimensions are plane strain.
Outputs are arguments of their own.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import prange

from sdph.engine import kernels as smoothing
from sdph.engine.rows import place
from sdph.laws import strength
from sdph.laws.by_reference import by_reference
from sdph.laws.compiled import fast_parallel, parallel, serial
from sdph.laws.matrices import principal


class Material(NamedTuple):
    """K, G, E [Pa]; rho_0 [kg/m3]; c [m/s]; shares of viscosity and of hourglass control [-]."""

    bulk: float
    shear: float
    youngs: float
    density: float
    sound: float
    viscosity: float
    hourglass: float


@by_reference
class Reference(NamedTuple):
    """Undeformed bodies: places X, Y, Z (N,) [m], volume (N,) [m^d], slope along the rows [1/m^(d+2)], 0 or negative,
    L (N, 9), and 1 of particles that bear nothing (N,)."""

    X: np.ndarray
    Y: np.ndarray
    Z: np.ndarray
    volume: np.ndarray
    slope: np.ndarray
    correction: np.ndarray
    free: np.ndarray


@fast_parallel
def deform(x, y, z, rows, ref, gradient):
    """F (N, 9) = I + sum (u_j - u_i) g_ij^T, u displacements: exact for any linear map. z has no length in a plane."""
    for i in prange(len(gradient)):
        xi, yi, zi = x[i], y[i], z[i] if len(z) else 0.0
        Xi, Yi, Zi = ref.X[i], ref.Y[i], ref.Z[i]
        xx = xy = xz = yx = yy = yz = zx = zy = zz = 0.0
        for k in range(rows.number[i]):
            e = place(rows, i, k)
            j = rows.entries[e]
            weight = -ref.volume[j] * ref.slope[e]
            X, Y, Z = Xi - ref.X[j], Yi - ref.Y[j], Zi - ref.Z[j]
            u, v = weight * (xi - x[j] - X), weight * (yi - y[j] - Y)
            w = weight * (zi - z[j] - Z) if len(z) else 0.0
            xx += u * X
            xy += u * Y
            xz += u * Z
            yx += v * X
            yy += v * Y
            yz += v * Z
            zx += w * X
            zy += w * Y
            zz += w * Z
        L = ref.correction
        for b in range(3):
            gradient[i, b] = xx * L[i, b] + xy * L[i, 3 + b] + xz * L[i, 6 + b]
            gradient[i, 3 + b] = yx * L[i, b] + yy * L[i, 3 + b] + yz * L[i, 6 + b]
            gradient[i, 6 + b] = zx * L[i, b] + zy * L[i, 3 + b] + zz * L[i, 6 + b]
        for b in range(3):
            gradient[i, 4 * b] += 1.0


@serial
def inverse(F):
    """(det F, F^-1) of nine elements; the inverse in nine."""
    a, b, c = F[4] * F[8] - F[5] * F[7], F[5] * F[6] - F[3] * F[8], F[3] * F[7] - F[4] * F[6]
    det = F[0] * a + F[1] * b + F[2] * c
    scale = 1.0 / det
    return det, (
        scale * a, scale * (F[2] * F[7] - F[1] * F[8]), scale * (F[1] * F[5] - F[2] * F[4]),
        scale * b, scale * (F[0] * F[8] - F[2] * F[6]), scale * (F[2] * F[3] - F[0] * F[5]),
        scale * c, scale * (F[1] * F[6] - F[0] * F[7]), scale * (F[0] * F[4] - F[1] * F[3]),
    )  # fmt: skip


@serial
def row(F, a, c):
    """Row a of F c, three elements, of a symmetric c (xx, yy, zz, xy, yz, zx)."""
    x, y, z = F[3 * a], F[3 * a + 1], F[3 * a + 2]
    return x * c[0] + y * c[3] + z * c[5], x * c[3] + y * c[1] + z * c[4], x * c[5] + y * c[4] + z * c[2]


@serial
def carried(F, c):
    """F c F^T of a symmetric c (xx, yy, zz, xy, yz, zx), in the same order."""
    p, q, r = row(F, 0, c), row(F, 1, c), row(F, 2, c)
    return (
        p[0] * F[0] + p[1] * F[1] + p[2] * F[2], q[0] * F[3] + q[1] * F[4] + q[2] * F[5],
        r[0] * F[6] + r[1] * F[7] + r[2] * F[8], p[0] * F[3] + p[1] * F[4] + p[2] * F[5],
        q[0] * F[6] + q[1] * F[7] + q[2] * F[8], r[0] * F[0] + r[1] * F[1] + r[2] * F[2],
    )  # fmt: skip


@serial
def composed(axes, a, b, c):
    """Symmetric matrix (xx, yy, zz, xy, yz, zx) of eigenvalues a, b, c along the axes, nine elements."""
    n = axes
    return (
        a * n[0] * n[0] + b * n[3] * n[3] + c * n[6] * n[6], a * n[1] * n[1] + b * n[4] * n[4] + c * n[7] * n[7],
        a * n[2] * n[2] + b * n[5] * n[5] + c * n[8] * n[8], a * n[0] * n[1] + b * n[3] * n[4] + c * n[6] * n[7],
        a * n[1] * n[2] + b * n[4] * n[5] + c * n[7] * n[8], a * n[2] * n[0] + b * n[5] * n[3] + c * n[8] * n[6],
    )  # fmt: skip


@serial
def flowed(material, plastic, damage, q, volume, jacobian, state, dt):
    """(share of the deviator that is left, dp, dD) of a trial stress q [Pa] and ln J_e; `state` is p, r, D."""
    p, r, harm = state
    if len(plastic) == 0:
        return 1.0, 0.0, 0.0
    flow = strength.plastic_strain(plastic, q, material.shear, jacobian, r, harm, dt)
    if flow == 0.0:
        return 1.0, 0.0, 0.0
    left = q - 3.0 * material.shear * flow
    if len(damage) == 0:
        return left / q, flow, 0.0
    failure = strength.failure_strain(damage, material.bulk * volume / left, flow / dt, plastic.reference_rate)
    return left / q, flow, strength.damage_growth(damage, p + flow, flow, failure)


@serial
def equivalent(tau):
    """Equivalent stress [Pa] of a symmetric tensor (6,)."""
    a, b, c = tau[0] - tau[1], tau[1] - tau[2], tau[2] - tau[0]
    return math.sqrt(0.5 * (a * a + b * b + c * c) + 3.0 * (tau[3] * tau[3] + tau[4] * tau[4] + tau[5] * tau[5]))


@serial
def unload(back, axes, a, b, c, unloaded):
    """C_p^-1 = F^-1 b_e F^-T (6,) of principal elastic log strains a, b, c; `back` is F^-1."""
    now = carried(back, composed(axes, math.exp(2.0 * a), math.exp(2.0 * b), math.exp(2.0 * c)))
    for k in range(6):
        unloaded[k] = now[k]


@serial
def drawn(tau, back, L, stress):
    """P L (9,) [Pa] of P = tau F^-T, `back` being F^-1."""
    full = (tau[0], tau[3], tau[5], tau[3], tau[1], tau[4], tau[5], tau[4], tau[2])
    for a in range(3):
        x, y, z = full[3 * a], full[3 * a + 1], full[3 * a + 2]
        p = x * back[0] + y * back[1] + z * back[2]
        q = x * back[3] + y * back[4] + z * back[5]
        r = x * back[6] + y * back[7] + z * back[8]
        for b in range(3):
            stress[3 * a + b] = p * L[b] + q * L[3 + b] + r * L[6 + b]


@serial
def least_stretch(back):
    """Bound from below on the stretch of any line element: of (F F^T)^-1 the largest sum of a row is 1/stretch^2 or
    more. `back` is F^-1."""
    most = 0.0
    for a in range(3):
        row = 0.0
        for b in range(3):
            row += abs(back[a] * back[b] + back[3 + a] * back[3 + b] + back[6 + a] * back[6 + b])
        most = max(most, row)
    return 1.0 / math.sqrt(most)


@parallel
def load(material, plastic, damage, ref, dt, gradient, unloaded, strained, hardened, harm, stress, kirchhoff, amounts):
    """Stress after a step of dt [s]: P L (N, 9) [Pa] for the forces, Kirchhoff's tau (N, 6) [Pa].

    unloaded (N, 6) is C_p^-1; strained p, hardened r, harm D (N,) [-]; amounts (N, 3): elastic energy, energy that
    plastic flow took in this step, dp times the mean of the equivalent stresses before and after it, as kicks take the
    work, both of the undeformed volume [J/m3]; the least stretch, 0 of what is turned inside out, which has no stress
    and keeps its energy.
    """
    for i in prange(len(gradient)):
        if ref.free[i]:
            stress[i], kirchhoff[i] = 0.0, 0.0
            amounts[i, 0], amounts[i, 1], amounts[i, 2] = 0.0, 0.0, 1.0
            continue
        F, c = gradient[i], unloaded[i]
        jacobian, back = inverse(F)
        if jacobian <= 0.0:
            amounts[i, 1], amounts[i, 2] = 0.0, 0.0
            continue
        values = principal(*carried(F, c))
        axes = values[3:]
        a, b, c = 0.5 * math.log(values[0]), 0.5 * math.log(values[1]), 0.5 * math.log(values[2])
        volume = a + b + c
        third = volume / 3.0
        a, b, c = a - third, b - third, c - third
        q = 2.0 * material.shear * math.sqrt(1.5 * (a * a + b * b + c * c))
        state = strained[i], hardened[i], harm[i]
        share, flow, grown = flowed(material, plastic, damage, q, volume, jacobian, state, dt)
        if flow > 0.0:
            a, b, c = share * a, share * b, share * c
            strained[i] += flow
            hardened[i] += (1.0 - harm[i]) * flow
            harm[i] += grown
            unload(back, axes, a + third, b + third, c + third, unloaded[i])
        amounts[i, 1] = 0.5 * flow * (equivalent(kirchhoff[i]) + share * q) if flow > 0.0 else 0.0
        pressed, twice = material.bulk * volume, 2.0 * material.shear
        tau = composed(axes, pressed + twice * a, pressed + twice * b, pressed + twice * c)
        for k in range(6):
            kirchhoff[i, k] = tau[k]
        drawn(tau, back, ref.correction[i], stress[i])
        amounts[i, 0] = strength.elastic_energy(material.bulk, material.shear, volume, share * q)
        amounts[i, 2] = least_stretch(back)


@serial
def across(tensor, i, j, X, Y, Z):
    """(T_i + T_j) X of tensors (N, 9)."""
    return (
        (tensor[i, 0] + tensor[j, 0]) * X + (tensor[i, 1] + tensor[j, 1]) * Y + (tensor[i, 2] + tensor[j, 2]) * Z,
        (tensor[i, 3] + tensor[j, 3]) * X + (tensor[i, 4] + tensor[j, 4]) * Y + (tensor[i, 5] + tensor[j, 5]) * Z,
        (tensor[i, 6] + tensor[j, 6]) * X + (tensor[i, 7] + tensor[j, 7]) * Y + (tensor[i, 8] + tensor[j, 8]) * Z,
    )


@fast_parallel
def push(kernel, material, x, y, z, u, v, w, rows, ref, gradient, stress, acceleration, steadying, friction):
    """Accelerations (N, 3) [m/s2] by stress, hourglass control and viscosity; of the last two also alone.

    rho_0 dv_i/dt = sum V_j { (P_i L_i + P_j L_j) grad_0 W + alpha E W/R^2 [(F_i + F_j)/2 X_ij - x_ij]
                              + beta rho_0 c h (v_ij.x_ij)/r^2 (dW/dR) x_ij/r }
    Hourglass control: Ganzenmueller 2015, Comput. Methods Appl. Mech. Engrg. 286, 87, in vectors. Viscosity acts along
    the line of two particles, as they near and as they part. R, X undeformed, r, x of now.
    """
    beta = material.viscosity * material.density * material.sound * kernel.h
    alpha, scale = material.hourglass * material.youngs, 1.0 / material.density
    for i in prange(len(gradient)):
        ax = ay = az = hx = hy = hz = fx = fy = fz = 0.0
        for k in range(rows.number[i]):
            e = place(rows, i, k)
            j, slope = rows.entries[e], ref.slope[e]
            V, linked = ref.volume[j], 0.0 if slope == 0.0 or ref.free[i] or ref.free[j] else 1.0
            X, Y, Z = ref.X[i] - ref.X[j], ref.Y[i] - ref.Y[j], ref.Z[i] - ref.Z[j]
            dx, dy, dz = x[i] - x[j], y[i] - y[j], z[i] - z[j] if len(z) else 0.0
            R2, r2 = X * X + Y * Y + Z * Z, dx * dx + dy * dy + dz * dz
            R, parting = math.sqrt(R2), (u[i] - u[j]) * dx + (v[i] - v[j]) * dy
            parting += (w[i] - w[j]) * dz if len(z) else 0.0

            sx, sy, sz = across(stress, i, j, X, Y, Z)
            ax += V * slope * sx
            ay += V * slope * sy
            az += V * slope * sz

            hold = linked * alpha * V * smoothing.value(kernel, R) / R2
            ox, oy, oz = across(gradient, i, j, X, Y, Z)
            hx += hold * (0.5 * ox - dx)
            hy += hold * (0.5 * oy - dy)
            hz += hold * (0.5 * oz - dz)

            rub = linked * beta * V * slope * R * parting / (r2 * math.sqrt(r2))
            fx += rub * dx
            fy += rub * dy
            fz += rub * dz
        acceleration[i, 0] = scale * (ax + hx + fx)
        acceleration[i, 1] = scale * (ay + hy + fy)
        acceleration[i, 2] = scale * (az + hz + fz)
        steadying[i, 0], steadying[i, 1], steadying[i, 2] = scale * hx, scale * hy, scale * hz
        friction[i, 0], friction[i, 1], friction[i, 2] = scale * fx, scale * fy, scale * fz


@parallel
def kick(mass, active, acceleration, steadying, friction, pressed, dt, u, v, w):
    """v += a dt of the particles that move; work [J] in it of all forces, of hourglass control, of viscosity, and of
    pressure (N, 3) where there is one: force times dt times the mean of the velocities before and after it."""
    whole = steady = rubbed = inflated = 0.0
    for n in prange(len(active)):
        i = active[n]
        du, dv = dt * acceleration[i, 0], dt * acceleration[i, 1]
        dw = dt * acceleration[i, 2] if len(w) else 0.0
        mx, my, mz = u[i] + 0.5 * du, v[i] + 0.5 * dv, w[i] + 0.5 * dw if len(w) else 0.0
        u[i] += du
        v[i] += dv
        if len(w):
            w[i] += dw
        way = dt * mass[i]
        whole += mass[i] * (mx * du + my * dv + mz * dw)
        steady += way * (mx * steadying[i, 0] + my * steadying[i, 1] + mz * steadying[i, 2])
        rubbed += way * (mx * friction[i, 0] + my * friction[i, 1] + mz * friction[i, 2])
        if len(pressed):
            inflated += way * (mx * pressed[i, 0] + my * pressed[i, 1] + mz * pressed[i, 2])
    return whole, steady, rubbed, inflated
