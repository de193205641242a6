"""Regions that grains fill at the start: lattice points in a shape, in front of the walls, up to a level.

Shapes: box, disc, sphere (`lattice.lattice`); cylinder and cone along an axis, a polygon of the plane, the inside of a
closed surface mesh, and what the mesh of the walls encloses, on a square or cubic lattice. A level is a height over the
region's lowest point, or the mass that comes to lie below it.
"""

from __future__ import annotations

import math

import numpy as np

from sdph.engine.lattice import grid, lattice
from sdph.engine.surface import unit
from sdph.engine.walls import facets, shapes
from sdph.engine.walls.dummies import CONTACT
from sdph.engine.walls.outline import outline
from sdph.engine.world import ALONE
from sdph.laws.constants import SAME
from sdph.schema import CaseError

ALONG_AXIS = ("cylinder", "cone")
ROUND = ("disc", "sphere")
BY_SURFACE = ("mesh", "outline")
AXES = ("x", "y", "z")
MESH = "mesh of particles"
BELOW = 0.5  # of a spacing between a level and the row below
PLACES = 100000  # by which volumes are counted; our choice


def bounds(region, walls, dimensions: int) -> tuple[np.ndarray, np.ndarray]:
    """Lower and upper corner (d,) [m] of the box around a region; `walls` (F, d, d) [m]
    are the facets of their mesh."""
    if region.shape == "box":
        return np.array(region.lower), np.array(region.upper)
    if region.shape == "outline":
        return np.min(region.corners, axis=0), np.max(region.corners, axis=0)
    if region.shape == "mesh":
        low, high = np.reshape(_surface(region).triangles.bounds, (3, 2)).T
        return low, high
    if region.shape == "walls":
        corners = walls.reshape(-1, dimensions)
        return corners.min(axis=0), corners.max(axis=0)
    centre, half = np.array(region.centre), np.full(dimensions, max(region.radius, region.end_radius or 0.0))
    if region.shape in ALONG_AXIS:
        half[AXES.index(region.axis)] = 0.5 * region.length
    return centre - half, centre + half


def closed_form(region, dimensions: int) -> float:
    """Volume [m^d] of a box, a disc, a sphere, a ring, a cylinder, a cone or a polygon; nan of other shapes."""
    if region.shape == "box":
        return math.prod(b - a for a, b in zip(region.lower, region.upper))
    if region.shape in ALONG_AXIS:
        a, b = _radii(region)
        return math.pi * region.length * (a * a + a * b + b * b) / 3.0
    if region.shape == "outline":
        return _surface(region).volume
    if region.shape == "ring":
        return math.pi * (region.radius**2 - region.inner_radius**2)
    if region.shape in ROUND:
        return math.pi * region.radius**2 * (1.0 if dimensions == 2 else 4.0 / 3.0 * region.radius)
    return math.nan


def holds(region, places) -> np.ndarray:
    """(N,) whether places (N, d) [m] lie in a box, disc, sphere or ring."""
    if region.shape == "box":
        return ((places >= np.array(region.lower)) & (places <= np.array(region.upper))).all(axis=1)
    away = np.sqrt(((places - np.array(region.centre)) ** 2).sum(axis=1))
    return (away <= region.radius) & (away >= (region.inner_radius or 0.0))


def volume(region, spacing: float, dimensions: int, count: int) -> float:
    """[m^d] of each of the `count` points of a region: they share what is known of it, else it is that of the
    lattice."""
    if region.shape == "box" or region.shape in ALONG_AXIS:
        return closed_form(region, dimensions) / count
    if region.shape in BY_SURFACE:
        return _surface(region).volume / count
    return spacing**dimensions


def counted(region, low, high, walls, layers: float, spacing: float) -> float:
    """Volume [m^d] of what of a region lies between `low` and `high` (d,) [m] and in front of the walls, as `in_front`
    means it, but up to their surface: places of a lattice that are counted."""
    d = len(low)
    step = (float(np.prod(high - low)) / PLACES) ** (1.0 / d)
    counts = np.maximum(np.round((high - low) / step), 1).astype(int)
    places = grid([a + (np.arange(n) + 0.5) * (b - a) / n for a, b, n in zip(low, high, counts)])
    each = float(np.prod((high - low) / counts))
    if region.shape in ALONG_AXIS:
        places = places[_in_cone(region, places, bounds(region, walls, d)[0])]
    elif region.shape in ROUND:
        places = places[((places - np.array(region.centre)) ** 2).sum(axis=1) < region.radius**2]
    elif region.shape in BY_SURFACE:
        places = places[_surface(region).distance(places) < 0.0]
    if walls is None or not len(places):
        return each * len(places)
    layers = math.inf if region.shape == "walls" else layers
    return each * int(in_front(places, walls, spacing, layers, near=2.0 * SAME).sum())


def _surface(region):
    """The closed surface that a region is the inside of."""
    if region.shape == "outline":
        return outline("corners_m of particles", region.corners)
    return shapes.Mesh(region.mesh, MESH, unit(region))


