"""Walls for the grains: dummy particles (Adami, Hu & Adams 2012), contact, and the paper's penalty force.

Dummies stand in three layers behind the surface. They close the kernel in the density, push back with a pressure
extrapolated from the grains in front of them, and drag with a mirrored velocity (no slip), with as much of it as
leaves the stress of Johnson & Jackson 1987 at the wall, or not at all (`specularity` 0, or a side of the domain that is
a slip_wall). Pressure vanishes where grains are few, so a grain that comes closer than `contact` to the surface is
stopped there: its normal velocity is reversed with `restitution`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from sdph.effects.effect import Effect, Judgement
from sdph.engine.rows import entry
from sdph.engine.walls.dummies import distance, normal_part, offset
from sdph.laws import granular, kernels
from sdph.schema import choice, file, quantity, record

MODELS = ("dummy", "paper")
NO_SLIP = -1.0
CONTACT = 0.25  # spacings between a particle and the surface at which they touch; our choice, half of the start's


@record
class Walls:
    model: str = choice(*MODELS)
    # share of collisions that are diffuse; None: no slip
    specularity: float | None = quantity("", None, least=0.0, most=1.0)
    # of a contact; SPH particles are many grains: no bounce
    restitution: float = quantity("", 0.0, least=0.0, most=1.0)
    # eps of the paper's force in grain densities times sqrt(g h)/h; not given there
    penalty: float = quantity("", 1.0, above=0.0, most=1e6)
    mesh: str = file()  # surface mesh that meshio reads, in metres, normals towards the grains


class WallsP(NamedTuple):
    """Specularity (-1: no slip), restitution, contact distance and spacing [m], volume of a dummy [m^d], penalty [1/s],
    1 for the paper's force, packing limit, grain density [kg/m3]."""

    specularity: float
    restitution: float
    contact: float
    spacing: float
    volume: float
    penalty: float
    paper: int
    packing: float
    grain_density: float


def kernel(case) -> WallsP:
    own, spacing = case.parameters["walls"], case.resolution.spacing
    gravity = float(np.linalg.norm(case.domain.gravity)) or 1.0
    penalty = own.penalty * np.sqrt(gravity / case.smoothing_length)
    specularity = NO_SLIP if own.specularity is None else own.specularity
    return WallsP(
        specularity, own.restitution, CONTACT * spacing, spacing, spacing**case.dimensions, penalty,
        MODELS.index(own.model), case.grains.packing_limit, case.grains.density,
    )  # fmt: skip


@njit(cache=True, error_model="numpy")
def near(p, rows, i):
    """Whether particle i sees dummies. Few do; to call what follows for the others too would cost as much as the
    pairs."""
    if len(p) == 0:
        return False
    return rows.number[i] > 0


@njit(cache=True, error_model="numpy")
def closure(p, box, dummies, rows, s, i, kernel):
    """Share of the kernel of particle i that lies among grains: 1 - sum V W over dummies."""
    if len(p) == 0:
        return 1.0
    share = 1.0
    for k in range(rows.number[i]):
        share -= p.volume * kernels.cubic_spline(
            distance(box, dummies, entry(rows, i, k), s, i), kernel.h, kernel.sigma
        )
    return share


@njit(cache=True, error_model="numpy")
def held(p, dummies, w, x, y, z):
    """What of a vector (velocity or traction of contacts) a wall takes hold of: all of it where it grips, else the
    normal part."""
    nx, ny, nz = normal_part(dummies, w, x, y, z)
    grips = dummies.stick[w] if p.specularity != 0.0 else 0.0
    return nx + grips * (x - nx), ny + grips * (y - ny), nz + grips * (z - nz)


