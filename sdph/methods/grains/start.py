"""The grains that a case has at the start."""

from __future__ import annotations

import dataclasses
import itertools
import math
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from sdph.engine import regions
from sdph.engine.state import OF_MATERIAL, Grains, State, axes, born, empty, join
from sdph.engine.surface import unit
from sdph.engine.walls import facets
from sdph.engine.walls.sides import LAYERS
from sdph.engine.world import ALONE
from sdph.laws.constants import ROUND_OFF
from sdph.methods.grains import vessels
from sdph.schema import CaseError

# particles of two regions that may be near where they touch: this share, and so many (a disc on a box); our choice
FEW, TOUCHING = 0.01, 4
OFF = 0.03  # of the mass of a region, from which on it is told; our choice


class Places(NamedTuple):
    """Places (n, d) [m] of the particles of a region that this process makes, how many are before them and in all, and
    the volume of each [m^d]; `all` (N, d) where each process knows all."""

    own: np.ndarray
    before: int
    total: int
    volume: float
    all: np.ndarray


def fill(case, names, notices=None, masses=None, world=ALONE) -> State:
    """The particles that a case has at the start, numbered from 1 as in the paper; mass = alpha_p rho_p dx^d. Each
    process of a world makes a part of them.

    `notices`, a list, gets a line for each region of which something is behind walls, or whose mass is another than
    was meant, and of walls that are open; `masses`, a table, the mass of each region [kg] by its name."""
    notices, masses = [] if notices is None else notices, {} if masses is None else masses
    notices += vessels.checked(case)
    places = [_places(case, name, region, notices, world) for name, region in case.particles.items()]
    _look_for_overlap(case, places, notices)
    parts = [_region(case, region, own, names) for region, own in zip(case.particles.values(), places)]
    masses |= {name: world.sum(float(part.mass.sum())) for name, part in zip(case.particles, parts)}
    notices += _off(case, masses)
    state, first = empty(0, names, case.dimensions, Grains), 1
    for part, own in zip(parts, places):
        part.ident[:] = np.arange(len(part.ident)) + first + own.before
        state, first = join(state, part), first + own.total
    return state


def never_there(case, made: int) -> list[str]:
    """A line where particles are to be followed whose numbers none of those `made` at the start has, and no nozzle will
    give."""
    lost = [number for number in case.track if number > made]
    if not lost or case.nozzles:
        return []
    return [
        f"track.particles holds {', '.join(map(str, lost))}; the case has {made} particles, counted from 1, and no "
        "nozzle brings more: columns of these stay nan; leave them out"
    ]


def _look_for_overlap(case, places, notices) -> None:
    """CaseError where grains of two regions stand among each other, denser than they can be packed; a notice where they
    are of one material, and do so at less: they add up. Different materials are a mixture there."""
    spacing, limit = case.resolution.spacing, case.grains.packing_limit
    near = 0.5 * math.sqrt(case.dimensions) * spacing  # from the middle of a cell of a lattice to its corners
    rows = [(name, region, here.all) for (name, region), here in zip(case.particles.items(), places)]
    for (name, region, own), (other, beside, theirs) in itertools.combinations(rows, 2):
        dense, alike = region.volume_fraction + beside.volume_fraction, region.material == beside.material
        if dense <= limit and not alike:
            continue
        among = theirs[np.isfinite(cKDTree(own).query(theirs, distance_upper_bound=(1.0 + ROUND_OFF) * near)[0])]
        if len(among) <= FEW * min(len(own), len(theirs)) + TOUCHING:
            continue
        place = ", ".join(f"{a:.4g}" for a in among[0])
        if dense > limit:
            raise CaseError(
                f"particles.{name} and particles.{other} overlap: {len(among)} particles stand in both, the first at "
                f"({place}) m, where alpha_p would be {dense:.3g} of at most {limit:g}; move or shrink one"
            )
        notices.append(
            f"particles.{name} and particles.{other} are the same grains and overlap: {len(among)} of {len(theirs)} "
            f"particles of {other} ({len(among) / len(theirs):.0%}) stand among those of {name}, the first at "
            f"({place}) m, and alpha_p adds up to {dense:.3g} there; move or shrink one, unless that is meant"
        )


