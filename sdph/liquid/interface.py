"""The interface of two phases: its normals, its curvature and the force of surface tension.

Adami, Hu & Adams 2010, J. Comput. Phys. 229, 5011. Each particle's normal points out of its own phase.
"""

from __future__ import annotations

import numpy as np
from numba import njit, prange

from sdph import smoothing
from sdph.liquid.pairs import FAST, apart


@njit(cache=True, parallel=True, error_model="numpy", fastmath=FAST)
def orient(kernel, s, rows, box, active, tension_p, volume, colour, normal):
    """colour (N, 3): gradient of colour [1/m], 0 in the own phase and 1 in the other, averaged as the pressure is (Eq. 13);
    normal (N, 3): its direction, 0 off the interface."""
    for n in prange(len(active)):
        i = active[n]
        gx = gy = gz = px = py = pz = 0.0
        for k in range(rows.count[i]):
            j = rows.index[i, k]
            dx, dy, dz = apart(s, box, i, j)
            unlike = max(volume[j], 0.0) if s.kind[i] != s.kind[j] else 0.0
            steep = unlike * smoothing.slope(kernel, np.sqrt(dx * dx + dy * dy + dz * dz))
            lead = steep * 2.0 * s.density[i] / (s.density[i] + s.density[j])
            gx += lead * dx
            gy += lead * dy
            gz += lead * dz
            px += steep * dx
            py += steep * dy
            pz += steep * dz
        size = np.sqrt(px * px + py * py + pz * pz)
        inverse = 1.0 / size if size > tension_p.least else 0.0
        colour[i, 0], colour[i, 1], colour[i, 2] = gx, gy, gz
        normal[i, 0], normal[i, 1], normal[i, 2] = inverse * px, inverse * py, inverse * pz


@njit(cache=True, parallel=True, error_model="numpy", fastmath=FAST)
def bend(kernel, s, rows, box, active, tension_p, volume, normal, curvature):
    """curvature (N,) [1/m]: div n over the particles that have a normal, with that of the other phase turned (Eq. 20)."""
    for n in prange(len(active)):
        i = active[n]
        curvature[i] = 0.0
        if normal[i, 0] == 0.0 and normal[i, 1] == 0.0 and normal[i, 2] == 0.0:
            continue
        bent = full = 0.0
        for k in range(rows.count[i]):
            j = rows.index[i, k]
            dx, dy, dz = apart(s, box, i, j)
            r2 = dx * dx + dy * dy + dz * dz
            on = normal[j, 0] != 0.0 or normal[j, 1] != 0.0 or normal[j, 2] != 0.0
            weight = max(volume[j], 0.0) * smoothing.slope(kernel, np.sqrt(r2)) if on else 0.0
            turn = 1.0 if s.kind[i] == s.kind[j] else -1.0
            nx, ny, nz = normal[i, 0] - turn * normal[j, 0], normal[i, 1] - turn * normal[j, 1], normal[i, 2] - turn * normal[j, 2]
            bent += weight * (nx * dx + ny * dy + nz * dz)
            full += weight * r2
        curvature[i] = tension_p.dimensions * bent / full if full < 0.0 else 0.0


@njit(cache=True, parallel=True, error_model="numpy")
def pull(s, active, tension_p, colour, curvature, acceleration):
    """a -= sigma kappa grad c/rho (Eq. 14)."""
    for n in prange(len(active)):
        i = active[n]
        strength = tension_p.coefficient * curvature[i] / s.density[i]
        acceleration[i, 0] -= strength * colour[i, 0]
        acceleration[i, 1] -= strength * colour[i, 1]
        acceleration[i, 2] -= strength * colour[i, 2]