@njit(cache=True, error_model="numpy")
def gradient(p, kernel, box, dummies, rows, s, i):
    """What walls add to the velocity gradient (xx, xy, xz, yx, yy, yz, zx, zy, zz) [1/s] of particle i: mirrored
    velocities behind them. The adjoint of the traction of contacts in `force`, so that elastic contacts neither gain
    nor lose."""
    xx = xy = xz = yx = yy = yz = zx = zy = zz = 0.0
    if len(p) == 0:
        return xx, xy, xz, yx, yy, yz, zx, zy, zz
    for k in range(rows.number[i]):
        w = entry(rows, i, k)
        dx, dy, dz = offset(box, dummies, w, s, i)
        r = np.sqrt(dx * dx + dy * dy + dz * dz)
        g = -2.0 * p.volume * kernels.cubic_spline_gradient(r, kernel.h, kernel.sigma)
        du, dv, dw = held(p, dummies, w, s.u[i], s.v[i], s.w[i] if len(s.z) else 0.0)
        dx, dy, dz = normal_part(dummies, w, dx, dy, dz)
        xx += g * du * dx
        xy += g * du * dy
        xz += g * du * dz
        yx += g * dv * dx
        yy += g * dv * dy
        yz += g * dv * dz
        zx += g * dw * dx
        zy += g * dw * dy
        zz += g * dw * dz
    return xx, xy, xz, yx, yy, yz, zx, zy, zz


@njit(cache=True, error_model="numpy")
def extrapolate(kernel, box, dummies, rows, s, pressure, weight, wall_pressure, wall_velocity):
    """Pressure and mean velocity of the grains at the dummies: Adami et al. 2012, Eq. 23 and 27.

    A pressure below zero is taken as zero: grains do not
    stick to a wall.
    """
    weight[:], wall_pressure[:], wall_velocity[:] = 0.0, 0.0, 0.0
    for i in range(len(s.x)):
        for k in range(rows.number[i]):
            w = entry(rows, i, k)
            dx, dy, dz = offset(box, dummies, w, s, i)
            value = kernels.cubic_spline(np.sqrt(dx * dx + dy * dy + dz * dz), kernel.h, kernel.sigma)
            weight[w] += value
            hydrostatic = (
                -(s.push_x[i] * dx + s.push_y[i] * dy + (s.push_z[i] * dz if len(s.z) else 0.0)) * s.density[i]
            )
            wall_pressure[w] += value * (pressure[i] + hydrostatic)
            wall_velocity[w, 0] += value * s.u[i]
            wall_velocity[w, 1] += value * s.v[i]
            if len(s.z):
                wall_velocity[w, 2] += value * s.w[i]
    for w in range(len(weight)):
        if weight[w] > 0.0:
            wall_pressure[w] = max(wall_pressure[w] / weight[w], 0.0)
            wall_velocity[w] /= weight[w]


@njit(cache=True, error_model="numpy")
def grip(p, dummies, w, s, i, dx, dy, dz, shear):
    """Share of the no-slip stress: y/(y + b) at the distance y from the wall, with the slip length b = mu/k of

    tau = k v, k = phi pi rho_p alpha_p g0 sqrt(3 theta)/(6 alpha_max). Johnson & Jackson 1987, J. Fluid Mech. 176, 67.
    """
    if p.specularity < 0.0 or dummies.stick[w] == 0.0 or len(s.theta) == 0:
        return dummies.stick[w] * (p.specularity != 0.0)
    y = max(
        dx * dummies.normal_x[w] + dy * dummies.normal_y[w] + dz * dummies.normal_z[w] - dummies.depth[w], p.contact
    )
    a = granular.capped_fraction(s.density[i] / p.grain_density, p.packing)
    g0 = granular.sinclair_jackson(a, p.packing)
    k = p.specularity * np.pi * p.grain_density * a * g0 * np.sqrt(3.0 * s.theta[i]) / (6.0 * p.packing)
    return k * y / (k * y + shear) if k > 0.0 else 0.0


