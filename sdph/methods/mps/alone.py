"""Loops over particles one by one: the right-hand side of the pressure's equations, sums, the fastest.

Sums are made of parts of fixed size, so that they do not hang on the number of threads.
"""

from __future__ import annotations

import math

import numpy as np
from numba import prange

from sdph.engine import arrays
from sdph.engine.state import INFLOW, LIQUID
from sdph.laws.compiled import in_order, parallel, parallel_largest

PART = 32  # particles of a part of a sum; our choice


def summed(world, loop, columns: int, count: int, *arguments):
    """Sums (columns,), in memory, of what a loop puts into parts (P, columns) of `count` particles, over all processes
    of a world."""
    part = arrays.empty(((count + PART - 1) // PART, columns), arguments[0].x)
    loop(*arguments, part)
    return world.total(part)


def of_kind(s, kind: int):
    """Rows (n,) of the particles of a kind."""
    mask = arrays.empty(len(s.kind), s.kind, np.bool_)
    tell(s.kind, kind, mask)
    return arrays.chosen(mask)


@parallel
def tell(kind, own, mask):
    """mask (N,): particles of the kind `own`."""
    for i in prange(len(kind)):
        mask[i] = kind[i] == own


@parallel
def fall(x, y, z, acceleration):
    """acceleration (N, 3) [m/s2]: the same of all."""
    for i in prange(len(acceleration)):
        acceleration[i, 0], acceleration[i, 1], acceleration[i, 2] = x, y, z


@parallel
def source_of(cloud, s, number, beside, surface, dt, share, holds, source, freed):
    """Make source (N,), div u, the right-hand side of the pressure's equations, -lambda n_0/(2 d) times rho/dt (div u -
    gamma (n - n_0)/n_0/dt), whose surplus counts beside the surface alone where it is one. Who waits has none; freed
    (N,): where a surface that nothing `holds` is drawn apart, which is let go."""
    factor = -cloud.spread * cloud.number / (2.0 * cloud.dimensions)
    for i in prange(len(s.x)):
        surplus = (number[i] - cloud.number) / cloud.number
        if beside[i] == 1:
            surplus = max(surplus, 0.0)
        change = cloud.density / dt * (source[i] - share * surplus / dt)
        if s.kind[i] == INFLOW:
            change = 0.0
        freed[i] = surface[i] == 1 and change > 0.0 and not holds
        source[i] = 0.0 if freed[i] else factor * change


@in_order
def leave_out(pressure):
    """Sum [Pa] of the pressures (N,) below 0, with its sign turned; they are 0 then."""
    found = 0.0
    for i in prange(len(pressure)):
        if pressure[i] < 0.0:
            found -= pressure[i]
            pressure[i] = 0.0
    return found


@parallel
def add_kick(s, active, acceleration, dt, part):
    """part (P, 4): work [J] of the kick to come of the active, and its impulse [kg m/s]."""
    for k in prange(len(part)):
        work = x = y = z = 0.0
        for n in range(k * PART, min((k + 1) * PART, len(active))):
            i = active[n]
            m, dx, dy, dz = s.mass[i], dt * acceleration[i, 0], dt * acceleration[i, 1], dt * acceleration[i, 2]
            w = s.w[i] if len(s.w) else 0.0
            work += m * (dx * (s.u[i] + 0.5 * dx) + dy * (s.v[i] + 0.5 * dy) + dz * (w + 0.5 * dz))
            x += m * dx
            y += m * dy
            z += m * dz
        part[k, 0], part[k, 1], part[k, 2], part[k, 3] = work, x, y, z


def energy_in_gravity(stepper, active) -> float:
    """Energy [J] of the active in gravity, -m g.x, of all processes; 0 without gravity."""
    own, s = stepper.p["gravity"], stepper.state
    return float(summed(stepper.world, add_height, 1, len(active), s, active, *own)[0]) if own else 0.0


@parallel
def add_height(s, active, gx, gy, gz, part):
    """part (P, 1): energy [J] of the active in gravity (gx, gy, gz) [m/s2]."""
    for k in prange(len(part)):
        found = 0.0
        for n in range(k * PART, min((k + 1) * PART, len(active))):
            i = active[n]
            found -= s.mass[i] * (s.x[i] * gx + s.y[i] * gy + (s.z[i] * gz if len(s.z) else 0.0))
        part[k, 0] = found


def drawn(stepper, active, dt) -> float:
    """Work [J] of tension on the active over the ways that they are to drift in `dt` [s], of all processes; 0 without
    tension."""
    if not stepper.p["free_energy_tension"]:
        return 0.0
    s = stepper.state
    return dt * float(summed(stepper.world, add_power, 1, len(active), s, active, stepper.pulled)[0])


@parallel
def add_power(s, active, acceleration, part):
    """part (P, 1): power [W] of an acceleration (N, 3) [m/s2] of the active, at their velocities."""
    for k in prange(len(part)):
        found = 0.0
        for n in range(k * PART, min((k + 1) * PART, len(active))):
            i = active[n]
            along = acceleration[i, 0] * s.u[i] + acceleration[i, 1] * s.v[i]
            found += s.mass[i] * (along + (acceleration[i, 2] * s.w[i] if len(s.w) else 0.0))
        part[k, 0] = found


@parallel
def add_load(s, borne, part):
    """part (P, 3): force [N] of the pressure on walls, of what they give the liquid, borne (N, 3) [m/s2]."""
    for k in prange(len(part)):
        x = y = z = 0.0
        for i in range(k * PART, min((k + 1) * PART, len(borne))):
            if s.kind[i] == LIQUID:
                x -= s.mass[i] * borne[i, 0]
                y -= s.mass[i] * borne[i, 1]
                z -= s.mass[i] * borne[i, 2]
        part[k, 0], part[k, 1], part[k, 2] = x, y, z


@parallel
def add_all(s, energy, part):
    """part (P, 7): particles of liquid, their mass [kg], momentum [kg m/s], energy of motion and of cohesion
    [J]."""
    for k in prange(len(part)):
        many = mass = x = y = z = motion = bound = 0.0
        for i in range(k * PART, min((k + 1) * PART, len(s.x))):
            if s.kind[i] == LIQUID:
                m, u, v, w = s.mass[i], s.u[i], s.v[i], s.w[i] if len(s.w) else 0.0
                many += 1.0
                mass += m
                x += m * u
                y += m * v
                z += m * w
                motion += 0.5 * m * (u * u + v * v + w * w)
                bound += energy[i]
        part[k, 0], part[k, 1], part[k, 2], part[k, 3] = many, mass, x, y
        part[k, 4], part[k, 5], part[k, 6] = z, motion, bound


@parallel
def shares(s, freed):
    """Numbers of particles of liquid, of those without pressure, and of those in freed (N,)."""
    many = bare = free = 0.0
    for i in prange(len(s.x)):
        if s.kind[i] == LIQUID:
            many += 1.0
            bare += 1.0 if s.pressure[i] == 0.0 else 0.0
    for i in prange(len(freed)):
        free += 1.0 if freed[i] else 0.0
    return many, bare, free


@parallel
def runaways(s, most):
    """Number of particles that are not slower than `most` [m/s]; who has no speed is one."""
    found = 0.0
    for i in prange(len(s.x)):
        w = s.w[i] if len(s.w) else 0.0
        found += 0.0 if math.sqrt(s.u[i] ** 2 + s.v[i] ** 2 + w * w) <= most else 1.0
    return found


@parallel_largest
def fastest(s):
    """Largest v^2 [m2/s2] of all."""
    found = 0.0
    for i in prange(len(s.x)):
        w = s.w[i] if len(s.w) else 0.0
        found = max(found, s.u[i] ** 2 + s.v[i] ** 2 + w * w)
    return found


@parallel_largest
def longest(way):
    """Largest squared length of ways (N, 3)."""
    found = 0.0
    for i in prange(len(way)):
        found = max(found, way[i, 0] ** 2 + way[i, 1] ** 2 + way[i, 2] ** 2)
    return found
