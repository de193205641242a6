"""Grains that come closer than they lie when packed are moved apart, so that shear leaves fewer clumps.

Where particles stream past each other, summation of pressures lets them pair up, and their lattice bears a stress that
no grain has. A pair nearer than the spacing L of packed grains is parted in the time in which it passes:

    dr_i/dt = v_i + strength sum_j m_j/(m_i + m_j) |v_ij| (1 - r_ij/L) r_ij/r_ij,    r_ij < L,

a shift along the pair as in Xu, Stansby & Laurence 2009, J. Comput. Phys. 228, 6703, with the speed of the pair for
that of the flow. Mass, momentum, heat and agitation go with the particle and their sums do not change; the centre of
mass stays where it is, to round-off, pair by pair. Angular momentum changes by sum m shift x v. Grains at rest or in
free flight together are not shifted.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import prange

from sdph.effects import limiter
from sdph.effects.effect import Effect, Judgement
from sdph.engine import state as particles
from sdph.engine.geometry import nearest_image
from sdph.engine.rows import entry
from sdph.laws.compiled import parallel
from sdph.schema import quantity, record

WORTH = 0.006  # of the heat to the grains: what it changed in the bubbling bed


@record
class GrainShifting:
    strength: float = quantity("", 1.0, above=0.0, most=1e3)


class ShiftingP(NamedTuple):
    """Strength [-]; mass of grains over the volume that they take when packed [kg/m3], of several materials of the
    first; that material's density [kg/m3]; dimensions."""

    strength: float
    packed: float
    grain_density: float
    dimensions: float


def kernel(case) -> ShiftingP:
    return ShiftingP(
        case.parameters["grain_shifting"].strength,
        case.grains.packing_limit * case.grains.density,
        case.grains.density,
        float(case.dimensions),
    )


@parallel
def shift(p, s, rows, box, dt, moved):
    """moved (N, 3) [m] of every particle within dt [s]."""
    for i in prange(len(s.x)):
        x = y = z = 0.0
        for k in range(rows.number[i]):
            j = entry(rows, i, k)
            dx, dy, dz = nearest_image(box, s.x[i] - s.x[j], s.y[i] - s.y[j], s.z[i] - s.z[j] if len(s.z) else 0.0)
            r = math.sqrt(dx * dx + dy * dy + dz * dz)
            whole = s.mass[i] + s.mass[j]
            if len(s.grain_density):
                whole = p.grain_density * (s.mass[i] / s.grain_density[i] + s.mass[j] / s.grain_density[j])
            reach = (0.5 * whole / p.packed) ** (1.0 / p.dimensions)
            if r >= reach or r == 0.0:
                continue
            dw = s.w[i] - s.w[j] if len(s.z) else 0.0
            speed = math.sqrt((s.u[i] - s.u[j]) ** 2 + (s.v[i] - s.v[j]) ** 2 + dw * dw)
            part = p.strength * s.mass[j] / (s.mass[i] + s.mass[j]) * speed * dt * (1.0 / r - 1.0 / reach)
            x += part * dx
            y += part * dy
            z += part * dz
        moved[i, 0], moved[i, 1], moved[i, 2] = x, y, z


def held(p, method) -> dict[str, float]:
    """Share of the particles that the last sub-step shifted, and the longest shift [m]."""
    far = particles.lengths(method.shifted) if len(method.shifted) else np.zeros(len(method.state.x))
    return {
        "shifted_share": limiter.share(method.state, far > 0.0),
        "shift_m": method.world.most(float(far.max(initial=0.0))),
    }


def call(scales) -> Judgement:
    """Clumps grow where grains are strained; what they are worth was measured once."""
    strain = scales.speed * scales.end / scales.length if scales.collides and scales.length else 0.0
    return Judgement(
        "strain of the grains in the run", strain, 1.0, "the bed with it and without", WORTH * min(1.0, strain)
    )


EFFECT = Effect(
    name="grain_shifting",
    summary="grains nearer than packed are moved apart as they stream past each other",
    parameters=GrainShifting,
    kernel=kernel,
    moves=True,
    held=held,
    call=call,
)
