"""Interface of two phases at a wall that it meets: the normal that its angle there asks for, and the liquid that stands
as if behind the wall.

The normal at a wall is that of Brackbill, Kothe & Zemach 1992, J. Comput. Phys. 100, 335, section V: t sin a + w cos a,
w the wall's normal into the fluid, t the way along the wall out of the liquid. It is the interface's where the line to
a wall particle cuts the wall's surface; the wall particle has what the particle in front and that lead to (as Morris,
Fox & Zhu 1997, J. Comput. Phys. 136, 214, do with velocities), so that the curvatures of the rows add up to how far the
interface turns. Breinlinger et al. 2013, J. Comput. Phys. 243, 14, blend the normal with what particles near walls find
themselves, which is wrong by as much as the wall cuts off. Here the interface goes on straight into the wall instead:
a plane with the wall's normal, which parts the particles in front of the wall as they are parted.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import prange

from sdph.engine import kernels as smoothing
from sdph.engine.geometry import apart
from sdph.engine.rows import entry
from sdph.engine.state import LIQUID
from sdph.laws.compiled import fast_parallel, inlined, serial
from sdph.laws.constants import TINY

ROUNDS = 30  # of the search for a plane, each halves what is left of 8 h: our choice
# most that a particle's difference from the wall's normal is multiplied by; a wall's first row takes twice that of the
# row in front. Our choice
FURTHEST = 4.0
LEAST = 0.5  # of sin a: an interface that runs more along the wall than that does not meet it. Our choice

UNMET, MET = 1, 2


class Line(NamedTuple):
    """By particle: unit normal of the wall in front (N, 3), into the fluid; distance from its surface (N,) [m]; of wall
    particles share of liquid (N,), and MET where the interface meets them, UNMET where it is in sight and does not
    (N,). `()` where walls take no part."""

    facing: np.ndarray
    height: np.ndarray
    share: np.ndarray
    meeting: np.ndarray


@fast_parallel
def face(kernel, s, rows, box, active, wetting_p, volume, facing, height):
    """facing (N, 3), height (N,): as in Line, of particles of the fluid; 0 where no wall is near."""
    for n in prange(len(active)):
        i = active[n]
        wx = wy = wz = nx = ny = nz = 0.0
        nearest = np.inf
        for k in range(rows.number[i]):
            j = entry(rows, i, k)
            dx, dy, dz = apart(s, box, i, j)
            r = math.sqrt(dx * dx + dy * dy + dz * dz)
            share = min(volume[j], 0.0) * smoothing.slope(kernel, r)
            wx += share * dx
            wy += share * dy
            wz += share * dz
            if volume[j] < 0.0 and r < nearest:
                nearest, nx, ny, nz = r, dx, dy, dz
        size = math.sqrt(wx * wx + wy * wy + wz * wz)
        inverse = 1.0 / size if size > 0.0 else 0.0
        facing[i, 0], facing[i, 1], facing[i, 2] = inverse * wx, inverse * wy, inverse * wz
        height[i] = max(inverse * (wx * nx + wy * ny + wz * nz) - 0.5 * wetting_p.spacing, 0.0)


@fast_parallel
def lean(kernel, s, rows, box, walls, wetting_p, normal, facing, share, meeting):
    """normal (N, 3) of wall particles where the interface meets them, out of the liquid, else 0; share (N,) of liquid
    that they stand for; meeting (N,) as in Line."""
    for n in prange(len(walls)):
        j = walls[n]
        wx = wy = wz = ox = oy = oz = total = liquid = 0.0
        for k in range(rows.number[j]):
            i = entry(rows, j, k)
            dx, dy, dz = apart(s, box, j, i)
            weight = smoothing.value(kernel, math.sqrt(dx * dx + dy * dy + dz * dz))
            wx, wy, wz = wx + weight * facing[i, 0], wy + weight * facing[i, 1], wz + weight * facing[i, 2]
            wet = 1.0 if s.kind[i] == LIQUID else 0.0
            outwards = weight * (2.0 * wet - 1.0)
            ox, oy, oz = ox + outwards * normal[i, 0], oy + outwards * normal[i, 1], oz + outwards * normal[i, 2]
            total += weight
            liquid += weight * wet
        inverse = 1.0 / (math.sqrt(wx * wx + wy * wy + wz * wz) + TINY)
        wx, wy, wz = inverse * wx, inverse * wy, inverse * wz
        through, size = ox * wx + oy * wy + oz * wz, math.sqrt(ox * ox + oy * oy + oz * oz)
        ox, oy, oz = ox - through * wx, oy - through * wy, oz - through * wz
        along = math.sqrt(ox * ox + oy * oy + oz * oz)
        meets = along > LEAST * wetting_p.sine * size and along > 0.0
        part = wetting_p.sine / along if meets else 0.0
        up = wetting_p.cosine if meets else 0.0
        ox, oy, oz = part * ox + up * wx, part * oy + up * wy, part * oz + up * wz
        normal[j, 0], normal[j, 1], normal[j, 2] = ox, oy, oz
        meeting[j] = MET if meets else UNMET if size > 0.0 else 0
        share[j] = liquid / total if total > 0.0 else 0.0
        if meets:
            share[j] = filled(parting(kernel, s, rows, box, j, ox, oy, oz, liquid, wetting_p.spacing))


@serial
def filled(way):
    """Share of a cell whose middle lies `way` cells inside of a plane, taken as parallel to it."""
    return min(max(0.5 + way, 0.0), 1.0)


@inlined
def parting(kernel, s, rows, box, j, nx, ny, nz, liquid, spacing):
    """Way [spacings] of wall particle j inside the plane of a normal (3 values) inside of which as much of what it
    sees lies, weighted by the kernel, as there is `liquid`; found by halving."""
    low, high = -4.0 * kernel.h / spacing, 4.0 * kernel.h / spacing
    for _ in range(ROUNDS):
        middle, inside = 0.5 * (low + high), 0.0
        for k in range(rows.number[j]):
            dx, dy, dz = apart(s, box, j, entry(rows, j, k))
            weight = smoothing.value(kernel, math.sqrt(dx * dx + dy * dy + dz * dz))
            inside += weight * filled(middle + (dx * nx + dy * ny + dz * nz) / spacing)
        low, high = (low, middle) if inside > liquid else (middle, high)
    return 0.5 * (low + high)


@inlined
def opposite(line, kind, signed, j):
    """Volume [m^d] of the other phase that wall particle j stands for before a particle of a kind; 0 of others."""
    liquid = line.share[j]
    return max(-signed, 0.0) * (1.0 - liquid if kind == LIQUID else liquid)


@inlined
def behind(line, i, dx, dy, dz):
    """Length of the way from particle i to one of a wall, r_ij [m], over that of its part in front of the wall's
    surface."""
    deep = line.facing[i, 0] * dx + line.facing[i, 1] * dy + line.facing[i, 2] * dz
    return deep / (line.height[i] + TINY)


@inlined
def beyond(line, i, dx, dy, dz):
    """The same within 1 and FURTHEST."""
    return min(max(behind(line, i, dx, dy, dz), 1.0), FURTHEST)