def meant(case, region) -> float:
    """Mass [kg] that a region is given: mass_kg, or volume_fraction of its volume up to its level and in front of the
    walls' mesh; nan where that mesh is not there yet, and where a level is along no axis."""
    if region.mass is not None:
        return region.mass
    walls, along = mesh_of_walls(case), np.flatnonzero(case.domain.gravity)
    if (region.shape == "walls" and walls is None) or (region.height is not None and len(along) != 1):
        return math.nan
    low, high = extents(case, region)
    if walls is None and (region.height is None or _of_one_width(region, along[0])):
        volume, (lower, upper) = regions.closed_form(region, case.dimensions), regions.bounds(region, None, len(low))
        volume *= float(np.prod((high - low) / (upper - lower)))
    else:
        volume = regions.counted(region, low, high, walls, deep(case), case.resolution.spacing)
    if math.isnan(volume):  # of a mesh
        volume = regions.volume(region, case.resolution.spacing, case.dimensions, 1)
    return region.volume_fraction * case.of(region.material).density * volume


def _of_one_width(region, along: int) -> bool:
    """True where a region is as wide at all places along an axis."""
    return region.shape == "box" or (region.shape == "cylinder" and regions.AXES[along] == region.axis)


def deep(case) -> float:
    """Spacings behind an open mesh within which nothing stands; what is behind walls of the gas's own mesh is in none
    of its cells, however far."""
    return math.inf if "walls" in case.effects and case.parameters["walls"].source == "gas" else LAYERS


def within_walls(case, places) -> np.ndarray:
    """(N,) whether places (N, d) [m] lie within a walls.mesh that the gas goes through: none behind the gas's own."""
    walls = mesh_of_walls(case)
    if walls is None or deep(case) == math.inf:
        return np.zeros(len(places), bool)
    return ~regions.in_front(places, walls, case.resolution.spacing, deep(case), near=0.0)


def _off(case, masses) -> list[str]:
    """A line for each region whose particles hold another mass than was meant."""
    told = []
    for name, mass in masses.items():
        given = meant(case, case.particles[name])
        if abs(mass - given) > OFF * given:
            more = f"{abs(mass / given - 1.0):.0%} {'more' if mass > given else 'less'}"
            told.append(
                f"particles.{name} holds {mass:.4g} kg, {more} than volume_fraction of its volume, {given:.4g} kg: "
                "particles stand on a lattice, and none within walls or a quarter of a spacing before them; "
                f"particles.{name}.mass_kg gives them all of it, a smaller resolution.spacing_mm comes nearer"
            )
    return told


def mesh_of_walls(case) -> np.ndarray | None:
    """Facets (F, d, d) [m] of the mesh of the walls; None where there is none."""
    own = case.parameters["walls"] if "walls" in case.effects else None
    return facets.read(own.mesh, case.dimensions, unit(own)) if own and own.mesh else None


def assumed(case):
    """The case for estimates before a run: what walls enclose that are not known yet is the domain, at most."""
    box = {"shape": "box", "lower": case.domain.corner, "upper": case.domain.upper}
    unknown = box if mesh_of_walls(case) is None else {}
    found = {
        name: dataclasses.replace(region, **unknown) if region.shape == "walls" else region
        for name, region in case.particles.items()
    }
    return dataclasses.replace(case, particles=found)


def extents(case, region) -> tuple[np.ndarray, np.ndarray]:
    """Lower and upper corner (d,) [m] of the box around a region, up to the level that it is filled to by height where
    gravity points along an axis; around the domain where the mesh of walls is not there yet."""
    walls = mesh_of_walls(case)
    if region.shape == "walls" and walls is None:
        low, high = np.array(case.domain.corner), np.array(case.domain.upper)
    else:
        low, high = map(np.array, regions.bounds(region, walls, case.dimensions))
    along = np.flatnonzero(case.domain.gravity)
    if region.height is not None and len(along) == 1:
        axis = along[0]
        if case.domain.gravity[axis] < 0.0:
            high[axis] = min(high[axis], low[axis] + region.height)
        else:
            low[axis] = max(low[axis], high[axis] - region.height)
    return low, high


