"""Motion of particles beside their own velocity: XSPH, and shifting with how particles lie around each other."""

from __future__ import annotations

import math

from numba import prange

from sdph.effects.around import gravity
from sdph.effects.liquids import shifting, xsph
from sdph.engine import kernels as smoothing
from sdph.engine.geometry import apart, faster
from sdph.engine.gradients import NO_MATRIX, NO_SUMS, added, divided, in_plane, joined
from sdph.engine.rows import entry, length
from sdph.engine.state import GAS, WALL
from sdph.laws.compiled import fast_parallel, parallel, serial
from sdph.laws.matrices import smallest
from sdph.methods.liquids import phases
from sdph.methods.liquids.equations import pressure_at


@fast_parallel
def surround(kernel, s, rows, box, active, shifting_p, phases_p, volume, enclosure, shift, twist):
    """Survey how neighbours lie around each particle, and how fast they go.

    enclosure (N,), smallest eigenvalue of the renormalisation matrix, walls counted: a liquid has no surface there (1
    among two phases: they leave no free surface);
    shift (N, 3), sum V_j (1 + R (W/W0)^4) grad W [1/m]; twist (N, 9), corrected gradient dv_a/dx_b [1/s], a slowest.
    """
    for n in prange(len(active)):
        i = active[n]
        cx = cy = cz = 0.0
        matrix, walled, sums = NO_MATRIX, NO_MATRIX, NO_SUMS
        for k in range(length(rows, i)):
            j = entry(rows, i, k)
            dx, dy, dz = apart(s, box, i, j)
            du, dv, dw = faster(s, box, i, j)
            r = math.sqrt(dx * dx + dy * dy + dz * dz)
            slope = smoothing.slope(kernel, r)
            share = max(volume[j], 0.0) * slope * phases.like(phases_p, s.kind[i], s.kind[j])
            matrix, sums = added(matrix, sums, share, dx, dy, dz, du, dv, dw)
            if volume[j] < 0.0:
                walled, _ = added(walled, NO_SUMS, -volume[j] * slope, dx, dy, dz, 0.0, 0.0, 0.0)
            crowd = abs(volume[j]) * slope * shifting.weight(shifting_p, smoothing.value(kernel, r))
            cx += crowd * dx
            cy += crowd * dy
            cz += crowd * dz
        matrix = in_plane(matrix, len(s.z) == 0)
        enclosure[i] = 1.0 if len(phases_p) else smallest(*joined(matrix, walled))
        shift[i, 0], shift[i, 1], shift[i, 2] = cx, cy, cz
        found = divided(matrix, sums)
        twist[i, 0], twist[i, 1], twist[i, 2] = found[0], found[1], found[2]
        twist[i, 3], twist[i, 4], twist[i, 5] = found[3], found[4], found[5]
        twist[i, 6], twist[i, 7], twist[i, 8] = found[6], found[7], found[8]


@fast_parallel
def mingle(kernel, s, rows, box, active, xsph_p, phases_p, volume, extra_u, extra_v, extra_w):
    """extra (N,) x 3 [m/s]: mean velocity of the own phase around each particle over its own, weighted (XSPH)."""
    for n in prange(len(active)):
        i = active[n]
        u = v = w = 0.0
        for k in range(rows.number[i]):
            j = entry(rows, i, k)
            dx, dy, dz = apart(s, box, i, j)
            du, dv, dw = faster(s, box, i, j)
            value = smoothing.value(kernel, math.sqrt(dx * dx + dy * dy + dz * dz))
            near = xsph.share(xsph_p, s.mass[j], s.density[i], s.density[j], value) * phases.like(
                phases_p, s.kind[i], s.kind[j]
            )
            near = near if volume[j] > 0.0 else 0.0
            u -= near * du
            v -= near * dv
            w -= near * dw
        extra_u[i], extra_v[i] = u, v
        if len(extra_w):
            extra_w[i] = w


