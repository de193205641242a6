"""Shear of the grains, and the stress that their lasting contacts set against it.

The stress of contacts is one tensor per particle, as S of the paper (Eq. 22). The pair sum of its divergence is the
adjoint of the velocity gradient (1/rho_i) sum m_j (v_j - v_i) grad W, so that what it takes from the motion is tau:D of
each particle, to round-off. Viscous stress is in `sdph.methods.grains.stress`.
"""

from __future__ import annotations

from numba import prange

from sdph.effects.around import walls
from sdph.effects.grains import friction, granular_viscosity
from sdph.engine.geometry import apart, deep, faster
from sdph.engine.rows import entry, length, place
from sdph.laws.compiled import fast_parallel, inlined
from sdph.laws.friction import second_invariant
from sdph.methods.grains import mixture, stress

NOTHING = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@inlined
def moments(kernel, s, rows, box, pull, i):
    """N = (1/rho_i) sum m_j (v_j - v_i)_a dW/dx_b [1/s]: xx, xy, xz, yx, yy, yz, zx, zy, zz; M, of r_ij for v_ij [-]:
    xx, yy, zz (1 in two dimensions), xy, yz, zx; and -(1/rho_i) sum m_j |v_ij|^2 (dW/dr)/r [1/s2].

    Of several materials rho_pi/rho_pj m_j stands for m_j (sdph.methods.grains.mixture)."""
    xx = xy = xz = yx = yy = yz = zx = zy = zz = square = 0.0
    mxx = myy = mzz = mxy = myz = mzx = 0.0
    for k in range(length(rows, i)):
        j = entry(rows, i, k)
        dx, dy, dz = apart(s, box, i, j)
        du, dv, dw = faster(s, box, i, j)
        g = -pull[place(rows, i, k)] * mixture.over(kernel, s, i, j)
        gx, gy = g * dx, g * dy
        xx += gx * du
        xy += gy * du
        yx += gx * dv
        yy += gy * dv
        mxx += gx * dx
        myy += gy * dy
        mxy += gx * dy
        square += g * (du * du + dv * dv + dw * dw)
        if deep(box):
            gz = g * dz
            xz += gz * du
            yz += gz * dv
            zx += gx * dw
            zy += gy * dw
            zz += gz * dw
            mzz += gz * dz
            myz += gy * dz
            mzx += gx * dz
    per = 1.0 / s.density[i]
    mzz = mzz * per if deep(box) else 1.0
    N = xx * per, xy * per, xz * per, yx * per, yy * per, yz * per, zx * per, zy * per, zz * per
    return N, (mxx * per, myy * per, mzz, mxy * per, myz * per, mzx * per), square * per


@inlined
def added(a, b):
    """Sum of two gradients [1/s]."""
    return (
        a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3], a[4] + b[4], a[5] + b[5], a[6] + b[6], a[7] + b[7],
        a[8] + b[8],
    )  # fmt: skip


@inlined
def symmetric(G):
    """xx, yy, zz, xy, yz, zx [1/s] of the symmetric part of a gradient."""
    return G[0], G[4], G[8], 0.5 * (G[1] + G[3]), 0.5 * (G[5] + G[7]), 0.5 * (G[6] + G[2])


@inlined
def deviator(G):
    """Trace [1/s] of a gradient, and the deviator of its symmetric part (6)."""
    xx, yy, zz, xy, yz, zx = symmetric(G)
    rate = xx + yy + zz
    return rate, (xx - rate / 3.0, yy - rate / 3.0, zz - rate / 3.0, xy, yz, zx)


@fast_parallel
def shear(
    kernel, s, rows, box, scratch, walls_p, wall, friction_p, viscous_p, dt,
    contact, traction, rubbing, bearing, works, strain,
):  # fmt: skip
    """Shear of velocities as they are (see `equations.Scratch`); contact (5, N) [Pa]: stress of contacts of the state
    once they are strained over dt [s]."""
    for i in prange(len(s.x)):
        N, M, square = moments(kernel, s, rows, box, scratch.pull, i)
        beside = walls.near(walls_p, kernel, box, wall, s, i)
        behind = walls.gradient(walls_p, kernel, box, wall, s, i) if beside else stress.NO_GRADIENT
        G = added(N, behind)
        rate, D = deviator(G)
        strain[0, i], strain[1, i] = second_invariant(*D), rate
        tau, mu, warm = NOTHING, 0.0, 0.0
        per = 1.0 / s.density[i]
        if len(friction_p):
            spin = 0.5 * (G[1] - G[3]), 0.5 * (G[5] - G[7]), 0.5 * (G[6] - G[2])
            tau, mu = friction.stress(friction_p, scratch, kernel, s, box, i, D, spin, dt)
            rubbing[i] = mu
            contact[0, i], contact[1, i], contact[2, i] = tau[0], tau[1], tau[3]
            contact[3, i], contact[4, i] = tau[4], tau[5]
            for a in range(6):
                traction[i, a] = (tau[a] + 2.0 * mu * D[a]) * per * per
            # what contacts rub on walls stays in the grains
            warm = friction.power(tau, D) + 2.0 * mu * friction.power(D, symmetric(behind))
        if len(friction_p) + len(viscous_p):
            enclosed = not beside and stress.determinant(M) > stress.ENCLOSED
            strain[2, i] = 1.0 if enclosed else 0.0
            total = mu + scratch.shear[i]
            A, sheared, squeezed = stress.NO_GRADIENT, square, 0.0
            if enclosed:
                A, sheared, squeezed = stress.viscous(N, M, square, total, scratch.bulk[i])
            stress.bear(bearing, i, box, per * per * mixture.heft_squared(kernel, s, i), total, A, tau)
            lost = scratch.shear[i] * sheared + scratch.bulk[i] * squeezed
            fed = granular_viscosity.fed(viscous_p, lost)
            works[0, i] = fed * per
            warm += mu * sheared + (lost - fed)
        works[1, i] = warm * per
