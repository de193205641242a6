"""Walls for the grains: dummy particles (Adami, Hu & Adams 2012), contact, and the paper's penalty force.

Dummies stand in three layers behind the surface. They close the kernel in the density, push back with a pressure
extrapolated from the grains in front of them, and drag with a mirrored velocity (no slip), with as much of it as
leaves the stress of Johnson & Jackson 1987 at the wall, or not at all (`specularity` 0, or a side of the domain that is
a slip_wall). A wall may slide along itself. What its grip takes from the motion of grains feeds their agitation.
Pressure vanishes where grains are few, so a grain that comes closer than `contact` to the surface is stopped there: its
normal velocity is reversed with `restitution`. A wall that grips rubs it then by Coulomb's law, with sin(phi) of the
effect `friction`, the ratio of shear stress to pressure at which Schaeffer's grains slide along a plane, or with its
own `friction`, by which its specularity goes too (sdph.effects.around.wall_grip).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import prange

from sdph.effects.around.wall_grip import coulomb, grip, held, slip, specularity
from sdph.effects.around.wall_limiters import held as held_by_limiters
from sdph.effects.effect import Effect, Judgement
from sdph.engine.geometry import deep
from sdph.engine.ledger import Column
from sdph.engine.rows import entry
from sdph.engine.walls.dummies import BESIDE, CONTACT, distance, normal_part, offset
from sdph.laws import kernels
from sdph.laws.compiled import inlined, parallel, serial
from sdph.schema import choice, file, quantity, record, vector

MODELS = ("dummy", "paper")


@record
class Walls:
    model: str = choice(*MODELS)
    # share of collisions that are diffuse; None: by `friction`, or no slip without it
    specularity: float | None = quantity("", None, least=0.0, most=1.0)
    friction: float | None = quantity("", None, least=0.0, most=1.0)  # of a grain on the wall; None: it is rough
    # of a contact; SPH particles are many grains: no bounce
    restitution: float = quantity("", 0.0, least=0.0, most=1.0)
    # eps of the paper's force in grain densities times sqrt(g h)/h; not given there
    penalty: float = quantity("", 1.0, above=0.0, most=1e6)
    # "gas": the sides of a generated mesh, or the patches of the OpenFOAM mesh that the case brings; "mesh": the sides
    # of the domain and `mesh`. None: "mesh" where one is given, else "gas"
    source: str | None = choice("gas", "mesh", default=None)
    mesh: str = file()  # surface mesh that meshio reads, normals towards the grains
    mesh_scale: float = quantity("", 1.0, above=0.0)  # metres of a unit of `mesh`: 0.001 where it is in millimetres
    mesh_offset: tuple | None = vector("m", None)  # by which it is moved, after that


class WallsP(NamedTuple):
    """Specularity (-1: no slip), what it changes by as grains slide, and restitution of a grain on the wall;
    restitution, contact distance and spacing [m] of a particle, penalty [1/s], 1 for the paper's force, packing limit,
    grain density [kg/m3], Coulomb's coefficient of a contact and the share of the traction of contacts that a wall that
    grips takes [-]."""

    specularity: float
    sliding: float
    bounce: float
    restitution: float
    contact: float
    spacing: float
    penalty: float
    paper: int
    packing: float
    grain_density: float
    rubs: float
    bears: float


def kernel(case) -> WallsP:
    own, spacing = case.parameters["walls"], case.resolution.spacing
    gravity = float(np.linalg.norm(case.domain.gravity)) or 1.0
    penalty = own.penalty * math.sqrt(gravity / case.smoothing_length)
    return WallsP(
        *specularity(own, case.grains.restitution), case.grains.restitution, own.restitution, CONTACT * spacing,
        spacing, penalty, MODELS.index(own.model), case.grains.packing_limit, case.grains.density,
        *coulomb(case, own),
    )  # fmt: skip


@serial
def listed(p, wall, i):
    """True where a wall may reach into the kernel of particle i, which moves between new rows. Few have one; to call
    what follows for the others too would cost as much as the pairs."""
    if len(p) == 0:
        return False
    return wall.number[i] > 0


@serial
def near(p, kernel, box, wall, s, i):
    """True where particle i is beside a wall."""
    if len(p) == 0:
        return False
    for k in range(wall.number[i]):
        if distance(box, wall, entry(wall, i, k), s, i) < BESIDE * kernels.SUPPORT * kernel.h:
            return True
    return False


@serial
def closure(p, box, wall, s, i, kernel):
    """Share of the kernel of particle i that lies among grains: 1 - sum V W over wall."""
    if len(p) == 0:
        return 1.0
    share = 1.0
    for k in range(wall.number[i]):
        w = entry(wall, i, k)
        r = distance(box, wall, w, s, i)
        share -= wall.volume[w] * kernels.cubic_spline(r, kernel.h, kernel.sigma)
    return share


@inlined
def against(wall, w, box, s, i):
    """Velocity of particle i less that of the wall (3 components) [m/s]."""
    across = s.w[i] if deep(box) else 0.0
    return s.u[i] - wall.slide_x[w], s.v[i] - wall.slide_y[w], across - wall.slide_z[w]


@serial
def gradient(p, kernel, box, wall, s, i):
    """Share of walls in the velocity gradient (xx, xy, xz, yx, yy, yz, zx, zy, zz) [1/s] of particle i: mirrored
    velocities behind them. The adjoint of the traction of contacts in `force`, so that elastic contacts neither gain
    nor lose."""
    xx = xy = xz = yx = yy = yz = zx = zy = zz = 0.0
    if len(p) == 0 or p.paper == 1:  # a penalty bears no traction
        return xx, xy, xz, yx, yy, yz, zx, zy, zz
    for k in range(wall.number[i]):
        w = entry(wall, i, k)
        dx, dy, dz = offset(box, wall, w, s, i)
        r = math.sqrt(dx * dx + dy * dy + dz * dz)
        g = -2.0 * wall.volume[w] * kernels.cubic_spline_gradient(r, kernel.h, kernel.sigma)
        du, dv, dw = held(p, wall, w, *against(wall, w, box, s, i))
        dx, dy, dz = normal_part(wall, w, dx, dy, dz)
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


@parallel
def extrapolate(kernel, box, wall, facing, s, pressure, wall_pressure, unheld, wall_velocity):
    """Pressure and mean velocity of the grains at the dummies: Adami et al. 2012, Eq. 23 and 27.

    `facing` are the rows of the dummies; those without grains near have 0. The weight between a grain and the wall adds
    to what the grain is pressed by, and no more than that: a grain without pressure feels none from a wall, and contact
    stops it (a heap of four rows has at its foot what the third layer of dummies adds). A pressure below zero is taken
    as zero: grains do not stick to a wall; `unheld` (W,) [Pa] is the pressure before both, nan without grains near.
    """
    for w in prange(len(wall.x)):
        weight = push = full = u = v = up = 0.0
        for k in range(facing.number[w]):
            i = entry(facing, w, k)
            dx, dy, dz = offset(box, wall, w, s, i)
            value = kernels.cubic_spline(math.sqrt(dx * dx + dy * dy + dz * dz), kernel.h, kernel.sigma)
            weight += value
            hydrostatic = (
                -(s.push_x[i] * dx + s.push_y[i] * dy + (s.push_z[i] * dz if deep(box) else 0.0)) * s.density[i]
            )
            push += value * (pressure[i] + min(hydrostatic, pressure[i]))
            full += value * (pressure[i] + hydrostatic)
            u += value * s.u[i]
            v += value * s.v[i]
            up += value * s.w[i] if deep(box) else 0.0
        found = weight > 0.0
        unheld[w] = full / weight if found else np.nan
        wall_pressure[w] = max(push / weight, 0.0) if found else 0.0
        wall_velocity[w, 0] = u / weight if found else 0.0
        wall_velocity[w, 1] = v / weight if found else 0.0
        wall_velocity[w, 2] = up / weight if found else 0.0


@inlined
def solid(p, kernel, s, i):
    """rho_p [kg/m3] of particle i: of one material a plain kernel tells, of its own a mixed one."""
    if len(kernel) == 2:
        return p.grain_density
    return s.grain_density[i]


@inlined
def penalty(p, kernel, box, wall, w, s, i, r):
    """Acceleration [m/s2] along the normal of a dummy: -eps 2h (v.n) W A / (rho r) where v.n < 0; A = dx^(d-1), eps =
    penalty rho."""
    vz = s.w[i] if deep(box) else 0.0
    approach = s.u[i] * wall.normal_x[w] + s.v[i] * wall.normal_y[w] + vz * wall.normal_z[w]
    push = -p.penalty * 2.0 * kernel.h * min(approach, 0.0) / r * wall.volume[w]
    return push * kernels.cubic_spline(r, kernel.h, kernel.sigma)


@inlined
def pair(p, kernel, box, wall, w, s, i, rho, theta, stress, friction_p):
    """Accelerations [m/s2] of particle i, of rho_p [kg/m3] and theta, by dummy w: by its push and by its grip, three
    components each; power of viscosity there on the motion [W/kg]."""
    fx = fy = fz = power = 0.0
    dx, dy, dz = offset(box, wall, w, s, i)
    r = math.sqrt(dx * dx + dy * dy + dz * dz)
    if p.paper == 1:
        push = penalty(p, kernel, box, wall, w, s, i, r)
        px, py, pz = push * wall.normal_x[w], push * wall.normal_y[w], push * wall.normal_z[w]
    else:
        gradient = kernels.cubic_spline_gradient(r, kernel.h, kernel.sigma)
        push = -wall.volume[w] / s.density[i] * (stress.pressure[i] + wall.pressure[w]) * gradient
        # mirrored velocity 2 v_wall - <v>: v_i + <v> - 2 v_wall; Morris' form of the viscous force
        nx, ny, nz = wall.normal_x[w], wall.normal_y[w], wall.normal_z[w]
        away = dx * nx + dy * ny + dz * nz
        du, dv, dw = against(wall, w, box, s, i)
        speed = slip(nx, ny, nz, du, dv, dw)
        gripped = 2.0 * grip(p, wall.stick[w], away - wall.depth[w], s.density[i], rho, theta, stress.shear[i], speed)
        stick = gripped * wall.volume[w] / s.density[i] * stress.shear[i] * gradient
        fx = stick * (du + wall.velocity[w, 0] - wall.slide_x[w])
        fy = stick * (dv + wall.velocity[w, 1] - wall.slide_y[w])
        fz = stick * (dw + wall.velocity[w, 2] - wall.slide_z[w])
        power = fx * du + fy * dv + fz * dw
        # pressure acts along the normal: a row of dummies is no row of teeth, a corner pushes nobody (`normal_part`)
        px, py, pz = push * away * nx, push * away * ny, push * away * nz
        if len(friction_p):
            rub = 2.0 * wall.volume[w] * s.density[i] * gradient
            rx, ry, rz = rubbing(p, wall, w, stress.traction, i, dx, dy, dz)
            fx, fy, fz = fx + rub * rx, fy + rub * ry, fz + rub * rz
    return px, py, pz, fx, fy, fz, power


@inlined
def force(p, kernel, box, wall, s, i, stress, friction_p):
    """Accelerations [m/s2] of particle i by the wall: by its push, and by its grip; power of the grip by the sliding of
    the wall, and what viscosity takes there from the motion of the grains [W/kg].

    `stress` holds pressure, shear viscosity and, where there is friction, the traction (N, 6) of contacts
    (sdph.methods.grains.equations.Scratch), which bears on a wall as it does on grains; what it takes from the motion
    is counted there.
    """
    ax = ay = az = tx = ty = tz = slid = lost = 0.0
    if len(p) == 0:
        return ax, ay, az, tx, ty, tz, slid, lost
    theta = s.theta[i] if len(s.theta) else np.nan
    rho = solid(p, kernel, s, i)
    for k in range(wall.number[i]):
        w = entry(wall, i, k)
        px, py, pz, fx, fy, fz, power = pair(p, kernel, box, wall, w, s, i, rho, theta, stress, friction_p)
        ax += px
        ay += py
        az += pz
        tx += fx
        ty += fy
        tz += fz
        slid += fx * wall.slide_x[w] + fy * wall.slide_y[w] + fz * wall.slide_z[w]
        lost -= power
    return ax, ay, az, tx, ty, tz, slid, lost


@inlined
def rubbing(p, wall, w, tau, i, dx, dy, dz):
    """tau_i.r of contacts, r taken along the normal; of a smooth wall its normal part."""
    dx, dy, dz = normal_part(wall, w, dx, dy, dz)
    fx = tau[i, 0] * dx + tau[i, 3] * dy + tau[i, 5] * dz
    fy = tau[i, 3] * dx + tau[i, 1] * dy + tau[i, 4] * dz
    fz = tau[i, 5] * dx + tau[i, 4] * dy + tau[i, 2] * dz
    return held(p, wall, w, fx, fy, fz)


def call(scales) -> Judgement:
    """Judge by how far grains get within the run over their way to the nearest wall."""
    way, over_gap = scales.to_walls
    past = min(1.0, way / scales.length)  # how much of them would be through the wall
    return Judgement("way of the grains / gap to a wall", over_gap, 1.0, "geometry", past if over_gap >= 1.0 else 0.0)


EFFECT = Effect(
    name="walls",
    summary="walls of the domain, or a surface mesh, for the grains",
    parameters=Walls,
    kernel=kernel,
    moves=True,
    held=held_by_limiters,
    columns=(Column("contact_way_m"), Column("contact_lift_J")),
    sums=("contact_way_m", "contact_lift_J"),
    call=call,
)
