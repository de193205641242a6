"""Loops over neighbours of pools: pressure by differences inside, walls, particles kept apart.

Away from the surface the gradient is the corrected one, exact of linear fields on any arrangement; within r_e of a
surface particle it is that of pairs, as of sheets (swirl-sheet.md, section 2, 4).
"""

from __future__ import annotations

from numba import prange

from sdph.engine.geometry import faster
from sdph.engine.rows import entry
from sdph.laws.compiled import inlined, parallel
from sdph.laws.matrices import SINGULAR, solved
from sdph.methods.mps.equations import seen
from sdph.methods.mps.tanks import across, least, rise, solid


@inlined
def determinant(m):
    """Determinant of a symmetric matrix (xx, yy, zz, xy, yz, zx)."""
    a, b, c = m[1] * m[2] - m[4] * m[4], m[5] * m[4] - m[3] * m[2], m[3] * m[4] - m[5] * m[1]
    return m[0] * a + m[3] * b + m[5] * c


@parallel
def diverge(cloud, walls, s, rows, box, beside, divergence):
    """divergence (N,) [1/s] of the liquid as if it went on behind walls as it does in front: `equations.diverge`
    without walls; beside them, away from the surface, by differences that are exact of linear fields."""
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
        if walled and beside[i] == 0:
            m = share * xx, share * yy, share * zz if cloud.dimensions > 2.0 else 1.0
            m = m[0], m[1], m[2], share * xy, share * yz, share * zx
            if determinant(m) > SINGULAR:
                found = solved(*m, ux, uy, uz)[0] + solved(*m, vx, vy, vz)[1] + solved(*m, wx, wy, wz)[2]
                divergence[i] = share * found


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


@parallel
def press(cloud, walls, s, rows, box, pressure, beside, scale, acceleration, borne):
    """acceleration (N, 3) [m/s2] by the pressure, and borne (N, 3): what of it walls would give by pairs, which is
    their load; scale: rho/dt. Returns the numbers of pairs of liquid and wall, and of those whose wall may not pull and
    would.

    The gradient is the one that fits best to the differences along pairs, and to the rise across walls. By pairs the
    pressure of a wall changes along it as that gradient says. Under tension pairs would draw together: it is taken from
    differences at the surface too.
    """
    share, light = cloud.dimensions / cloud.number, -1.0 / cloud.density
    walled = held = 0.0
    for i in prange(len(s.x)):
        p_i = pressure[i]
        ax = ay = az = bx = by = bz = gx = gy = gz = xx = yy = zz = xy = yz = zx = 0.0
        txx = tyy = tzz = txy = tyz = tzx = 0.0
        for k in range(rows.number[i]):
            j = entry(rows, i, k)
            dx, dy, dz, r, w = seen(cloud, s, box, i, j)
            if w == 0.0:
                continue
            per, p_j, nx, ny, nz = share * w / (r * r), pressure[j], dx, dy, dz
            if solid(walls, s, j):
                nx, ny, nz = across(walls, s, j, dx, dy, dz)
                p_free = p_i + rise(s, scale, i, nx, ny, nz)
                p_j = least(walls, p_free)
                walled, held = walled + 1.0, held + (1.0 if p_j > p_free else 0.0)
                both = per * (p_i + p_j)
                bx, by, bz = bx + both * dx, by + both * dy, bz + both * dz
                tx, ty, tz = dx - nx, dy - ny, dz - nz
                txx, tyy, tzz = txx + per * tx * tx, tyy + per * ty * ty, tzz + per * tz * tz
                txy, tyz, tzx = txy + per * tx * ty, tyz + per * ty * tz, tzx + per * tz * tx
            both, more = per * (p_i + p_j), per * (p_j - p_i)
            ax, ay, az = ax + both * dx, ay + both * dy, az + both * dz
            gx, gy, gz = gx + more * nx, gy + more * ny, gz + more * nz
            xx, yy, zz = xx + per * nx * nx, yy + per * ny * ny, zz + per * nz * nz
            xy, yz, zx = xy + per * nx * ny, yz + per * ny * nz, zx + per * nz * nx
        m = xx, yy, zz if cloud.dimensions > 2.0 else 1.0, xy, yz, zx
        gx, gy, gz = solved(*m, gx, gy, gz)
        if (beside[i] == 0 or p_i < 0.0) and determinant(m) > SINGULAR:
            ax, ay, az = gx, gy, gz
        else:
            ax += txx * gx + txy * gy + tzx * gz
            ay += txy * gx + tyy * gy + tyz * gz
            az += tzx * gx + tyz * gy + tzz * gz
        acceleration[i, 0], acceleration[i, 1], acceleration[i, 2] = light * ax, light * ay, light * az
        borne[i, 0], borne[i, 1], borne[i, 2] = light * bx, light * by, light * bz
    return walled, held


@parallel
def keep_apart(cloud, walls, s, rows, box, beside, strength, way):
    """way (N, 3) [m] towards where neighbours are few: -strength sum (w/n_0) r_ij/r, strength [m]; 0 beside the
    surface and of walls."""
    for i in prange(len(s.x)):
        ox = oy = oz = 0.0
        if beside[i] == 0 and not solid(walls, s, i):
            for k in range(rows.number[i]):
                dx, dy, dz, r, w = seen(cloud, s, box, i, entry(rows, i, k))
                per = w / r
                ox, oy, oz = ox + per * dx, oy + per * dy, oz + per * dz
        factor = -strength / cloud.number
        way[i, 0], way[i, 1], way[i, 2] = factor * ox, factor * oy, factor * oz
