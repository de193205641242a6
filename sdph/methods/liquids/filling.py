"""The part of a tank that a pool fills: between which levels it lies, and where its particles stand.

There are as many as its volume asks for. A lattice that ends half a spacing before a curved wall leaves a layer half a
spacing thick free along it, and stands too high by what that layer would hold; so the particles are those of a lattice
that lie deepest, packed (sdph.methods.liquids.packing) so that they conform to the wall. A box that stands upright is
filled as any other box: the lattice is fitted to its sides.
"""

from __future__ import annotations

import dataclasses
import math
from typing import NamedTuple

import numpy as np

from sdph.effects.around import tank
from sdph.engine.lattice import grid
from sdph.engine.walls import layers, shapes
from sdph.laws.constants import ROUND_OFF
from sdph.methods.liquids import packing
from sdph.methods.liquids.sections import Pool
from sdph.schema import CaseError, record

FINER = 4  # than the spacing are the cells that a pipe, a few spacings wide, is measured by; our choice


class Slab(NamedTuple):
    """Slab between the heights `low` and `high` [m] along the unit vector `up` (d,): from `below` to `fill` of the
    tank's volume; the lowest one, `below` = 0, has no lower end, so that an outlet pipe is part of it."""

    up: np.ndarray
    low: float
    high: float
    below: float
    fill: float

    def beyond(self, points) -> np.ndarray:
        """(N,) how far [m] points lie outside, negative inside."""
        height = points @ self.up
        return np.maximum(height - self.high, self.low - height)

    def back(self, points) -> np.ndarray:
        """(N, d) [m] from points outside onto its rim, 0 inside."""
        height = points @ self.up
        return (np.clip(height, self.low, self.high) - height)[:, None] * self.up


@record
class Filled(Pool):
    """A pool of the shape tank, and where it lies in the tank."""

    inside: object = None  # the tank without its outlet pipe, which is buffer and no volume
    slab: Slab | None = None

    def holds(self, points) -> np.ndarray:
        """(N,) whether points lie in it."""
        return (self.inside.distance(points) <= 0.0) & (self.slab.beyond(points) <= 0.0)


def pools(case) -> list[Pool]:
    """The pools of a case, those of the shape tank filled from the level of the ones before, as boxes in an upright
    box."""
    found, below = [], 0.0
    for name, pool in case.pools.items():
        if pool.shape == "tank":
            pool, below = _filled(case, name, pool, below), pool.fill
        found.append(pool)
    return found


def _filled(case, name: str, pool, below: float):
    """Part of the tank that a pool fills above the share `below` of the tank's volume."""
    if "tank" not in case.effects or pool.fill is None:
        raise CaseError('pools: shape = "tank" needs the effect tank, and fill')
    if pool.fill <= below:
        raise CaseError(
            f"pools.{name}.fill = {pool.fill:g}; the pools before it fill the tank up to {below:g}: give it more, or "
            "name it first"
        )
    shape, up = tank.shape_of(case), upwards(case)
    inside = shape.tank if isinstance(shape, shapes.Joined) else shape
    if (pool.fill - below) * inside.volume < 0.5 * case.resolution.spacing**case.dimensions:
        raise CaseError(
            f"pools: fill = {pool.fill:g} is less than half a particle of the tank; fill it more, or give a smaller "
            "spacing_mm"
        )
    low, high = levels(inside, up, (below, pool.fill), case.resolution.spacing)
    if inside is shape and isinstance(inside, shapes.Box) and np.abs(up).max() == 1.0:
        return _as_box(inside, pool, up, low, high)
    return Filled(**vars(pool), inside=inside, slab=Slab(up, low if below else -math.inf, high, below, pool.fill))


def upwards(case) -> np.ndarray:
    """(d,) unit vector against `pull`; along the last axis where there is none."""
    along = pull(case)
    return -along / np.linalg.norm(along) if along.any() else np.eye(case.dimensions)[-1]


def pull(case) -> np.ndarray:
    """(d,) gravity [m/s2] where the effect is on, less its part along periodic axes, where it drives a flow."""
    walled = 1.0 - np.array(case.liquid.periodic or [0.0] * case.dimensions)
    return np.array(case.domain.gravity) * walled * ("gravity" in case.effects)


def _as_box(shape, pool, up, low: float, high: float):
    """The pool as a box: the tank's, cut off at two heights [m] along `up`, one of its axes."""
    lower, upper = np.array(shape.lower), np.array(shape.upper)
    k = int(np.argmax(np.abs(up)))
    lower[k], upper[k] = sorted((low * up[k], high * up[k]))
    return dataclasses.replace(pool, shape="box", lower=tuple(lower), upper=tuple(upper))


def levels(shape, up, fills, spacing: float) -> np.ndarray:
    """Heights [m] along `up` below which the shares `fills` of the volume lie, from sums over the cells of a
    lattice."""
    axes, k = _axes(up)
    low, high = bounds(shape, axes)
    points, steps = _cells(low, high, spacing)
    layer = ((points[:, k] - low[k]) / steps[k]).astype(int)
    held = np.cumsum(np.bincount(layer, _shares(shape, points @ axes, steps)))
    return np.interp(np.array(fills) * held[-1], [0.0, *held], low[k] + steps[k] * np.arange(len(held) + 1))


