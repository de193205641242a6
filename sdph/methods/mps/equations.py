"""Loops over neighbours of the moving-particle method (swirl-sheet.md, section 2, whose numbers they bear).

Here r_ij = r_j - r_i and u_ij = u_j - u_i, as in the sources. Forces of pairs are equal and opposite. Everybody counts,
those that wait upstream of a nozzle too.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from numba import prange

from sdph.engine import arrays
from sdph.engine.geometry import apart, deep, faster
from sdph.engine.linear import Matrix
from sdph.engine.rows import entry, place
from sdph.laws import moving_particles
from sdph.laws.by_reference import by_reference
from sdph.laws.compiled import inlined, parallel
from sdph.methods.mps.tanks import grip, solid

# a particle sees the surface where n is below SPARSE n_0, or below THIN n_0 with neighbours ASIDE n_0 to one side (5),
# or where it has fewer than FEW neighbours for each dimension: two that touch have no n that tells; our choice
SPARSE, THIN, ASIDE, FEW = 0.85, 0.97, 0.2, 2
BURST = 1e-6  # of the diagonal, so that a piece without a surface has a pressure; swirl-sheet.md, 5


@by_reference
class Cloud(NamedTuple):
    """Spacing l0 and reach r_e [m], n_0 [-], lambda [m2], dimensions, density [kg/m3]."""

    spacing: float
    reach: float
    number: float
    spread: float
    dimensions: float
    density: float


@inlined
def seen(cloud, s, box, i, j):
    """r_ij (3 components) [m], its length, CLOSE l0 at least, and the weight w, 0 beyond r_e."""
    dx, dy, dz = apart(s, box, j, i)
    r = max(math.sqrt(dx * dx + dy * dy + dz * dz), moving_particles.CLOSE * cloud.spacing)
    return dx, dy, dz, r, moving_particles.weight(r / cloud.spacing, cloud.reach / cloud.spacing)


@parallel
def look(cloud, walls, s, rows, box, number, surface, speed, near):
    """number (N,): n; surface (N,): 1 where it sees the surface; speed (N,) [m/s]: the most by which a neighbour
    within r_e goes faster; near (N,): how many are within it."""
    for i in prange(len(s.x)):
        n = ox = oy = oz = fastest = 0.0
        many = 0
        for k in range(rows.number[i]):
            j = entry(rows, i, k)
            dx, dy, dz, r, w = seen(cloud, s, box, i, j)
            if w == 0.0:
                continue
            many += 1
            n += w
            per = w / r
            ox += per * dx
            oy += per * dy
            oz += per * dz
            du, dv, dw = faster(s, box, j, i)
            fastest = max(fastest, du * du + dv * dv + dw * dw)
        near[i] = many
        if solid(walls, s, i):
            number[i], surface[i], speed[i] = cloud.number, 0, 0.0
            continue
        aside = math.sqrt(ox * ox + oy * oy + oz * oz)
        open_side = n < THIN * cloud.number and aside > ASIDE * cloud.number
        few = many < FEW * cloud.dimensions
        number[i], speed[i] = n, math.sqrt(fastest)
        surface[i] = 1 if n < SPARSE * cloud.number or open_side or few else 0


@parallel
def gather(cloud, walls, s, rows, box, links, entries):
    """entries of links: of each row those within r_e, as `look` has counted them."""
    for i in prange(len(s.x)):
        n = 0
        for k in range(rows.number[i]):
            j = entry(rows, i, k)
            if seen(cloud, s, box, i, j)[4] > 0.0:
                entries[place(links, i, n)] = j
                n += 1


@parallel
def diverge(cloud, walls, s, rows, box, divergence):
    """divergence (N,) [1/s]: (d/n_0) sum u_ij.r_ij w/r^2 (4)."""
    for i in prange(len(s.x)):
        total = 0.0
        for k in range(rows.number[i]):
            j = entry(rows, i, k)
            dx, dy, dz, r, w = seen(cloud, s, box, i, j)
            if w == 0.0:
                continue
            du, dv, dw = faster(s, box, j, i)
            total += w / (r * r) * (du * dx + dv * dy + dw * dz)
        divergence[i] = cloud.dimensions / cloud.number * total


@parallel
def near_surface(cloud, walls, s, rows, box, surface, beside):
    """beside (N,): 1 where the particle or a neighbour of it within r_e sees the surface."""
    for i in prange(len(s.x)):
        found = surface[i]
        for k in range(rows.number[i]):
            j = entry(rows, i, k)
            if surface[j] == 1 and seen(cloud, s, box, i, j)[4] > 0.0:
                found = 1
        beside[i] = found


@parallel
def equations_of(cloud, walls, s, links, box, number, surface, diagonal, value):
    """Fill the matrix of (2 d/(lambda n_0)) sum (p_j - p_i) w times -lambda n_0/(2 d), along the links within r_e: a
    particle at the surface has n_0 on the diagonal, as if what it lacks were there with p = 0. Walls are on the
    right-hand side."""
    for i in prange(len(s.x)):
        own, wall = 0.0, solid(walls, s, i)
        for k in range(links.number[i]):
            e = place(links, i, k)
            j = links.entries[e]
            w = 0.0 if wall or solid(walls, s, j) else seen(cloud, s, box, i, j)[4]
            value[e] = w
            own += w
        missing = max(cloud.number - number[i], (1.0 - SPARSE) * cloud.number if len(walls) else 0.0)
        held = own + missing if surface[i] == 1 else max(own, BURST * cloud.number)
        diagonal[i] = held * (1.0 + BURST)


def matrix(cloud, walls, s, links, box, number, surface, room=None) -> Matrix:
    """The pressure's matrix (5), (7), of links within r_e, in work arrays of a `room`."""
    room = room or arrays.Room()
    diagonal, value = room("diagonal", len(s.x), s.x), room("value", len(links.entries), s.x)
    equations_of(cloud, walls, s, links, box, number, surface, diagonal, value)
    return Matrix(diagonal, links, value)


