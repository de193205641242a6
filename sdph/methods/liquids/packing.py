"""Particles moved until they lie evenly between walls of any form, as under one pressure everywhere.

dv/dt = -2 sum V_j grad W is what one pressure rho c^2 everywhere does to them where c = 1: it vanishes where the
kernel's sums are even (Colagrossi, Bouscasse, Antuono & Marrone 2012, Comput. Phys. Commun. 183, 1641). When they begin
to go against it they are stopped (kinetic damping, Cundall 1976), which needs no coefficient. They have the kernel and
the Courant number of the run, go on until sound has crossed them, and keep off the particles of walls as far as those
hold liquid off in the run (`held_off` in sdph.methods.liquids.forces).
"""

from __future__ import annotations

import math

import numpy as np
from numba import prange

from sdph.effects.around import tank
from sdph.engine import kernels as smoothing
from sdph.engine import motion
from sdph.engine import state as particles
from sdph.engine.geometry import apart
from sdph.engine.neighbours import Neighbours
from sdph.engine.rows import entry, length
from sdph.engine.state import LIQUID, WALL
from sdph.engine.walls import layers
from sdph.laws.compiled import fast_parallel, parallel
from sdph.laws.constants import TINY

RETURNS = 8  # rounds at most after which none is put back into its tank any more; our choice: one does as a rule
PROBE = 1e-3  # of a spacing, between the distances that a way back is the slope of; our choice


def pack(case, points, walls, lid, slab, shape) -> np.ndarray:
    """(N, d) where `points` (N, d) come to lie within a slab of a tank's `shape`, among walls (as of
    sdph.engine.walls.layers) and a lid of more of the same, which stand still. Those that got out of it, through walls
    that meet at a sharp edge, are put back and go on."""
    kernel = smoothing.smoothing(case.liquid.kernel, case.dimensions, case.smoothing_length)
    neighbours = Neighbours(2.0 * kernel.h, case.liquid_period, case.resolution.neighbour_skin)
    state, dt, near = (
        _state(case, shape, points, walls, lid),
        case.liquid.courant * kernel.h,
        1.0 / tank.kernel(case).near,
    )
    rounds = math.ceil(np.ptp(points, axis=0).max() / dt)
    for number in range(rounds + RETURNS):
        if number >= rounds:
            own = np.flatnonzero(state.kind == LIQUID)
            way = _back(shape, _places(state)[own], case.resolution.spacing)
            if not way.any():
                break
            _move(state, own, way)
        state, rows = neighbours.update(state)
        active = np.flatnonzero(state.kind == LIQUID).astype(np.int32)
        acceleration, way = np.zeros((2, len(state.x), 3))
        spread(kernel, state, rows, neighbours.box, active, acceleration)
        _go(state, active, acceleration, dt)
        _move(state, active, slab.back(_places(state)[active]))
        clear(state, rows, neighbours.box, active, near, way)
        _move(state, active, way[active])
    places = _places(state)[np.argsort(state.ident)[: len(points)]]
    return places + _back(shape, places, case.resolution.spacing)


@fast_parallel
def spread(kernel, s, rows, box, active, acceleration):
    """acceleration (N, 3) [1/m] = -2 sum V grad W, away from where particles and walls are dense; V is their mass."""
    for n in prange(len(active)):
        i = active[n]
        ax = ay = az = 0.0
        for k in range(length(rows, i)):
            j = entry(rows, i, k)
            dx, dy, dz = apart(s, box, i, j)
            slope = s.mass[j] * smoothing.slope(kernel, math.sqrt(dx * dx + dy * dy + dz * dz))
            ax -= slope * dx
            ay -= slope * dy
            az -= slope * dz
        acceleration[i, 0] = 2.0 * ax
        acceleration[i, 1] = 2.0 * ay
        acceleration[i, 2] = 2.0 * az


@parallel
def clear(s, rows, box, active, near, way):
    """way (N, 3) [m] of particles to where they are `near` [m] away from the wall particles that are nearer."""
    for n in prange(len(active)):
        i = active[n]
        px = py = pz = 0.0
        for k in range(rows.number[i]):
            j = entry(rows, i, k)
            if s.kind[j] == WALL:
                dx, dy, dz = apart(s, box, i, j)
                r = math.sqrt(dx * dx + dy * dy + dz * dz)
                share = max(near / (r + TINY) - 1.0, 0.0)
                px += share * dx
                py += share * dy
                pz += share * dz
        way[i, 0], way[i, 1], way[i, 2] = px, py, pz


def _back(shape, places, spacing: float) -> np.ndarray:
    """(N, d) [m] from places (N, d) out of a shape to half a spacing within it, 0 of those inside."""
    way, distance = np.zeros_like(places), shape.distance(places)
    out = np.flatnonzero(distance > 0.0)
    if len(out):
        steps = PROBE * spacing * np.eye(places.shape[1])
        slope = np.stack([shape.distance(places[out] + e) - shape.distance(places[out] - e) for e in steps], axis=1)
        slope /= np.linalg.norm(slope, axis=1, keepdims=True)
        way[out] = -(distance[out] + 0.5 * spacing)[:, None] * slope
    return way


def _state(case, shape, points, walls, lid) -> particles.State:
    """All of them, of density 1."""
    volume = layers.volumes(shape, walls, case.resolution.spacing)
    state = particles.empty(len(points) + len(volume) + len(lid), (), points.shape[1])
    for axis, column in zip(particles.axes(state), np.concatenate([points, *walls, lid]).T):
        axis[:] = column
    state.kind[: len(points)], state.kind[len(points) :] = LIQUID, WALL
    state.mass[:] = case.resolution.spacing**case.dimensions
    state.mass[len(points) : len(points) + len(volume)] = volume
    state.ident[:] = np.arange(len(state.x))
    return state


def _places(state) -> np.ndarray:
    """(N, d) positions."""
    return np.stack(particles.axes(state), axis=1)


def _go(state, active, acceleration, dt: float) -> None:
    """A kick and a drift; from rest, if they went against the acceleration."""
    if np.vdot(particles.velocities(state), acceleration) < 0.0:
        for axis in (state.u, state.v, state.w):
            axis[:] = 0.0
    motion.kick(active, acceleration, dt, state.u, state.v, state.w)
    motion.drift(active, state.u, state.v, state.w, dt, state.x, state.y, state.z)


def _move(state, rows, way) -> None:
    """Adds way (R, d or 3) [m] to the places of some particles."""
    for axis, part in zip(particles.axes(state), way.T):
        axis[rows] += part
