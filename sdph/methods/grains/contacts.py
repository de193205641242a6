"""Shear of the grains, and the stress that their lasting contacts set against it.

The stress of contacts is one tensor per particle, as S of the paper (Eq. 22). The pair sum of its divergence is the
adjoint of the velocity gradient (1/rho_i) sum m_j (v_j - v_i) grad W, so that what it takes from the motion is tau:D of
each particle, to round-off.
"""

from __future__ import annotations

from numba import njit, prange

from sdph.effects.around import walls
from sdph.effects.grains import friction
from sdph.engine.geometry import deep
from sdph.engine.rows import entry, length, place
from sdph.laws.friction import second_invariant
from sdph.methods.grains.equations import approach, loop, separation


@njit(cache=True, error_model="numpy", forceinline=True)  # to hand over the whole state costs more than this
def gradient(s, rows, box, pull, i):
    """(1/rho_i) sum m_j (v_j - v_i)_a dW/dx_b [1/s]: xx, xy, xz, yx, yy, yz, zx, zy, zz."""
    xx = xy = xz = yx = yy = yz = zx = zy = zz = 0.0
    for k in range(length(rows, i)):
        j = entry(rows, i, k)
        dx, dy, dz, _ = separation(s, box, i, j)
        du, dv, dw = approach(s, box, i, j)
        g = -pull[place(rows, i, k)]
        xx += g * du * dx
        xy += g * du * dy
        yx += g * dv * dx
        yy += g * dv * dy
        if deep(box):
            xz += g * du * dz
            yz += g * dv * dz
            zx += g * dw * dx
            zy += g * dw * dy
            zz += g * dw * dz
    per = 1.0 / s.density[i]
    return xx * per, xy * per, xz * per, yx * per, yy * per, yz * per, zx * per, zy * per, zz * per


@loop
def shear(
    kernel, s, rows, box, scratch, walls_p, wall, friction_p, dt,
    contact, traction, rubbing, contact_work, shear_squared, divergence,
):  # fmt: skip
    """Shear of velocities as they are (see `equations.Scratch`); contact (5, N) [Pa]: stress of contacts of the state
    once they are strained over dt [s]."""
    for i in prange(len(s.x)):
        xx, xy, xz, yx, yy, yz, zx, zy, zz = gradient(s, rows, box, scratch.pull, i)
        B = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0  # the share of walls in the rate of strain
        if walls.near(walls_p, wall, i):
            behind = walls.gradient(walls_p, kernel, box, wall, s, i)
            xx, xy, xz = xx + behind[0], xy + behind[1], xz + behind[2]
            yx, yy, yz = yx + behind[3], yy + behind[4], yz + behind[5]
            zx, zy, zz = zx + behind[6], zy + behind[7], zz + behind[8]
            B = (
                behind[0], behind[4], behind[8],
                0.5 * (behind[1] + behind[3]), 0.5 * (behind[5] + behind[7]), 0.5 * (behind[6] + behind[2]),
            )  # fmt: skip
        third = (xx + yy + zz) / 3.0
        D = xx - third, yy - third, zz - third, 0.5 * (xy + yx), 0.5 * (yz + zy), 0.5 * (zx + xz)
        shear_squared[i] = second_invariant(*D)
        divergence[i] = 3.0 * third
        contact_work[i] = 0.0
        if len(friction_p):
            spin = 0.5 * (xy - yx), 0.5 * (yz - zy), 0.5 * (zx - xz)
            tau, rubbing[i] = friction.stress(friction_p, scratch, s, i, D, spin, dt)
            contact[0, i], contact[1, i], contact[2, i] = tau[0], tau[1], tau[3]
            contact[3, i], contact[4, i] = tau[4], tau[5]
            for a in range(6):
                traction[i, a] = (tau[a] + 2.0 * rubbing[i] * D[a]) / s.density[i] ** 2
            # what contacts rub on walls stays in the grains; on each other it is counted pair by pair
            rubbed = 2.0 * rubbing[i] * friction.power(D, B)
            contact_work[i] = (friction.power(tau, D) + rubbed) / s.density[i]