def _cells(low, high, spacing: float) -> tuple[np.ndarray, np.ndarray]:
    """(N, d) middles of equal cells between two corners, and their sides (d,) [m], no longer than `spacing`."""
    counts = np.ceil((high - low) / spacing - ROUND_OFF).astype(int)
    steps = (high - low) / counts
    return grid([a + (np.arange(n) + 0.5) * step for a, n, step in zip(low, counts, steps)]), steps


def _shares(shape, middles, steps) -> np.ndarray:
    """(N,) how much of cells of sides `steps` (d,) lies inside a shape, its surface taken as flat within a cell."""
    return np.clip(0.5 - shape.distance(middles) / steps.min(), 0.0, 1.0)


def _axes(up) -> tuple[np.ndarray, int]:
    """(d, d) unit vectors as rows, and which of them is `up`: the axes, mirrored so that the nearest to `up` falls onto
    it."""
    k = int(np.argmax(np.abs(up)))
    across = np.eye(len(up))[k] - up
    square = across @ across
    return np.eye(len(up)) - (2.0 / square * np.outer(across, across) if square else 0.0), k


def bounds(shape, axes) -> tuple[np.ndarray, np.ndarray]:
    """(d,) least and greatest coordinate of a shape along unit vectors `axes` (d, d)."""
    return np.array([-shape.furthest(-axis) for axis in axes]), np.array([shape.furthest(axis) for axis in axes])


def fill(case, pool: Filled) -> np.ndarray:
    """(N, d) places of the particles of a pool of the tank, and of the outlet pipe as high as the pool, if it is the
    lowest."""
    shape, slab, spacing, reach = tank.shape_of(case), pool.slab, case.resolution.spacing, 2.0 * case.smoothing_length
    points, layer = lattice(shape, pool.inside, slab, spacing, reach)
    from_tank, from_slab = pool.inside.distance(points), slab.beyond(points)
    wet = _deepest(
        np.maximum(from_tank, from_slab), (slab.fill - slab.below) * pool.inside.volume, spacing, len(slab.up)
    )
    if isinstance(shape, shapes.Joined) and not slab.below:
        outside = np.maximum(np.maximum(shape.pipe.distance(points), -from_tank), from_slab)
        outside[wet] = np.inf
        wet = np.concatenate([wet, _deepest(outside, _buffer(shape, slab, spacing / FINER), spacing, len(slab.up))])
    lid = (shape.distance(points) <= ROUND_OFF * spacing) & (from_slab > 0.0) & (from_slab < reach)
    walls = layers.wall_points(shape, spacing, tank.layers(case))
    between = slab._replace(low=slab.low + 0.5 * layer, high=slab.high - 0.5 * layer)
    return packing.pack(case, points[wet], walls, points[lid], between, shape)


def lattice(shape, inside, slab: Slab, spacing: float, reach: float) -> tuple[np.ndarray, float]:
    """(N, d) points in cells of spacing^d, and the height [m] of their layers, a whole number of which make up the
    slab.

    They cover a shape, of which `inside` is the tank, from `reach` [m] below the slab to as much above it, and a cell
    around.
    """
    axes, k = _axes(slab.up)
    low, high = bounds(inside, axes)
    first, last = bounds(shape, axes)
    bottom = max(slab.low, low[k])
    first[k], last[k] = max(first[k], slab.low - reach), min(last[k], slab.high + reach)
    layer = (slab.high - bottom) / max(1, round((slab.high - bottom) / spacing))
    steps = np.full(len(axes), spacing * (spacing / layer) ** (1.0 / (len(axes) - 1)))
    steps[k] = layer
    # corner of a cell: about the middle they lie evenly
    origin = 0.5 * (low + high - np.round((high - low) / steps) * steps)
    origin[k] = bottom
    ends = np.floor((first - origin) / steps).astype(int) - 1, np.ceil((last - origin) / steps).astype(int) + 1
    ticks = [start + (np.arange(a, b) + 0.5) * step for start, a, b, step in zip(origin, *ends, steps)]
    return grid(ticks) @ axes, layer


def _buffer(shape, slab: Slab, spacing: float) -> float:
    """Volume [m^d] of what of an outlet pipe lies outside the tank and within the slab, from cells of that spacing
    [m]."""
    middles, steps = _cells(*bounds(shape.pipe, np.eye(len(slab.up))), spacing)
    outside = _shares(shape.pipe, middles, steps) * (1.0 - _shares(shape.tank, middles, steps))
    return float(outside[slab.beyond(middles) <= 0.0].sum() * np.prod(steps))


def _deepest(beyond, volume: float, spacing: float, dimensions: int) -> np.ndarray:
    """Rows of as many points as a volume [m^d] asks for, those that lie least `beyond` (N,) [m] its limits."""
    return np.argsort(np.round(beyond / (ROUND_OFF * spacing)), kind="stable")[: round(volume / spacing**dimensions)]
