"""Loops over the particles that wait upstream of an annular nozzle: they come along helices, and are let go."""

from __future__ import annotations

import math
from typing import NamedTuple

from numba import prange

from sdph.engine.state import INFLOW, LIQUID
from sdph.laws.compiled import in_order, inlined, parallel


class AnnulusP(NamedTuple):
    """Number of the nozzle from 1; centre (3) of its mouth [m]; its axis (3); speed [m/s] along it; swirl; pitch of the
    layers [m]; distance [m] from the axis past which nobody is in the mouth."""

    number: int
    x: float
    y: float
    z: float
    along_x: float
    along_y: float
    along_z: float
    speed: float
    swirl: float
    pitch: float
    reach: float


def of_source(source, k: int) -> AnnulusP:
    """The k-th nozzle of a sdph.effects.around.source.Source."""
    nozzle = source.nozzles[k]
    places = map(float, (*source.centre[k], *source.axis[k]))
    return AnnulusP(k + 1, *places, nozzle.speed, nozzle.swirl, float(source.pitch), float(source.reach[k]))


@inlined
def off(own, s, i):
    """Way along the axis from the mouth, and offset from the axis (3 components), of a particle [m]."""
    x, y, z = s.x[i] - own.x, s.y[i] - own.y, s.z[i] - own.z
    along = x * own.along_x + y * own.along_y + z * own.along_z
    return along, x - along * own.along_x, y - along * own.along_y, z - along * own.along_z


@inlined
def across(own, x, y, z):
    """Axis times a vector (3 components)."""
    return own.along_y * z - own.along_z * y, own.along_z * x - own.along_x * z, own.along_x * y - own.along_y * x


@parallel
def turn(own, s, way, dt, x, y, z, u, v, w):
    """Take those that wait `way` [m] along the axis in `dt` [s], on helices; velocities are what they went by. x to w
    are those of s once more, as outputs."""
    for i in prange(len(s.x)):
        if s.kind[i] != INFLOW or s.nozzle[i] != own.number:
            continue
        along, ox, oy, oz = off(own, s, i)
        angle = own.swirl * way / math.sqrt(ox * ox + oy * oy + oz * oz)
        c, d = math.cos(angle), math.sin(angle)
        ax, ay, az = across(own, ox, oy, oz)
        to_x = own.x + (c * ox + d * ax) + along * own.along_x + way * own.along_x
        to_y = own.y + (c * oy + d * ay) + along * own.along_y + way * own.along_y
        to_z = own.z + (c * oz + d * az) + along * own.along_z + way * own.along_z
        u[i], v[i], w[i] = (to_x - x[i]) / dt, (to_y - y[i]) / dt, (to_z - z[i]) / dt
        x[i], y[i], z[i] = to_x, to_y, to_z


@in_order
def let_go(own, s):
    """Make liquid of those that are through the mouth, with the velocity of the stream there; mass [kg], momentum (3)
    [kg m/s] and energy of motion [J] of these. Who is half a layer away from the mouth has entered."""
    mass = px = py = pz = motion = 0.0
    for i in prange(len(s.x)):
        if s.entering[i] == 0 or s.nozzle[i] != own.number:
            continue
        along, x, y, z = off(own, s, i)
        aside = math.sqrt(x * x + y * y + z * z)
        if s.kind[i] == INFLOW and along > 0.0:
            ax, ay, az = across(own, x, y, z)
            u = own.speed * (own.along_x + own.swirl * (ax / aside))
            v = own.speed * (own.along_y + own.swirl * (ay / aside))
            w = own.speed * (own.along_z + own.swirl * (az / aside))
            s.u[i], s.v[i], s.w[i], s.kind[i] = u, v, w, LIQUID
            mass += s.mass[i]
            px += s.mass[i] * u
            py += s.mass[i] * v
            pz += s.mass[i] * w
            motion += 0.5 * s.mass[i] * (u * u + v * v + w * w)
        if s.kind[i] == LIQUID and (abs(along) >= 0.5 * own.pitch or aside > own.reach):
            s.entering[i] = 0
    return mass, px, py, pz, motion