def _places(case, name: str, region, notices, world) -> Places:
    """`Places` of the particles of a region. Each process looks for its own alone, but for all where regions may
    overlap, or fill up from below."""
    apart = world if len(case.particles) == 1 and region.mass is None else ALONE
    spacing, d, walls = case.resolution.spacing, case.dimensions, mesh_of_walls(case)
    if region.shape == "walls" and walls is None:
        raise CaseError(
            f'particles.{name}.shape = "walls", and the walls are the sides of the domain: give a box, or walls.mesh, '
            "or a mesh of the gas of your own in the folder gas"
        )
    points = regions.points(region, spacing, d, walls, apart) + spacing * staggered(case, name)
    there = apart.sum(len(points))
    volume = regions.volume(region, spacing, d, there) if there else 0.0
    each = region.volume_fraction * case.of(region.material).density * volume
    points = _reached(case, f"particles.{name}", region, points, walls, each, notices, apart)
    if apart is world:
        return Places(points, apart.before(len(points)), apart.sum(len(points)), volume, points)
    first, end = world.ends(len(points))
    return Places(points[first:end], first, len(points), volume, points)


def _region(case, region, places: Places, names) -> State:
    """The particles of a region that this process makes."""
    grains, state = case.of(region.material), empty(len(places.own), names, case.dimensions)
    density = region.volume_fraction * grains.density
    for axis, column in zip(axes(state), places.own.T):
        axis[:] = column
    for array, value in zip((state.u, state.v, state.w), region.velocity or ()):
        array[:] = value
    state.density[:] = density
    state.mass[:] = density * places.volume if region.mass is None else region.mass / places.total
    for key, value in (
        ("temperature", region.temperature),
        ("diameter", grains.diameter),
        ("diameter_variance", grains.diameter_std**2),
        ("theta", grains.granular_temperature),
        *zip(OF_MATERIAL, (case.number(region.material), *grains.of_particles)),
    ):
        getattr(state, key)[:] = value
    return born(state)


def staggered(case, name: str) -> float:
    """Spacings by which the lattice of a region is shifted along each axis: those of k regions of different materials
    that stand among each other are 1/k apart, so that no particle stands on another."""
    names = among(case, name)
    return (names.index(name) + 0.5) / len(names) - 0.5


def among(case, name: str) -> list[str]:
    """Regions of other materials that stand in the box around a region, and it itself, in the order of the case."""
    own, found, least = case.particles[name], [], ROUND_OFF * case.resolution.spacing
    low, high = extents(case, own)
    for other, region in case.particles.items():
        lower, upper = extents(case, region)
        overlap = (high - lower > least) & (upper - low > least)
        if other == name or (case.mixed and overlap.all() and region.material != own.material):
            found.append(other)
    return found


def _reached(case, where: str, region, points, walls, each: float, notices, world) -> np.ndarray:
    """The points of a region that grains stand on: off the lattice by chance, in front of the walls, up to its level;
    `each` [kg] the mass of a particle."""
    spacing, there = case.resolution.spacing, world.sum(len(points))
    points = regions.disordered(points, region.disorder, region.seed, spacing, world.before(len(points)))
    if walls is not None:
        points = points[regions.in_front(points, walls, spacing, deep(case))]
        if region.shape != "walls" and (left := world.sum(len(points))) < there:
            turned = "; the normals of walls.mesh must point towards the grains" * (
                left < 0.5 * there and deep(case) < math.inf
            )
            notices.append(
                f"{where}: {there - left} of {there} particles would stand in walls and are left out{turned}"
            )
    if not world.any(len(points) > 0):
        what = f"none of its {there} places" if there else "no place"
        mesh = "walls.mesh; look at its normals, or move the region"
        vessel = "the walls of the gas's mesh: it lies outside of that, or behind them; move the region"
        raise CaseError(f"{where} holds {what} in front of {mesh if deep(case) < math.inf else vessel}")
    if region.height is not None or region.mass is not None:
        gravity = np.array(case.domain.gravity)
        up = -gravity / np.linalg.norm(gravity)
        points = points[regions.below(where, region, points, up, spacing, each, world, walls)]
        if not world.any(len(points) > 0):
            raise CaseError(f"{where}.height_m = {region.height:g} is below half a spacing: give more")
    return points
