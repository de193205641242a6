"""Tanks: how far a point lies inside, where its surface is, and what the tank holds.

A shape has `distance(points)` [m], negative inside, `shell(depth, spacing)` the points of the surface moved outwards
by `depth`, about one spacing apart, `surface()` of its walls for pictures (pyvista, lines in two dimensions), and
`volume` [m^d], and `furthest(direction)` [m], the most of r.direction in it. The axis of a round tank is the last one
of the case.
"""

from __future__ import annotations

import functools
import itertools
import math
from dataclasses import dataclass, field

import numpy as np

from sdph.engine.lattice import grid
from sdph.engine.surface import METRES, Unit, read
from sdph.engine.walls import facets, nested, surface_points
from sdph.engine.walls.facets import OPPOSITE
from sdph.engine.walls.surface_points import arc, disc, line, rings
from sdph.schema import CaseError

UP = (0.0, 0.0, 1.0)  # axis of a round tank in space
ROUND_OFF = 1e-3  # share of a spacing, or of a depth, that STL rounds off: our choice
FINER = 3  # than the spacing is what a layer is measured by; odd, so that a lattice behind a plane stays; our choice
SAME_PLACE = 1e-9  # of a depth: what is nearer to a surface is on it, and has no way from it; our choice


@dataclass(frozen=True)
class Capsule:
    """Half spheres of `radius` over a cylinder of `length` (0: a sphere), about `centre` (3,)."""

    centre: np.ndarray
    radius: float
    length: float = 0.0

    def distance(self, points):
        r = points - self.centre
        height = r[:, 2] - np.clip(r[:, 2], -0.5 * self.length, 0.5 * self.length)
        return np.sqrt(r[:, 0] ** 2 + r[:, 1] ** 2 + height**2) - self.radius

    def shell(self, depth, spacing):
        radius, half = self.radius + depth, 0.5 * self.length
        parts = [arc(radius, half, 0.0, 0.5 * math.pi, spacing), arc(radius, -half, 0.5 * math.pi, math.pi, spacing)]
        if self.length:
            parts.append(line(radius, -half, half, spacing))
        else:
            parts = [arc(radius, 0.0, 0.0, math.pi, spacing)]
        return rings(np.concatenate(parts), spacing) + self.centre

    def surface(self):
        import pyvista

        if self.length:
            return pyvista.Capsule(center=self.centre, direction=UP, radius=self.radius, cylinder_length=self.length)
        return pyvista.Sphere(radius=self.radius, center=self.centre)

    def furthest(self, direction):
        return float(self.centre @ direction + self.radius + 0.5 * self.length * abs(direction[2]))

    @property
    def volume(self):
        return math.pi * self.radius**2 * (4.0 / 3.0 * self.radius + self.length)


@dataclass(frozen=True)
class Cylinder:
    """Upright, flat ends; `centre` (3,) of its middle. An end that is `open` has no wall (a pipe's mouth)."""

    centre: np.ndarray
    radius: float
    length: float
    reach: float
    open_top: bool = False

    def distance(self, points):
        r = points - self.centre
        out = np.stack([np.hypot(r[:, 0], r[:, 1]) - self.radius, np.abs(r[:, 2]) - 0.5 * self.length], axis=1)
        return np.minimum(out.max(axis=1), 0.0) + np.linalg.norm(np.maximum(out, 0.0), axis=1)

    def shell(self, depth, spacing):
        half, beyond = 0.5 * self.length, self.reach
        side = line(self.radius + depth, -half - beyond, half + (0.0 if self.open_top else beyond), spacing)
        ends = [disc(self.radius, -half - depth, spacing)]
        if not self.open_top:
            ends.append(disc(self.radius, half + depth, spacing))
        return rings(np.concatenate([side, *ends]), spacing) + self.centre

    def surface(self):
        import pyvista

        return pyvista.Cylinder(
            center=self.centre, direction=UP, radius=self.radius, height=self.length, capping=not self.open_top
        )

    def furthest(self, direction):
        return float(
            self.centre @ direction + self.radius * np.hypot(*direction[:2]) + 0.5 * self.length * abs(direction[2])
        )

    @property
    def volume(self):
        return math.pi * self.radius**2 * self.length


