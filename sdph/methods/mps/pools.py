"""Loops over neighbours of pools: pressure by differences inside, walls, particles kept apart.

The gradient is the corrected one, exact of linear fields on any arrangement; at the surface it is along the normal that
of pairs, which is the same with p = 0 half a spacing out, where the matrix has it too (MIRROR). The Laplacian is made
exact of linear fields by the slope of the last pressure. What is at rest is not shifted. Each of these keeps water at
rest (docs/theory/mps.md).
"""

from __future__ import annotations

import math

from numba import prange

from sdph.engine.geometry import faster
from sdph.engine.rows import entry
from sdph.laws.compiled import inlined, parallel
from sdph.laws.matrices import SINGULAR, solved
from sdph.methods.mps.equations import ASIDE, seen
from sdph.methods.mps.tanks import across, least, rise, solid

MIRROR = 2.0  # what a particle at the surface lacks has its pressure with the sign turned: 0 is half-way
NORMAL = 0.01  # of n_0: who sees less of those at the surface has no normal of it; our choice, a fifth of the third row


@inlined
def determinant(m):
    """Determinant of a symmetric matrix (xx, yy, zz, xy, yz, zx)."""
    a, b, c = m[1] * m[2] - m[4] * m[4], m[5] * m[4] - m[3] * m[2], m[3] * m[4] - m[5] * m[1]
    return m[0] * a + m[3] * b + m[5] * c


@parallel
def diverge(cloud, walls, s, rows, box, surface, divergence):
    """divergence (N,) [1/s] of the liquid as if it went on behind walls as it does in front: `equations.diverge`
    without walls; beside them, but at the surface, by differences that are exact of linear fields."""
    for i in prange(len(s.x)):
        total = xx = yy = zz = xy = yz = zx = 0.0
        ux = uy = uz = vx = vy = vz = wx = wy = wz = 0.0
        walled = False
        for k in range(rows.number[i]):
            j = entry(rows, i, k)
            dx, dy, dz, r, w = seen(cloud, s, box, i, j)
            if w == 0.0 or solid(walls, s, j):
                walled = walled or w > 0.0
                continue
            per = w / (r * r)
            du, dv, dw = faster(s, box, j, i)
            total += per * (du * dx + dv * dy + dw * dz)
            xx += per * dx * dx
            yy += per * dy * dy
            zz += per * dz * dz
            xy += per * dx * dy
            yz += per * dy * dz
            zx += per * dz * dx
            ux, uy, uz = ux + per * du * dx, uy + per * du * dy, uz + per * du * dz
            vx, vy, vz = vx + per * dv * dx, vy + per * dv * dy, vz + per * dv * dz
            wx, wy, wz = wx + per * dw * dx, wy + per * dw * dy, wz + per * dw * dz
        share = cloud.dimensions / cloud.number
        divergence[i] = share * total
        if walled and surface[i] == 0:
            m = share * xx, share * yy, share * zz if cloud.dimensions > 2.0 else 1.0
            m = m[0], m[1], m[2], share * xy, share * yz, share * zx
            if determinant(m) > SINGULAR:
                found = solved(*m, ux, uy, uz)[0] + solved(*m, vx, vy, vz)[1] + solved(*m, wx, wy, wz)[2]
                divergence[i] = share * found


@parallel
def look_in(cloud, walls, s, rows, box, surface, aside):
    """aside (N, 3): sum w r_ij/r of a particle at the surface, into the liquid; 0 of others."""
    for i in prange(len(s.x)):
        ox = oy = oz = 0.0
        if surface[i] == 1:
            for k in range(rows.number[i]):
                dx, dy, dz, r, w = seen(cloud, s, box, i, entry(rows, i, k))
                per = w / r
                ox, oy, oz = ox + per * dx, oy + per * dy, oz + per * dz
        aside[i, 0], aside[i, 1], aside[i, 2] = ox, oy, oz


@parallel
def straighten(cloud, walls, s, rows, box, surface, pushed, right):
    """Make the pressure's equations exact of linear fields away from the surface: add to right (N,) what neighbours
    that lie to one side give by a slope alone, sum w r_ij.grad p, -grad p/rho being pushed (N, 3) [m/s2]."""
    for i in prange(len(s.x)):
        if surface[i] == 1 or solid(walls, s, i):
            continue
        total = 0.0
        for k in range(rows.number[i]):
            j = entry(rows, i, k)
            dx, dy, dz, _, w = seen(cloud, s, box, i, j)
            if solid(walls, s, j):
                dx, dy, dz = across(walls, s, j, dx, dy, dz)
            total += w * (dx * pushed[i, 0] + dy * pushed[i, 1] + dz * pushed[i, 2])
        right[i] += cloud.density * total


@parallel
def lean(cloud, walls, s, rows, box, scale, right):
    """Add what walls give to the pressure's equations, sum w (p_j - p_i) over them, to right (N,); of walls it is
    0."""
    for i in prange(len(s.x)):
        if solid(walls, s, i):
            right[i] = 0.0
            continue
        for k in range(rows.number[i]):
            j = entry(rows, i, k)
            if solid(walls, s, j):
                dx, dy, dz, _, w = seen(cloud, s, box, i, j)
                right[i] += w * rise(s, scale, i, *across(walls, s, j, dx, dy, dz))


