"""How the grains are sheared, and the stress that their lasting contacts set against it.

The stress of contacts is one tensor per particle, as S of the paper (Eq. 22). The pair sum of its divergence is the
adjoint of the velocity gradient (1/rho_i) sum m_j (v_j - v_i) grad W, so that what it takes from the motion is tau:D of
each particle, to round-off.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit, prange

from sdph.effects.around import walls
from sdph.effects.grains import friction
from sdph.engine.geometry import deep
from sdph.engine.rows import entry, length, place
from sdph.laws.friction import second_invariant
from sdph.methods.grains.equations import approach, loop, separation


class Shearing(NamedTuple):
    """Per particle: stress of contacts, elastic and viscous, over density squared (N, 6) [Pa m6/kg2], xx, yy, zz, xy,
    yz, zx; viscosity of contacts (N,) [Pa s], both () without contacts; work of the elastic stress (N,) [W/kg];
    I2D = dev(D):dev(D)/2 (N,) [1/s2] and div v (N,) [1/s]."""

    traction: np.ndarray
    rubbing: np.ndarray
    contact_work: np.ndarray
    shear_squared: np.ndarray
    divergence: np.ndarray


def nothing(count: int) -> Shearing:
    """Of grains whose shear nobody asks for."""
    return Shearing((), (), *(np.zeros(count) for _ in range(3)))


def empty(count: int, contacts: bool) -> Shearing:
    tensors = (np.empty((count, 6)), np.empty(count)) if contacts else ((), ())
    return Shearing(*tensors, *(np.empty(count) for _ in range(3)))


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
    kernel, s, rows, box, pull, stress, walls_p, dummies, wall_rows, friction_p, dt,
    held_xx, held_yy, held_xy, held_yz, held_zx, traction, rubbing, contact_work, shear_squared, divergence,
):  # fmt: skip
    """The fields of `Shearing`, from velocities as they are; contacts are strained over dt [s]: `held` is the state's
    own stress."""
    for i in prange(len(s.x)):
        xx, xy, xz, yx, yy, yz, zx, zy, zz = gradient(s, rows, box, pull, i)
        if walls.near(walls_p, wall_rows, i):
            behind = walls.gradient(walls_p, kernel, box, dummies, wall_rows, s, i)
            xx, xy, xz = xx + behind[0], xy + behind[1], xz + behind[2]
            yx, yy, yz = yx + behind[3], yy + behind[4], yz + behind[5]
            zx, zy, zz = zx + behind[6], zy + behind[7], zz + behind[8]
        third = (xx + yy + zz) / 3.0
        D = xx - third, yy - third, zz - third, 0.5 * (xy + yx), 0.5 * (yz + zy), 0.5 * (zx + xz)
        shear_squared[i] = second_invariant(*D)
        divergence[i] = 3.0 * third
        contact_work[i] = 0.0
        if len(friction_p):
            spin = 0.5 * (xy - yx), 0.5 * (yz - zy), 0.5 * (zx - xz)
            tau, rubbing[i] = friction.stress(friction_p, stress, s, i, D, spin, dt)
            held_xx[i], held_yy[i], held_xy[i] = tau[0], tau[1], tau[3]
            if deep(box):
                held_yz[i], held_zx[i] = tau[4], tau[5]
            for a in range(6):
                traction[i, a] = (tau[a] + 2.0 * rubbing[i] * D[a]) / s.density[i] ** 2
            contact_work[i] = friction.power(tau, D) / s.density[i]