@parallel
def press(cloud, walls, s, rows, box, pressure, acceleration):
    """acceleration (N, 3) [m/s2]: -(1/rho) (d/n_0) sum (p_i + p_j) r_ij w/r^2 (6)."""
    factor = cloud.dimensions / (cloud.density * cloud.number)
    for i in prange(len(s.x)):
        ax = ay = az = 0.0
        for k in range(rows.number[i]):
            j = entry(rows, i, k)
            dx, dy, dz, r, w = seen(cloud, s, box, i, j)
            push = factor * (pressure[i] + pressure[j]) * w / (r * r)
            ax -= push * dx
            ay -= push * dy
            az -= push * dz
        acceleration[i, 0], acceleration[i, 1], acceleration[i, 2] = ax, ay, az


@parallel
def rub(cloud, walls, s, rows, box, viscosity, acceleration):
    """acceleration (N, 3) [m/s2]: nu (2 d/(lambda n_0)) sum u_ij w (3, 7), nu [m2/s]."""
    factor = viscosity * 2.0 * cloud.dimensions / (cloud.spread * cloud.number)
    for i in prange(len(s.x)):
        ax = ay = az = 0.0
        for k in range(rows.number[i]):
            j = entry(rows, i, k)
            w = seen(cloud, s, box, i, j)[4]
            if solid(walls, s, j):  # at rest
                w *= grip(walls)
                du, dv, dw = -s.u[i], -s.v[i], -s.w[i] if deep(box) else 0.0
            else:
                du, dv, dw = faster(s, box, j, i)
            ax += w * du
            ay += w * dv
            az += w * dw
        acceleration[i, 0], acceleration[i, 1], acceleration[i, 2] = factor * ax, factor * ay, factor * az


@parallel
def pull(cloud, tension_p, s, rows, box, acceleration, energy):
    """acceleration (N, 3) [m/s2] by tension, F/(rho l0^d) (8), and energy (N,) [J] of the pairs, half to each."""
    unit, reach = cloud.spacing, tension_p.reach / cloud.spacing
    mass = cloud.density * unit**cloud.dimensions
    for i in prange(len(s.x)):
        ax = ay = az = bound = 0.0
        for k in range(rows.number[i]):
            dx, dy, dz = apart(s, box, entry(rows, i, k), i)
            r = math.sqrt(dx * dx + dy * dy + dz * dz)
            if r >= tension_p.reach or r == 0.0:
                continue
            force = tension_p.coefficient * moving_particles.tension(r / unit, reach) / (mass * r)
            ax -= force * dx
            ay -= force * dy
            az -= force * dz
            bound += 0.5 * tension_p.coefficient * unit * moving_particles.cohesion(r / unit, reach)
        acceleration[i, 0], acceleration[i, 1], acceleration[i, 2], energy[i] = ax, ay, az, -bound


@parallel
def meet(walls, s, rows, box, distance, meeting):
    """meeting (N,): neighbours nearer than `distance` [m] that approach; the sum of it."""
    found = 0.0
    for i in prange(len(s.x)):
        n = 0
        for k in range(rows.number[i]):
            n += 1 if _approach(s, box, i, entry(rows, i, k), distance)[3] < 0.0 else 0
        meeting[i] = n
        found += n
    return found


@inlined
def _approach(s, box, i, j, distance):
    """e_ij and u_ij.e_ij [m/s] of a pair nearer than `distance` [m]; else 0."""
    dx, dy, dz = apart(s, box, j, i)
    r = math.sqrt(dx * dx + dy * dy + dz * dz)
    if r >= distance or r == 0.0:
        return 0.0, 0.0, 0.0, 0.0
    du, dv, dw = faster(s, box, j, i)
    return dx / r, dy / r, dz / r, (du * dx + dv * dy + dw * dz) / r


@parallel
def collide(walls, s, rows, box, distance, restitution, meeting, change):
    """change (N, 3) [m/s] of velocity: of a pair that approaches each loses (1 + e)/2 of it, shared by the larger
    number of contacts of the two (9)."""
    for i in prange(len(s.x)):
        ux = uy = uz = 0.0
        for k in range(rows.number[i]):
            j = entry(rows, i, k)
            ex, ey, ez, speed = _approach(s, box, i, j, distance)
            if speed < 0.0:
                part = (1.0 if solid(walls, s, j) else 0.5) * (1.0 + restitution) * speed / max(meeting[i], meeting[j])
                ux += part * ex
                uy += part * ey
                uz += part * ez
        change[i, 0], change[i, 1], change[i, 2] = ux, uy, uz