@fast_parallel
def along_surface(kernel, s, rows, box, active, volume, enclosure, shift):
    """Takes out of the shift (N, 3) of particles that see a surface what leads through it; spray is not shifted at all.

    The normal is the gradient of the smallest eigenvalue, `enclosure` (N,), among the liquid: Sun et al. 2017, CMAME
    315, 25, Eq. 10, 12. All within a kernel of a particle at the surface see it: what is missing there draws them too.
    """
    for n in prange(len(active)):
        i = active[n]
        if enclosure[i] > shifting.INTERIOR and not sees_surface(kernel, s, rows, box, i, volume, enclosure):
            continue
        nx = ny = nz = 0.0
        for k in range(rows.number[i]):
            j = entry(rows, i, k)
            if s.kind[j] == WALL:
                continue
            dx, dy, dz = apart(s, box, i, j)
            share = (
                max(volume[j], 0.0)
                * smoothing.slope(kernel, math.sqrt(dx * dx + dy * dy + dz * dz))
                * (enclosure[j] - enclosure[i])
            )
            nx += share * dx
            ny += share * dy
            nz += share * dz
        n2 = nx * nx + ny * ny + nz * nz
        through = (shift[i, 0] * nx + shift[i, 1] * ny + shift[i, 2] * nz) / n2 if n2 > 0.0 else 0.0
        kept = 1.0 if enclosure[i] > shifting.SPRAY else 0.0
        shift[i, 0] = kept * (shift[i, 0] - through * nx)
        shift[i, 1] = kept * (shift[i, 1] - through * ny)
        shift[i, 2] = kept * (shift[i, 2] - through * nz)


@serial
def sees_surface(kernel, s, rows, box, i, volume, enclosure):
    """True where a particle at the surface is within the kernel of particle i."""
    for k in range(rows.number[i]):
        j = entry(rows, i, k)
        if enclosure[j] <= shifting.INTERIOR and s.kind[j] != WALL and volume[j] > 0.0:
            dx, dy, dz = apart(s, box, i, j)
            if smoothing.value(kernel, math.sqrt(dx * dx + dy * dy + dz * dz)) > 0.0:
                return True
    return False


@parallel
def displace(p, fluids, s, active, shift, gradient, twist, compliance, fall, x, y, z, u, v, w, density):
    """r -= dt D sum V_j (1 + R (W/W0)^4) grad W, no faster than the parameters allow.

    Velocity and density are taken along their gradients, so that moving a particle does not move the field; compliance
    (K,) is d rho/dp [s2/m2] by kind, `fall` gravity and dt [s]. Returns the energy [J] of motion and compression that
    this takes, and that in gravity which it gives; x ... density are those of s once more, as outputs.
    """
    lost = lifted = 0.0
    gravity_p, dt = fall
    gx, gy, gz = gravity.acceleration(gravity_p)
    for n in prange(len(active)):
        i, kind = active[n], s.kind[active[n]]
        dx, dy, dz = -p.strength * shift[i, 0], -p.strength * shift[i, 1], -p.strength * shift[i, 2]
        speed = math.sqrt(dx * dx + dy * dy + dz * dz)
        scale = dt * min(1.0, p.largest / speed) if speed > 0.0 and (p.liquid > 0.0 or kind == GAS) else 0.0
        dx, dy, dz = scale * dx, scale * dy, scale * dz
        x[i] += dx
        y[i] += dy
        du = twist[i, 0] * dx + twist[i, 1] * dy + twist[i, 2] * dz
        dv = twist[i, 3] * dx + twist[i, 4] * dy + twist[i, 5] * dz
        denser = compliance[kind] * (gradient[i, 0] * dx + gradient[i, 1] * dy + gradient[i, 2] * dz)
        middle = density[i] + 0.5 * denser
        gained = (u[i] + 0.5 * du) * du + (v[i] + 0.5 * dv) * dv
        gained += pressure_at(fluids, kind, middle) / (middle * middle) * denser
        u[i] += du
        v[i] += dv
        density[i] += denser
        if len(z):
            z[i] += dz
            dw = twist[i, 6] * dx + twist[i, 7] * dy + twist[i, 8] * dz
            gained += (w[i] + 0.5 * dw) * dw
            w[i] += dw
        lost -= s.mass[i] * gained
        lifted -= s.mass[i] * (gx * dx + gy * dy + gz * dz)
    return lost, lifted


def prepare(stepper, around) -> None:
    """Find the velocity by which XSPH moves particles of a `stepper`, and the way by which they are shifted; `around`
    is what its loops take."""
    p, s = stepper.p, stepper.state
    if p["xsph"]:
        mingle(*around, p["xsph"], stepper.phases, stepper.volume, *stepper.extra)
    if p["shifting"]:
        own = stepper.volume, s.enclosure, stepper.shift
        surround(*around, p["shifting"], stepper.phases, *own, stepper.twist)
        stepper.domain.refresh(s.enclosure)
        if not stepper.phases:
            along_surface(*around, *own)