@dataclass(frozen=True)
class Disc:
    """A round tank in two dimensions."""

    centre: np.ndarray
    radius: float

    def distance(self, points):
        return np.linalg.norm(points - self.centre, axis=1) - self.radius

    def shell(self, depth, spacing):
        radius = self.radius + depth
        count = round(2.0 * math.pi * radius / spacing)
        angle = 2.0 * math.pi * np.arange(count) / count
        return radius * np.stack([np.cos(angle), np.sin(angle)], axis=1) + self.centre

    def surface(self):
        import pyvista

        return pyvista.Circle(radius=self.radius).translate((*self.centre, 0.0)).extract_feature_edges()

    def furthest(self, direction):
        return float(self.centre @ direction + self.radius)

    @property
    def volume(self):
        return math.pi * self.radius**2


@dataclass(frozen=True)
class Box:
    """Space between `lower` and `upper` (d,); sides in `open` (axis, end) have no wall."""

    lower: np.ndarray
    upper: np.ndarray
    open: tuple[tuple[int, int], ...] = ()

    def distance(self, points):
        out = np.maximum(self.lower - points, points - self.upper)
        return np.minimum(out.max(axis=1), 0.0) + np.linalg.norm(np.maximum(out, 0.0), axis=1)

    def steps(self, spacing):
        """Numbers of cells that fit its sides, and their lengths (d,) [m]."""
        counts = np.array([max(1, round(length / spacing)) for length in self.upper - self.lower])
        return counts, (self.upper - self.lower) / counts

    def shell(self, depth, spacing):
        """The lattice points whose greatest depth behind a side is `depth`, in front of no open side."""
        layers = round(depth / spacing + 0.5)
        counts, steps = self.steps(spacing)
        first, *others = (np.arange(-layers, n + layers) for n in counts)
        plane = np.stack([m.ravel() for m in np.meshgrid(*others, indexing="ij")], axis=1)
        behind = [self._behind(row, plane, counts, layers) for row in first]  # not all at once: few of a plane are kept
        return self.lower + (np.concatenate(behind) + 0.5) * steps

    def _behind(self, row: int, plane, counts, layers: int):
        """Numbers (n, d) of the lattice points of a plane that lie so many layers behind a side."""
        places = np.column_stack((np.full(len(plane), row), plane))
        behind = np.maximum(-places, places - (counts - 1)).max(axis=1) == layers
        for axis, end in self.open:
            behind &= places[:, axis] < counts[axis] if end else places[:, axis] >= 0
        return places[behind]

    def surface(self):
        import pyvista

        d, sides = len(self.lower), []
        for axis, end in itertools.product(range(d), (0, 1)):
            if (axis, end) not in self.open:
                corners = np.zeros((3, 3))  # of the side: two opposite ones, and one between
                corners[:, :d] = self.lower, self.lower, self.upper
                corners[:, axis] = (self.lower, self.upper)[end][axis]
                corners[1, (axis + 1) % d] = self.upper[(axis + 1) % d]
                sides.append(pyvista.Rectangle(corners) if d == 3 else pyvista.Line(corners[0], corners[2]))
        return pyvista.merge(sides) if sides else None

    def furthest(self, direction):
        return float(np.maximum(self.lower * direction, self.upper * direction).sum())

    @property
    def volume(self):
        return float(np.prod(self.upper - self.lower))


