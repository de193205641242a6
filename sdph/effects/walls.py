"""Walls for the grains: dummy particles (Adami, Hu & Adams 2012), contact, and the paper's penalty force.

Dummies stand in three layers behind the surface. They close the kernel in the density, push back with a pressure
extrapolated from the grains in front of them, and drag with a mirrored velocity (no slip), a share of it
(specularity, Johnson & Jackson 1987) or not at all. Pressure vanishes where grains are few, so a grain that comes
closer than `contact` to the surface is stopped there: its normal velocity is reversed with `restitution`.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from sdph.effects.effect import Effect, Judgement
from sdph.laws import kernels
from sdph.schema import choice, quantity, record, words

MODELS = ("dummy", "paper")
CONTACT = 0.25  # spacings between a particle and the surface at which they touch; our choice, half of the start's


@record
class Walls:
    model: str = choice(*MODELS)
    specularity: float = quantity("", 1.0, least=0.0, most=1.0)  # 1 no slip, 0 free slip
    restitution: float = quantity("", 0.0, least=0.0, most=1.0)  # of a contact; SPH particles are many grains: no bounce
    penalty: float = quantity("", 1.0, above=0.0)  # eps of the paper's force in grain densities times sqrt(g h)/h; not given there
    mesh: str = words("")  # surface mesh that meshio reads, in metres, normals towards the grains


class WallsP(NamedTuple):
    """Specularity, restitution, contact distance [m], volume of a dummy [m^d], penalty [1/s], 1 for the paper's force."""

    specularity: float
    restitution: float
    contact: float
    volume: float
    penalty: float
    paper: int


class Dummies(NamedTuple):
    """W dummies: place [m], unit normal (0 in corners, where two walls meet), depth behind the surface [m]."""

    x: np.ndarray
    y: np.ndarray
    z: np.ndarray
    normal_x: np.ndarray
    normal_y: np.ndarray
    normal_z: np.ndarray
    depth: np.ndarray


def kernel(case) -> WallsP:
    own, spacing = case.parameters["walls"], case.resolution.spacing
    gravity = float(np.linalg.norm(case.domain.gravity)) or 1.0
    penalty = own.penalty * np.sqrt(gravity / case.smoothing_length)
    paper = MODELS.index(own.model)
    return WallsP(own.specularity, own.restitution, CONTACT * spacing, spacing**case.dimensions, penalty, paper)


@njit(cache=True, error_model="numpy")
def closure(p, dummies, rows, s, i, kernel):
    """Share of the kernel of particle i that lies among grains: 1 - sum V W over dummies."""
    if len(p) == 0:
        return 1.0
    share = 1.0
    for k in range(rows.count[i]):
        share -= p.volume * kernels.cubic_spline(distance(dummies, rows.index[i, k], s, i), kernel.h, kernel.sigma)
    return share


@njit(cache=True, error_model="numpy")
def offset(dummies, w, s, i):
    """r_i - r_w, three components."""
    dz = s.z[i] - dummies.z[w] if len(s.z) else 0.0
    return s.x[i] - dummies.x[w], s.y[i] - dummies.y[w], dz


@njit(cache=True, error_model="numpy")
def distance(dummies, w, s, i):
    dx, dy, dz = offset(dummies, w, s, i)
    return np.sqrt(dx * dx + dy * dy + dz * dz)


@njit(cache=True, error_model="numpy")
def extrapolate(kernel, dummies, rows, s, pressure, body, weight, wall_pressure, wall_velocity):
    """Pressure and mean velocity of the grains at the dummies: Adami et al. 2012, Eq. 23 and 27.

    body (N, 3) [m/s2] is what acts on the grains from outside. A pressure below zero is taken as zero: grains do not
    stick to a wall.
    """
    weight[:], wall_pressure[:], wall_velocity[:] = 0.0, 0.0, 0.0
    for i in range(len(s.x)):
        for k in range(rows.count[i]):
            w = rows.index[i, k]
            dx, dy, dz = offset(dummies, w, s, i)
            value = kernels.cubic_spline(np.sqrt(dx * dx + dy * dy + dz * dz), kernel.h, kernel.sigma)
            weight[w] += value
            hydrostatic = -(body[i, 0] * dx + body[i, 1] * dy + body[i, 2] * dz) * s.density[i]
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
def force(p, kernel, dummies, rows, s, i, pressure, shear, wall_pressure, wall_velocity):
    """Acceleration [m/s2] of particle i by the wall."""
    ax, ay, az = 0.0, 0.0, 0.0
    if len(p) == 0:
        return ax, ay, az
    for k in range(rows.count[i]):
        w = rows.index[i, k]
        dx, dy, dz = offset(dummies, w, s, i)
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
            stick = 2.0 * p.specularity * p.volume / s.density[i] * shear[i] * gradient
            ax += push * dx + stick * (s.u[i] + wall_velocity[w, 0])
            ay += push * dy + stick * (s.v[i] + wall_velocity[w, 1])
            az += push * dz + stick * (vz + wall_velocity[w, 2])
    return ax, ay, az


@njit(cache=True, error_model="numpy")
def contact(p, dummies, rows, s):
    """Stops particles that came closer than `contact` to a surface; returns how many did.

    The place is put back to the contact distance, the normal velocity reversed with the restitution.
    """
    touched = 0
    for i in range(len(s.x)):
        before = touched
        for k in range(rows.count[i]):
            w = rows.index[i, k]
            dx, dy, dz = offset(dummies, w, s, i)
            nx, ny, nz = dummies.normal_x[w], dummies.normal_y[w], dummies.normal_z[w]
            inside = p.contact - (dx * nx + dy * ny + dz * nz - dummies.depth[w])
            if inside <= 0.0 or nx * nx + ny * ny + nz * nz == 0.0:
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
    reach = scales.travelled / max(scales.gap, 0.5 * scales.case.resolution.spacing) if scales.gap < math.inf else 0.0
    past = min(1.0, scales.travelled / scales.length)  # how much of them would be through the wall
    return Judgement("way of the grains / gap to a wall", reach, 1.0, "geometry", past if reach >= 1.0 else 0.0)


EFFECT = Effect(
    name="walls",
    summary="walls of the domain, or a surface mesh, for the grains",
    parameters=Walls,
    kernel=kernel,
    moves=True,
    call=call,
)
