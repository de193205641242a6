"""Contact of grains with walls where pressure does not hold them: they are stopped, and rubbed by Coulomb's law."""

from __future__ import annotations

import math

from numba import prange

from sdph.effects.around.walls import against
from sdph.engine.rows import entry
from sdph.engine.walls.dummies import offset
from sdph.laws.compiled import in_turn, inlined, inner

FLAT = 1e-6  # of a spacing: by less a wall does not bend, round-off; our choice


@inlined
def rubbed(p, wall, w, box, s, i, back):
    """Change of velocity (3 components) [m/s] along a wall by Coulomb's friction, in a contact that turns the normal
    one by `back`."""
    u, v, across = against(wall, w, box, s, i)
    along = u * wall.normal_x[w] + v * wall.normal_y[w] + across * wall.normal_z[w]
    u, v = u - along * wall.normal_x[w], v - along * wall.normal_y[w]
    across -= along * wall.normal_z[w]
    speed, most = math.sqrt(u * u + v * v + across * across), wall.stick[w] * p.rubs * back
    share = 1.0 if speed <= most else most / speed
    return -share * u, -share * v, -share * across


@inlined
def tell(felt, w, mass, px, py, pz, rx, ry, rz):
    """Take from felt[0] (W, 6) of dummy w what it gives a mass [kg] by its push and by its rub [m/s]; nothing where
    felt is empty."""
    if len(felt):
        felt[0][w, 0] -= mass * px
        felt[0][w, 1] -= mass * py
        felt[0][w, 2] -= mass * pz
        felt[0][w, 3] -= mass * rx
        felt[0][w, 4] -= mass * ry
        felt[0][w, 5] -= mass * rz


@inlined
def beside(wall, box, s, i):
    """The dummy, of those that contact asks, whose place of the surface is nearest to particle i."""
    found, least = -1, math.inf
    for k in range(wall.before[i], wall.every[i]):
        w = entry(wall, i, k)
        dx, dy, dz = over_surface(wall, box, s, i, w)
        square = dx * dx + dy * dy + dz * dz
        if square < least and wall.normal_x[w] ** 2 + wall.normal_y[w] ** 2 + wall.normal_z[w] ** 2 > 0.0:
            found, least = w, square
    return found


@inlined
def over_surface(wall, box, s, i, w):
    """Way (3 components) [m] to particle i from the place of the surface that dummy w stands behind."""
    dx, dy, dz = offset(box, wall, w, s, i)
    depth = wall.depth[w]
    return dx - depth * wall.normal_x[w], dy - depth * wall.normal_y[w], dz - depth * wall.normal_z[w]


@inlined
def passed(p, wall, box, s, i, w, nearest):
    """True where the place of the surface that is `nearest` to particle i lies behind the plane of dummy w, and that of
    w behind the plane there: the wall bends away between the two, round a tube or an edge, and the plane goes on
    through the grains. Where two walls cross, as a block's side and the floor below it, one lies before the other."""
    dx, dy, dz = over_surface(wall, box, s, i, w)
    ex, ey, ez = over_surface(wall, box, s, i, nearest)
    dx, dy, dz = dx - ex, dy - ey, dz - ez  # from the place of w to the nearest
    over = dx * wall.normal_x[w] + dy * wall.normal_y[w] + dz * wall.normal_z[w]
    back = dx * wall.normal_x[nearest] + dy * wall.normal_y[nearest] + dz * wall.normal_z[nearest]
    return over < -FLAT * p.spacing and back > FLAT * p.spacing


@in_turn
def stop(p, wall, box, s, gravity, impulse, work, back_put, felt):
    """Stops particles that came closer than `contact` to a surface; returns how many did.

    Adds to impulse (3,) [kg m/s] and work (1,) [J] of the walls on the grains, and to back_put (2,) the ways that
    places were put back [m] and the energy that they got by it [J].
    """
    ix, iy, iz, worked, way, lift, touched = contact(p, wall, box, s, gravity, felt)
    impulse[0] += ix
    impulse[1] += iy
    impulse[2] += iz
    work[0] += worked
    back_put[0] += way
    back_put[1] += lift
    return touched


@inner
def contact(p, wall, box, s, gravity, felt):
    """Contact of each particle with the dummies that it sees; what `stop` adds up, and how many were stopped.

    The place is put back to the contact distance, the normal velocity reversed with the restitution, and that along the
    wall taken away, by `rubs` times as much at most. Those that come through a nozzle pass; what bends away before the
    particle does not count (`passed`). gravity (3,) [m/s2]; where felt is not empty, felt[0] (W, 6) [kg m/s] gets what
    pushes and what rubs each dummy.
    """
    ix = iy = iz = work = way = lift = touched = 0.0
    for i in prange(len(s.x)):
        before, nearest, sought = touched, -1, True
        if len(s.entering) > 0 and s.entering[i] > 0:
            continue
        for k in range(wall.before[i], wall.every[i]):
            w = entry(wall, i, k)
            dx, dy, dz = offset(box, wall, w, s, i)
            nx, ny, nz = wall.normal_x[w], wall.normal_y[w], wall.normal_z[w]
            height = dx * nx + dy * ny + dz * nz
            aside = dx * dx + dy * dy + dz * dz - height * height
            inside = p.contact - (height - wall.depth[w])
            if inside <= 0.0 or aside > p.spacing * p.spacing or nx * nx + ny * ny + nz * nz == 0.0:
                continue
            if sought:
                nearest, sought = beside(wall, box, s, i), False
            if passed(p, wall, box, s, i, w, nearest):
                continue
            s.x[i] += inside * nx
            s.y[i] += inside * ny
            way += inside
            lift -= s.mass[i] * inside * (gravity[0] * nx + gravity[1] * ny + gravity[2] * nz)
            normal = s.u[i] * nx + s.v[i] * ny
            if len(s.z):
                s.z[i] += inside * nz
                normal += s.w[i] * nz
            back = -(1.0 + p.restitution) * min(normal, 0.0)
            rx, ry, rz = rubbed(p, wall, w, box, s, i, back)
            bx, by, bz = back * nx + rx, back * ny + ry, back * nz + rz
            ix, iy, iz = ix + s.mass[i] * bx, iy + s.mass[i] * by, iz + s.mass[i] * bz
            tell(felt, w, s.mass[i], back * nx, back * ny, back * nz, rx, ry, rz)
            across = s.w[i] if len(s.z) else 0.0
            after = bx * (s.u[i] + 0.5 * bx) + by * (s.v[i] + 0.5 * by) + bz * (across + 0.5 * bz)
            work += s.mass[i] * after
            s.u[i] += bx
            s.v[i] += by
            if len(s.z):
                s.w[i] += bz
            touched = before + 1.0
    return ix, iy, iz, work, way, lift, touched