def _radii(region) -> tuple[float, float]:
    """Radii [m] at the lower and the upper end of a cylinder or a cone."""
    return region.radius, region.radius if region.shape == "cylinder" else region.end_radius


def points(region, spacing: float, dimensions: int, walls, world=ALONE) -> np.ndarray:
    """(N, d) [m] of the lattice in a region, whatever stands there; `walls` as in `bounds`. Each process of a world has
    a part of them, one after the other."""
    if region.shape in ("box", *ROUND):
        return lattice(region, spacing, dimensions, world)
    low, high = bounds(region, walls, dimensions)
    if region.shape in ALONG_AXIS:
        places = _round_grid(region, low, high, spacing, world)
        return places[_in_cone(region, places, low)]
    ticks = [a + (np.arange(max(1, round((b - a) / spacing))) + 0.5) * spacing for a, b in zip(low, high)]
    places = grid(ticks, world)
    if region.shape in BY_SURFACE:
        return places[_surface(region).distance(places) < 0.0]
    return places[facets.Surface(walls).distance(places) > 0.0]


def _round_grid(region, low, high, spacing: float, world) -> np.ndarray:
    """Lattice over the box of a round region: fitted to its length, about its axis elsewhere."""
    ticks = []
    for axis, (a, b) in enumerate(zip(low, high)):
        if AXES[axis] == region.axis:
            count = max(1, round((b - a) / spacing))
            ticks.append(a + (np.arange(count) + 0.5) * (b - a) / count)
        else:
            reach = math.ceil(0.5 * (b - a) / spacing)
            ticks.append(0.5 * (a + b) + (np.arange(-reach, reach) + 0.5) * spacing)
    return grid(ticks, world)


def _in_cone(region, places, low) -> np.ndarray:
    """Mask (N,) of the places between the ends of a cylinder or a cone and within its radius there."""
    along = AXES.index(region.axis)
    across = [axis for axis in range(3) if axis != along]
    share = (places[:, along] - low[along]) / region.length
    start, end = _radii(region)
    off = places[:, across] - np.array(region.centre)[across]
    return np.hypot(*off.T) <= start + share * (end - start)


def in_front(places, walls, spacing: float, layers: float, near: float = CONTACT) -> np.ndarray:
    """Mask (N,) of the places that stand in front of facets (F, d, d) [m] of walls, no nearer than `near` spacings
    (usual: than contact holds grains), or so far behind an open part of them that it is none to them: its dummies are
    `layers` spacings deep."""
    front, closed = np.ones(len(places), bool), facets.of_closed_parts(walls)
    for own, deep in ((walls[closed], math.inf), (walls[~closed], layers * spacing)):
        if len(own):
            off = facets.Surface(own).distance(places)
            front &= (off >= (near - SAME) * spacing) | (off < -deep)
    return front


def below(where: str, region, places, up, spacing: float, each: float, world=ALONE, walls=None) -> np.ndarray:
    """Mask (N,) of the places up to the level of a region, `each` [kg] the mass of a particle; `up` (d,). Each process
    of a world has a part of the places; of a region with a mass each has all.
    `walls` as in `bounds`."""
    height = places @ up
    if region.height is not None:
        least = world.least(float(height.min(initial=math.inf)))
        span = world.most(float(height.max(initial=-math.inf))) - least + spacing
        if region.height > span + spacing:
            tall = _tall(region, walls, up, span)
            raise CaseError(f"{where}.height_m = {region.height:g}; its region is {tall:.4g} m high: give less")
        return height <= least + region.height - (BELOW - SAME) * spacing
    count = max(1, round(region.mass / each))
    if count > len(places):
        most = f"{len(places) * each:.6g} kg fit at volume_fraction = {region.volume_fraction:g}"
        raise CaseError(f"{where}.mass_kg = {region.mass:g}; {most}: give less, or a larger region")
    off = ((places - places.mean(axis=0)) ** 2).sum(axis=1)  # a layer that is not full is filled from its middle
    chosen = np.lexsort((off, np.round(height / (SAME * spacing))))[:count]
    mask = np.zeros(len(places), bool)
    mask[chosen] = True
    return mask


def _tall(region, walls, up, span: float) -> float:
    """Height [m] of a region along an axis; along none the `span` of its places."""
    if np.count_nonzero(up) != 1:
        return span
    low, high = bounds(region, walls, len(up))
    return float(np.abs(up) @ (high - low))


def disordered(places, share: float, seed: int, spacing: float, before: int = 0) -> np.ndarray:
    """The places, each moved by up to a share of the spacing along each axis, by chance; there are so many `before`
    them, which others have."""
    if not share:
        return places
    chance = np.random.default_rng(seed)
    chance.bit_generator.advance(before * places.shape[1])
    return places + share * spacing * chance.uniform(-1.0, 1.0, places.shape)
