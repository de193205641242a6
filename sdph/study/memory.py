"""Memory that a case needs, against that of this machine, told before anything of it is made."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from sdph.case import gas_cells
from sdph.effects.around import tank
from sdph.effects.around.source import depth_of
from sdph.engine.walls import facets
from sdph.engine.walls.sides import LAYERS
from sdph.methods.grains.start import extents, mesh_of_walls
from sdph.schema import CaseError
from sdph.study.explain import estimate, feed

MEMINFO, CGROUP = Path("/proc/meminfo"), Path("/sys/fs/cgroup/memory.max")
POINT = 200.0  # bytes of a lattice point that is looked at: place, distances, copies; our choice
ROUND = {2: math.pi, 3: 4.0 / 3.0 * math.pi}  # of a disc and a sphere over radius^dimensions


def refuse_too_large(case) -> None:
    """CaseError where the case needs more memory than is free."""
    count = (
        sum(_volume(case, part) for part in (*case.pools.values(), *case.bodies.values()))
        + sum(_around(case, region) for region in case.particles.values())
    ) / case.resolution.spacing**case.dimensions
    count += sum(_waiting(case, nozzle) for nozzle in case.nozzles.values())
    cells = math.prod(gas_cells.cells(case)) if "grains" in case.matters else 0
    needed, free = (
        estimate.memory(case, count, cells) + POINT * sum(_looked_at(case.only(matter)) for matter in case.matters),
        available(),
    )
    if needed > free:
        raise CaseError(
            f"the case has about {count:.3g} particles and {cells:.3g} gas cells in a domain of "
            f"{' x '.join(f'{size:g}' for size in case.domain.size)} m and needs about "
            f"{needed / 1e9:.3g} GB of memory; {free / 1e9:.3g} GB are free here: raise resolution.spacing_mm or "
            "resolution.cell_mm, or take a larger machine"
        )


def available() -> float:
    """Bytes that a program can still have: what the system says is free, or what its group is allowed; inf where
    neither is told."""
    found = [math.inf]
    if MEMINFO.exists():
        lines = dict(line.split(":") for line in MEMINFO.read_text(encoding="ascii").splitlines())
        found.append(1024.0 * float(lines["MemAvailable"].split()[0]))
    if CGROUP.exists() and (limit := CGROUP.read_text(encoding="ascii").strip()) != "max":
        found.append(float(limit))
    return min(found)


def _volume(case, part) -> float:
    """[m2] or [m3] that a pool or a body fills at most."""
    if part.shape == "tank":
        return math.prod(_extents(case))
    if part.shape == "box":
        return math.prod(high - low for low, high in zip(part.lower, part.upper))
    if part.shape == "cylinder":
        return math.pi * part.radius**2 * part.length
    return ROUND[case.dimensions] * part.radius**case.dimensions


def _around(case, region) -> float:
    """[m2] or [m3] of the box around a region."""
    low, high = extents(case, region)
    return float(np.prod(high - low))


def _waiting(case, nozzle) -> float:
    """Particles upstream of a nozzle, those of grains made for the longest window there can be."""
    depth = depth_of(case) + (nozzle.speed * case.coupling.window_largest if case.grains else 0.0)
    return feed.layer(case, nozzle) * depth / case.resolution.spacing


def _looked_at(case) -> float:
    """Lattice points that are looked at to find those of walls, and points of a surface mesh of walls."""
    if not {"tank", "walls"} & set(case.effects):
        return 0.0
    points = _lattice(case, _extents(case))
    if own := case.parameters.get("tank"):
        points += _lattice(case, (2.0 * own.outlet_radius, 2.0 * own.outlet_radius, own.outlet_length))
    corners = None if case.liquid else mesh_of_walls(case)
    if corners is None:
        return points
    sizes = facets.sizes(corners)
    return points + LAYERS * float(sizes.sum()) / case.resolution.spacing ** (case.dimensions - 1)


def _lattice(case, lengths) -> float:
    """Points of the case's lattice in a box of these lengths [m] and its walls."""
    return math.prod(length / case.resolution.spacing + 2.0 * LAYERS for length in lengths)


def _extents(case) -> tuple[float, ...]:
    """Lengths [m] of the box around the tank of a liquid; of the domain where there is none."""
    own = case.parameters.get("tank")
    if own is None or (own.shape == "box" and own.upper is None):
        return case.domain.size
    if own.shape == "box":
        return tuple(high - low for low, high in zip(own.lower or case.domain.corner, own.upper))
    if own.shape in ("mesh", "outline"):
        bounds = tank.shape_of(case).surface().bounds
        return tuple(high - low for low, high in zip(bounds[::2], bounds[1::2]))[: case.dimensions]
    across = 2.0 * (own.radius or 0.0)
    return (*(across,) * (case.dimensions - 1), across + own.length)