@njit(cache=True, error_model="numpy", forceinline=True)  # to hand over the whole state costs more than this
def force(p, kernel, box, dummies, rows, s, i, pressure, shear, tau, wall_pressure, wall_velocity):
    """Acceleration [m/s2] of particle i by the wall; contacts, with their traction tau (N, 6) of
    sdph.methods.grains.contacts, bear on it as they do on grains."""
    ax, ay, az = 0.0, 0.0, 0.0
    if len(p) == 0:
        return ax, ay, az
    for k in range(rows.number[i]):
        w = entry(rows, i, k)
        dx, dy, dz = offset(box, dummies, w, s, i)
        r = np.sqrt(dx * dx + dy * dy + dz * dz)
        vz = s.w[i] if len(s.z) else 0.0
        if p.paper == 1:  # f/rho = -eps 2h sum (v.n) W A n / r, where v.n < 0; A = dx^(d-1), eps = penalty rho
            approach = s.u[i] * dummies.normal_x[w] + s.v[i] * dummies.normal_y[w] + vz * dummies.normal_z[w]
            push = -p.penalty * 2.0 * kernel.h * min(approach, 0.0) / r * p.volume
            push *= kernels.cubic_spline(r, kernel.h, kernel.sigma)
            ax += push * dummies.normal_x[w]
            ay += push * dummies.normal_y[w]
            az += push * dummies.normal_z[w]
        else:
            gradient = kernels.cubic_spline_gradient(r, kernel.h, kernel.sigma)
            push = -p.volume / s.density[i] * (pressure[i] + wall_pressure[w]) * gradient
            # mirrored velocity 2 v_wall - <v>: against a wall at rest v_i + <v>; Morris' form of the viscous force
            stick = (
                2.0 * grip(p, dummies, w, s, i, dx, dy, dz, shear[i]) * p.volume / s.density[i] * shear[i] * gradient
            )
            nx, ny, nz = dummies.normal_x[w], dummies.normal_y[w], dummies.normal_z[w]
            # pressure acts along the normal: a row of dummies is no row of teeth
            along = push * (dx * nx + dy * ny + dz * nz)
            corner = push * (1.0 - (nx * nx + ny * ny + nz * nz))
            ax += along * nx + corner * dx + stick * (s.u[i] + wall_velocity[w, 0])
            ay += along * ny + corner * dy + stick * (s.v[i] + wall_velocity[w, 1])
            az += along * nz + corner * dz + stick * (vz + wall_velocity[w, 2])
            if len(tau):
                rub = 2.0 * p.volume * s.density[i] * gradient
                fx, fy, fz = rubbing(p, dummies, w, tau, i, dx, dy, dz)
                ax += rub * fx
                ay += rub * fy
                az += rub * fz
    return ax, ay, az


@njit(cache=True, error_model="numpy")
def rubbing(p, dummies, w, tau, i, dx, dy, dz):
    """tau_i.r of contacts, r taken along the normal; of a smooth wall its normal part."""
    dx, dy, dz = normal_part(dummies, w, dx, dy, dz)
    fx = tau[i, 0] * dx + tau[i, 3] * dy + tau[i, 5] * dz
    fy = tau[i, 3] * dx + tau[i, 1] * dy + tau[i, 4] * dz
    fz = tau[i, 5] * dx + tau[i, 4] * dy + tau[i, 2] * dz
    return held(p, dummies, w, fx, fy, fz)


@njit(cache=True, error_model="numpy")
def contact(p, box, dummies, rows, s):
    """Stops particles that came closer than `contact` to a surface; returns how many did.

    The place is put back to the contact distance, the normal velocity reversed with the restitution. Those that come
    through a nozzle pass.
    """
    touched = 0
    for i in range(len(s.x)):
        before = touched
        if len(s.entering) > 0 and s.entering[i] > 0:
            continue
        for k in range(rows.number[i]):
            w = entry(rows, i, k)
            dx, dy, dz = offset(box, dummies, w, s, i)
            nx, ny, nz = dummies.normal_x[w], dummies.normal_y[w], dummies.normal_z[w]
            height = dx * nx + dy * ny + dz * nz
            aside = dx * dx + dy * dy + dz * dz - height * height
            inside = p.contact - (height - dummies.depth[w])
            if inside <= 0.0 or aside > p.spacing * p.spacing or nx * nx + ny * ny + nz * nz == 0.0:
                continue
            s.x[i] += inside * nx
            s.y[i] += inside * ny
            normal = s.u[i] * nx + s.v[i] * ny
            if len(s.z):
                s.z[i] += inside * nz
                normal += s.w[i] * nz
            back = -(1.0 + p.restitution) * min(normal, 0.0)
            s.u[i] += back * nx
            s.v[i] += back * ny
            if len(s.z):
                s.w[i] += back * nz
            touched = before + 1
    return touched


def call(scales) -> Judgement:
    """How far grains get within the run over their way to the nearest wall."""
    way, over_gap = scales.to_walls
    past = min(1.0, way / scales.length)  # how much of them would be through the wall
    return Judgement("way of the grains / gap to a wall", over_gap, 1.0, "geometry", past if over_gap >= 1.0 else 0.0)


EFFECT = Effect(
    name="walls",
    summary="walls of the domain, or a surface mesh, for the grains",
    parameters=Walls,
    kernel=kernel,
    moves=True,
    call=call,
)
