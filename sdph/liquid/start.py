"""Particles of a liquid and of its walls at the start of a case."""

from __future__ import annotations

import math

import numpy as np

from sdph import particles
from sdph.effects import tank
from sdph.laws import eos
from sdph.laws.liquids import square_patch_pressure, taylor_green
from sdph.liquid import LIQUID, shapes
from sdph.particles import WALL
from sdph.schema import CaseError

CLEARANCE = 0.5  # spacings between the first particles and the surface of a round tank


def fill(case) -> particles.State:
    """All liquid and wall particles of a case, numbered from 0, liquid first."""
    parts = [_pool(case, pool) for pool in case.pools.values()]
    if not parts:
        raise CaseError("no liquid: give it in a section such as [pools.column]")
    if "tank" in case.effects:
        parts.append(_walls(case))
    state = parts[0]
    for part in parts[1:]:
        state = particles.join(state, part)
    state.ident[:] = np.arange(len(state.ident))
    return state


def _walls(case) -> particles.State:
    points = shapes.wall_points(tank.shape_of(case), case.resolution.spacing, tank.layers(case))
    state = _placed(case, points)
    state.kind[:] = WALL
    state.density[:] = case.liquid.density
    state.mass[:] = case.liquid.density * case.resolution.spacing**case.dimensions
    return state


def _placed(case, points) -> particles.State:
    state = particles.empty(len(points), (), case.dimensions)
    for axis, column in zip(particles.axes(state), points.T):
        axis[:] = column
    return state


def _pool(case, pool) -> particles.State:
    d, spacing = case.dimensions, case.resolution.spacing
    points = _in_tank(case, pool) if pool.shape == "tank" else particles.lattice(pool, spacing, d)
    volume = spacing**d
    if pool.shape == "box":  # the lattice is fitted to the box
        volume = math.prod(b - a for a, b in zip(pool.lower, pool.upper)) / len(points)
    state = _placed(case, points)
    state.kind[:] = LIQUID
    pressure = _pressure(case, pool, points) + case.liquid.background_pressure
    liquid = case.liquid
    state.density[:] = eos.tait_density(pressure, liquid.density, liquid.sound_speed, liquid.exponent, liquid.background_pressure)
    state.mass[:] = liquid.density * volume
    for array, value in zip((state.u, state.v, state.w), _velocity(pool, points, d).T):
        array[:] = value
    return state


def _in_tank(case, pool) -> np.ndarray:
    """The lowest lattice points of the tank that hold `fill` of its volume, and all of its outlet pipe."""
    if "tank" not in case.effects or pool.fill is None:
        raise CaseError("pools: shape = \"tank\" needs the effect tank, and fill")
    shape, spacing = tank.shape_of(case), case.resolution.spacing
    own = shape.tank if isinstance(shape, shapes.Joined) else shape
    corners = own.shell(0.5 * spacing, spacing)
    lower, upper = corners.min(axis=0) + 0.5 * spacing, corners.max(axis=0) - 0.5 * spacing
    points = shapes.lattice_inside(own, spacing, lower, upper, CLEARANCE * spacing)
    count = round(pool.fill * own.volume / spacing**case.dimensions)
    if count > len(points):
        raise CaseError(f"pools: fill = {pool.fill:g} asks for {count} particles, the tank holds {len(points)} at this spacing; fill it less")
    points = points[:count]
    if own is shape:
        return points
    pipe = shape.pipe
    low, high = pipe.centre - pipe.radius, pipe.centre + pipe.radius
    low[2], high[2] = pipe.centre[2] - 0.5 * pipe.length, pipe.centre[2] + 0.5 * pipe.length
    buffer = shapes.lattice_inside(pipe, spacing, low, high, CLEARANCE * spacing * 0.999)
    free = np.array([((points - p) ** 2).sum(axis=1).min() > (0.9 * spacing) ** 2 for p in buffer], bool)
    return np.concatenate((buffer[free & (own.distance(buffer) > -CLEARANCE * spacing)], points))


def _pressure(case, pool, points) -> np.ndarray:
    """At the start: hydrostatic below the pool's top under gravity, of a rotating patch or vortices what is known exactly."""
    if pool.flow == "rotation":
        side = pool.upper[0] - pool.lower[0]
        omega = 2.0 * pool.speed / side
        return square_patch_pressure(points - np.array(pool.lower), side, omega, case.liquid.density)
    if pool.flow == "taylor_green":
        return taylor_green(points, pool.upper[0] - pool.lower[0], pool.speed, case.liquid.density)[1]
    if "gravity" not in case.effects:
        return np.zeros(len(points))
    walled = 1.0 - np.array(case.liquid.periodic or [0.0] * case.dimensions)  # along a periodic axis gravity drives a flow
    along = np.array(case.domain.gravity) * walled
    height = points @ along  # rises downwards
    size = float(np.linalg.norm(along))
    return case.liquid.density * (height - height.min() + 0.5 * case.resolution.spacing * size)


def _velocity(pool, points, dimensions: int) -> np.ndarray:
    velocity = np.zeros((len(points), dimensions))
    if pool.velocity is not None:
        velocity += np.array(pool.velocity)
    if pool.flow == "rotation":
        middle = 0.5 * (np.array(pool.lower) + np.array(pool.upper))
        omega = 2.0 * pool.speed / (pool.upper[0] - pool.lower[0])
        velocity[:, 0] += omega * (points - middle)[:, 1]
        velocity[:, 1] -= omega * (points - middle)[:, 0]
    if pool.flow == "taylor_green":
        velocity += taylor_green(points, pool.upper[0] - pool.lower[0], pool.speed, 1.0)[0]
    return velocity