@dataclass(frozen=True)
class Mesh:
    """Inside of a closed surface mesh of triangles that meshio reads, in its `unit`, normals outwards."""

    path: str
    key: str = "tank.mesh"  # of the case, for messages
    unit: Unit = METRES
    # shells by depth and spacing: a run asks for them to fill the tank, and again for its walls
    shells: dict = field(default_factory=dict, init=False, compare=False, repr=False)

    @functools.cached_property
    def triangles(self):
        """The surface as pyvista has it, read once."""
        import pyvista

        mesh = read(self.path, self.key)
        if "triangle" not in mesh.cells_dict:
            raise CaseError(f"{self.key} = {self.path!r} holds no triangles; a closed surface is made of them")
        points, faces = self.unit.placed(mesh.points), mesh.cells_dict["triangle"]
        faces = faces[facets.sizes(points[faces]) > 0.0]
        surface = pyvista.PolyData(points, np.insert(faces, 0, 3, axis=1).ravel()).clean()
        if surface.n_open_edges:
            raise CaseError(f"{self.key} = {self.path!r} has {surface.n_open_edges} open edges; it must be closed")
        nested.refuse_turned(surface, f"{self.key} = {self.path!r}")
        return surface

    def distance(self, points):
        import pyvista

        return np.asarray(pyvista.PolyData(points).compute_implicit_distance(self.triangles)["implicit_distance"])

    def shell(self, depth, spacing):
        """Lattice points between half a spacing less and half a spacing more than `depth` outside, moved onto it, and
        there to the middle of what is nearest to each, by a lattice of FINER to a spacing; where a plate is too thin
        for `depth` they stay between its faces."""
        if (depth, spacing) not in self.shells:
            self.shells[depth, spacing] = self._shell(depth, spacing)
        return self.shells[depth, spacing].copy()

    def _shell(self, depth, spacing):
        bounds, around = np.array(self.triangles.bounds).reshape(3, 2), depth + spacing
        points = grid([np.arange(low - around, high + around, spacing) for low, high in bounds])
        distance = self.distance(points)
        off = np.abs(distance - depth) / spacing
        ticks = ((np.arange(FINER) + 0.5) / FINER - 0.5) * spacing
        samples = (points[off <= 0.5 + math.sqrt(0.75)][:, None] + grid([ticks] * 3)).reshape(-1, 3)
        away = self.distance(samples)
        near = np.abs(away - depth) <= 0.5 * spacing
        own = self._onto(points[off <= 0.5], distance[off <= 0.5], depth)
        among = self._onto(samples[near], away[near], depth)
        middles = surface_points.middles(among, own)[0]
        return self._onto(middles, self.distance(middles), depth)

    def _onto(self, points, distance, depth):
        """Points at a distance (N,) [m] moved to where they are `depth` outside, those on the surface along its normal;
        but those stay that would come nearer to another side."""
        cells, closest = self.triangles.find_closest_cell(points, return_closest_point=True)
        away, distance = points - closest, distance.copy()
        on = np.abs(distance) <= SAME_PLACE * depth
        away[on], distance[on] = self.triangles.face_normals[cells[on]], 1.0
        moved = closest + away * (depth / distance)[:, None]
        there = np.abs(self.distance(moved) - depth) < ROUND_OFF * depth
        return np.where(there[:, None], moved, points)

    def thin(self, spacing):
        """Places (P, 3) [m] of the surface behind which it comes back within two spacings: a plate between two rooms is
        too thin there for wall particles half a spacing behind each of its faces, a spacing apart."""
        places, facing, *_ = facets.spread(self.triangles.points[self.triangles.regular_faces], spacing)
        behind = places + spacing * facing
        cells, closest = self.triangles.find_closest_cell(behind, return_closest_point=True)
        near = np.linalg.norm(behind - closest, axis=1) < (1.0 - ROUND_OFF) * spacing
        opposite = np.einsum("ij,ij->i", self.triangles.face_normals[cells], facing) < OPPOSITE
        return places[near & opposite]

    def surface(self):
        return self.triangles

    def furthest(self, direction):
        return float((self.triangles.points @ direction).max())

    @property
    def volume(self):
        return float(self.triangles.volume)


@dataclass(frozen=True)
class Joined:
    """A tank and the pipe at its bottom, in two dimensions a slot; the pipe counts as buffer, not as volume."""

    tank: object
    pipe: Cylinder | Box

    def distance(self, points):
        return np.minimum(self.tank.distance(points), self.pipe.distance(points))

    def shell(self, depth, spacing):
        return np.concatenate([self.tank.shell(depth, spacing), self.pipe.shell(depth, spacing)])

    def surface(self):
        return self.tank.surface() + self.pipe.surface()

    def furthest(self, direction):
        return max(self.tank.furthest(direction), self.pipe.furthest(direction))

    @property
    def volume(self):
        return self.tank.volume