@inlined
def along(share, shortest, ex, ey, ez, gx, gy, gz, dx, dy, dz):
    """A gradient g and a `share` of what another has more, d, along the normal e; of all of it where e is not longer
    than `shortest`: there is no normal."""
    length = math.sqrt(ex * ex + ey * ey + ez * ez)
    if length <= shortest:
        return gx + share * dx, gy + share * dy, gz + share * dz
    part = share * (ex * dx + ey * dy + ez * dz) / (length * length)
    return gx + part * ex, gy + part * ey, gz + part * ez


@parallel
def press(cloud, walls, s, rows, box, pressure, surface, aside, scale, acceleration, borne):
    """acceleration (N, 3) [m/s2] by the pressure, and borne (N, 3): what of it walls would give by pairs, which is
    their load; scale: rho/dt.

    The gradient is the one that fits best to the differences along pairs, and to the rise across walls; at the surface
    along its normal, or where it has none, that of pairs. By pairs the pressure of a wall changes along it as that
    gradient says. Under tension pairs would draw together: it is taken from differences at the surface too.
    """
    share, light = cloud.dimensions / cloud.number, -1.0 / cloud.density
    for i in prange(len(s.x)):
        p_i = pressure[i]
        ax = ay = az = bx = by = bz = gx = gy = gz = xx = yy = zz = xy = yz = zx = 0.0
        txx = tyy = tzz = txy = tyz = tzx = 0.0
        ex, ey, ez = aside[i, 0], aside[i, 1], aside[i, 2]
        for k in range(rows.number[i]):
            j = entry(rows, i, k)
            dx, dy, dz, r, w = seen(cloud, s, box, i, j)
            if w == 0.0:
                continue
            per, p_j, nx, ny, nz = share * w / (r * r), pressure[j], dx, dy, dz
            if solid(walls, s, j):
                nx, ny, nz = across(walls, s, j, dx, dy, dz)
                p_j = least(walls, p_i + rise(s, scale, i, nx, ny, nz))
                both = per * (p_i + p_j)
                bx, by, bz = bx + both * dx, by + both * dy, bz + both * dz
                tx, ty, tz = dx - nx, dy - ny, dz - nz
                txx, tyy, tzz = txx + per * tx * tx, tyy + per * ty * ty, tzz + per * tz * tz
                txy, tyz, tzx = txy + per * tx * ty, tyz + per * ty * tz, tzx + per * tz * tx
            ex, ey, ez = ex + w * aside[j, 0], ey + w * aside[j, 1], ez + w * aside[j, 2]
            both, more = per * (p_i + p_j), per * (p_j - p_i)
            ax, ay, az = ax + both * dx, ay + both * dy, az + both * dz
            gx, gy, gz = gx + more * nx, gy + more * ny, gz + more * nz
            xx, yy, zz = xx + per * nx * nx, yy + per * ny * ny, zz + per * nz * nz
            xy, yz, zx = xy + per * nx * ny, yz + per * ny * nz, zx + per * nz * nx
        m = xx, yy, zz if cloud.dimensions > 2.0 else 1.0, xy, yz, zx
        gx, gy, gz = solved(*m, gx, gy, gz)
        ax += txx * gx + txy * gy + tzx * gz
        ay += txy * gx + tyy * gy + tyz * gz
        az += tzx * gx + tyz * gy + tzz * gz
        if determinant(m) > SINGULAR:
            more = 0.0 if surface[i] == 0 or p_i < 0.0 else 1.0
            ax, ay, az = along(more, ASIDE * cloud.number, ex, ey, ez, gx, gy, gz, ax - gx, ay - gy, az - gz)
        acceleration[i, 0], acceleration[i, 1], acceleration[i, 2] = light * ax, light * ay, light * az
        borne[i, 0], borne[i, 1], borne[i, 2] = light * bx, light * by, light * bz


@inlined
def level(shortest, ex, ey, ez, ox, oy, oz):
    """A vector o without its part along the normal e; 0 where e is not longer than `shortest`: there is no normal."""
    length = math.sqrt(ex * ex + ey * ey + ez * ez)
    if length <= shortest:
        return 0.0, 0.0, 0.0
    part = (ex * ox + ey * oy + ez * oz) / (length * length)
    return ox - part * ex, oy - part * ey, oz - part * ez


@parallel
def keep_apart(cloud, walls, s, rows, box, beside, aside, strength, way):
    """way (N, 3) [m] towards where neighbours are few: -strength |u| sum (w/n_0) r_ij/r, strength [s]; beside the
    surface along it; 0 of walls. What is at rest is not moved, as with Skillen et al. 2013."""
    for i in prange(len(s.x)):
        ox = oy = oz = 0.0
        ex, ey, ez = aside[i, 0], aside[i, 1], aside[i, 2]
        if not solid(walls, s, i):
            for k in range(rows.number[i]):
                j = entry(rows, i, k)
                dx, dy, dz, r, w = seen(cloud, s, box, i, j)
                per = w / r
                ox, oy, oz = ox + per * dx, oy + per * dy, oz + per * dz
                ex, ey, ez = ex + w * aside[j, 0], ey + w * aside[j, 1], ez + w * aside[j, 2]
        if beside[i] == 1:
            ox, oy, oz = level(NORMAL * cloud.number, ex, ey, ez, ox, oy, oz)
        w = s.w[i] if len(s.w) else 0.0
        factor = -strength * math.sqrt(s.u[i] * s.u[i] + s.v[i] * s.v[i] + w * w) / cloud.number
        way[i, 0], way[i, 1], way[i, 2] = factor * ox, factor * oy, factor * oz
