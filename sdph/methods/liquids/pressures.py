"""Pressure of pools at the start: what lies on what, and hydrostatics below it."""

from __future__ import annotations

import math

import numpy as np

from sdph.engine import regions
from sdph.laws.liquids import square_patch_pressure, taylor_green
from sdph.methods.liquids import filling
from sdph.schema import CaseError


def at_start(case, pools: list, number: int, points, world) -> np.ndarray:
    """Pressure at the start: hydrostatic below the pool's top under gravity, of a rotating patch or vortices what is
    known exactly."""
    pool = pools[number]
    if pool.flow == "rotation":
        side = pool.upper[0] - pool.lower[0]
        omega = 2.0 * pool.speed / side
        return square_patch_pressure(points - np.array(pool.lower), side, omega, case.liquid.density)
    if pool.flow == "taylor_green":
        return taylor_green(points, pool.upper[0] - pool.lower[0], pool.speed, case.liquid.density)[1]
    return _hydrostatic(case, pools, number, points, world) + _laplace(case, pool)


def _hydrostatic(case, pools: list, number: int, points, world) -> np.ndarray:
    """rho g depth below the pool's top, where it has the pressure of the pool that lies on it, 0 at a free surface; a
    disc or sphere has in its middle what the pool around it has there."""
    pool, along, spacing = pools[number], filling.pull(case), case.resolution.spacing
    height = points @ along  # rises downwards [m2/s2]
    if pool.shape == "tank":
        top = _top(pool, along)
    else:
        top = world.least(float(height.min(initial=math.inf))) - 0.5 * spacing * float(np.linalg.norm(along))
    if not along.any():
        return phase_of(case, pool).density * (height - top)
    if pool.shape in ("disc", "sphere") and len(_on(pools, number, np.array(pool.centre)[None])):
        top = float(np.array(pool.centre) @ along)
    return phase_of(case, pool).density * (height - top) + _outside(case, pools, number, top, along, points)


def _outside(case, pools: list, number: int, top: float, along, points) -> np.ndarray:
    """Pressure (N,) [Pa] at the height `top` [m2/s2] of what lies on a pool over each of its points (N, d) [m], or
    around the centre of one that is round: hydrostatic too, up to a free surface."""
    found = np.zeros(len(points))
    for other, held in _on(pools, number, _above(case, pools[number], top, along, points)):
        own = _top(pools[other], along, list(case.pools)[other])
        upon = _outside(case, pools, other, own, along, points[held])
        found[held] = phase_of(case, pools[other]).density * (top - own) + upon
    return found


def _on(pools: list, number: int, places) -> list[tuple[int, np.ndarray]]:
    """Numbers of the pools that hold places (N, d) [m] over a pool, each with the mask of the places that it is the
    first to hold: those after it, and those before it that are boxes or fill a tank; round ones before it lie in it."""
    pool, left, found = pools[number], np.ones(len(places), bool), []
    for other, own in enumerate(pools):
        if other == number or (other < number and own.shape not in ("box", "tank")):
            continue
        if pool.shape == "tank" and own.shape == "tank":
            held = left & (own.slab.low <= pool.slab.high < own.slab.high)
        else:
            held = left & holds(own, places)
        if held.any():
            found.append((other, held))
            left &= ~held
    return found


def _above(case, pool, top: float, along, points) -> np.ndarray:
    """Places (N, d) [m] half a spacing over the height `top` [m2/s2], above points (N, d) [m] of a pool; the centre of
    what is round, for each."""
    if pool.shape in ("disc", "sphere", "ring"):
        return np.tile(np.array(pool.centre), (len(points), 1))
    gravity = float(np.linalg.norm(along))
    way = (points @ along - top) / gravity + 0.5 * case.resolution.spacing
    return points - way[:, None] * along / gravity


def _top(pool, along, name: str = "") -> float:
    """g.r [m2/s2] at the highest corner of a box, or at the level up to which a tank is filled; `name` is that of a
    pool that lies on another one, which has to be one of them."""
    if pool.shape == "tank":
        return -pool.slab.high * float(np.linalg.norm(along))
    if pool.shape != "box":
        raise CaseError(
            f"pools.{name} lies on or around another pool, which needs a box or a tank, and is a {pool.shape}: pools "
            f"fill in the order of the case; put [pools.{name}] before the others, or add a pool around it"
        )
    return float(np.minimum(np.array(pool.lower) * along, np.array(pool.upper) * along).sum())


def _laplace(case, pool) -> float:
    """Pressure of surface tension in a disc, sigma/R, or in a sphere, 2 sigma/R [Pa]."""
    if "surface_tension" not in case.effects or pool.shape not in ("disc", "sphere"):
        return 0.0
    return case.parameters["surface_tension"].coefficient * (case.dimensions - 1) / pool.radius


def phase_of(case, pool):
    """The section of a pool's phase."""
    return case.gas_phase if pool.phase == "gas" else case.liquid


def holds(pool, points) -> np.ndarray:
    """(N,) whether points lie in a pool."""
    return pool.holds(points) if pool.shape == "tank" else regions.holds(pool, points)
