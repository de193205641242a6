"""The interface of two phases: its normals, its curvature and the force of surface tension.

Adami, Hu & Adams 2010, J. Comput. Phys. 229, 5011, but for two things. The divergence of normals is corrected by the
renormalisation matrix, because the particles that have normals are a band, wider along the interface than across. And
a pair across the interface feels the mean of its two curvatures, which is that of the interface between them; of a
disc with R = 20 dx a particle's own is off by 3 %.
"""

from __future__ import annotations

import math

import numpy as np
from numba import prange

from sdph.engine import kernels as smoothing
from sdph.engine.geometry import apart
from sdph.engine.gradients import NO_MATRIX, NO_SUMS, added, divided, in_plane
from sdph.engine.rows import entry
from sdph.engine.state import LIQUID
from sdph.laws.compiled import fast_parallel, serial
from sdph.methods.liquids import wetting


@fast_parallel
def orient(kernel, s, rows, box, active, tension_p, volume, line, normal):
    """normal (N, 3): direction of sum V_j grad W over the particles of the other phase, out of the own; 0 off the
    interface. line: what walls stand for, or ()."""
    for n in prange(len(active)):
        i = active[n]
        gx = gy = gz = 0.0
        for k in range(rows.number[i]):
            j = entry(rows, i, k)
            dx, dy, dz = apart(s, box, i, j)
            unlike = max(volume[j], 0.0) if s.kind[i] != s.kind[j] else 0.0
            if len(line):
                unlike += wetting.opposite(line, s.kind[i], volume[j], j)
            steep = unlike * smoothing.slope(kernel, math.sqrt(dx * dx + dy * dy + dz * dz))
            gx += steep * dx
            gy += steep * dy
            gz += steep * dz
        size = math.sqrt(gx * gx + gy * gy + gz * gz)
        inverse = 1.0 / size if size > tension_p.least else 0.0
        normal[i, 0], normal[i, 1], normal[i, 2] = inverse * gx, inverse * gy, inverse * gz


@serial
def on_interface(normal, i):
    """True where particle i has a normal."""
    return normal[i, 0] != 0.0 or normal[i, 1] != 0.0 or normal[i, 2] != 0.0


@fast_parallel
def bend(kernel, s, rows, box, active, volume, line, normal, curvature):
    """curvature (N,) [1/m]: div n, above 0 around a drop on both sides; over particles with normals, those of the other
    phase turned (Eq. 20), and those of walls where they are met."""
    for n in prange(len(active)):
        i = active[n]
        curvature[i] = 0.0
        if not on_interface(normal, i):
            continue
        matrix, sums = NO_MATRIX, NO_SUMS
        for k in range(rows.number[i]):
            j = entry(rows, i, k)
            dx, dy, dz = apart(s, box, i, j)
            weight = max(volume[j], 0.0) if on_interface(normal, j) else 0.0
            share = weight * smoothing.slope(kernel, math.sqrt(dx * dx + dy * dy + dz * dz))
            turn = 1.0 if s.kind[i] == s.kind[j] else -1.0
            du, dv, dw = (
                normal[i, 0] - turn * normal[j, 0],
                normal[i, 1] - turn * normal[j, 1],
                normal[i, 2] - turn * normal[j, 2],
            )
            if len(line) and volume[j] < 0.0 and on_interface(normal, j):
                share = -volume[j] * smoothing.slope(kernel, math.sqrt(dx * dx + dy * dy + dz * dz))
                turn, far = 1.0 if s.kind[i] == LIQUID else -1.0, wetting.beyond(line, i, dx, dy, dz)
                du, dv, dw = (
                    far * (normal[i, 0] - turn * normal[j, 0]),
                    far * (normal[i, 1] - turn * normal[j, 1]),
                    far * (normal[i, 2] - turn * normal[j, 2]),
                )
            matrix, sums = added(matrix, sums, share, dx, dy, dz, du, dv, dw)
        found = divided(in_plane(matrix, len(s.z) == 0), sums)
        curvature[i] = (found[0] + found[4] + found[8]) * (1.0 if s.kind[i] == LIQUID else -1.0)


@fast_parallel
def pull(kernel, s, rows, box, active, tension_p, volume, normal, curvature, acceleration):
    """a -= sigma kappa grad c/rho (Eq. 14), grad c with the inter-particle average of the pressure (Eq. 13)."""
    for n in prange(len(active)):
        i = active[n]
        if not on_interface(normal, i):
            continue
        outwards = 1.0 if s.kind[i] == LIQUID else -1.0
        ax = ay = az = 0.0
        for k in range(rows.number[i]):
            j = entry(rows, i, k)
            dx, dy, dz = apart(s, box, i, j)
            unlike = max(volume[j], 0.0) if s.kind[i] != s.kind[j] else 0.0
            steep = (
                unlike
                * smoothing.slope(kernel, math.sqrt(dx * dx + dy * dy + dz * dz))
                * 2.0
                / (s.density[i] + s.density[j])
            )
            bent = 0.5 * (curvature[i] + curvature[j]) if on_interface(normal, j) else curvature[i]
            strength = tension_p.coefficient * bent * outwards * steep
            ax += strength * dx
            ay += strength * dy
            az += strength * dz
        acceleration[i, 0] -= ax
        acceleration[i, 1] -= ay
        acceleration[i, 2] -= az


def tighten(stepper) -> None:
    """Adds surface tension to the accelerations of a stepper (sdph.methods.liquids.method)."""
    own, volume, normal = stepper.p["surface_tension"], stepper.volume, stepper.normal
    around = stepper.kernel, stepper.state, stepper.rows, stepper.neighbours.box
    line, before = (), stepper.acceleration.copy()
    orient(*around, stepper.active, own, volume, line, normal)
    refresh = stepper.domain.refresh
    refresh(normal)
    if len(own) > 2 and stepper.world.any(len(stepper.walls) > 0):
        height, share = np.zeros(len(volume)), np.zeros(len(volume))
        line = wetting.Line(np.zeros_like(normal), height, share, np.zeros(len(volume), np.int8))
        wetting.face(*around, stepper.active, own, volume, line.facing, line.height)
        refresh(line.facing, line.height)
        wetting.lean(*around, stepper.walls, own, normal, line.facing, line.share, line.meeting)
        refresh(line.share)
        orient(*around, stepper.active, own, volume, line, normal)
        refresh(normal)
    bend(*around, stepper.active, volume, line, normal, stepper.curvature)
    refresh(stepper.curvature)
    pull(*around, stepper.active, own, volume, normal, stepper.curvature, stepper.acceleration)
    stepper.line, stepper.tightening = line, stepper.acceleration - before
