"""The tank that holds a liquid: its shape, its outlet, and how its walls act (Adami, Hu & Adams 2012)."""

from __future__ import annotations

import functools
import math
import os
from typing import NamedTuple

import numpy as np

from sdph.effects.effect import Effect, Judgement
from sdph.engine import surface
from sdph.engine.geometry import SIDES
from sdph.engine.walls import shapes
from sdph.engine.walls.outline import outline
from sdph.engine.world import ALONE
from sdph.laws.constants import ROUND_OFF
from sdph.schema import CaseError, choice, file, quantity, record, vector, words

ALL = "tank"  # name of all walls of a tank in `run.forces`


@record
class Tank:
    """`open_sides` of a box, or of an outline where it has a side there, have no wall. The outlet is a pipe at the
    lowest point, as full at the start as the tank is; of a box it is in the floor, in two dimensions a slot."""

    shape: str = choice("box", "sphere", "cylinder", "capsule", "mesh", "outline")
    lower: tuple | None = vector("m", None)  # of a box; None: the domain
    upper: tuple | None = vector("m", None)
    centre: tuple | None = vector("m", None)
    radius: float | None = quantity("m", None, above=0.0)
    length: float = quantity("m", 0.0, least=0.0)  # of the cylinder, or of the capsule's straight part
    corners: tuple | None = vector("m", None)  # of an outline, one after the other
    mesh: str = file()
    mesh_scale: float = quantity("", 1.0, above=0.0)  # metres of a unit of `mesh`: 0.001 where it is in millimetres
    mesh_offset: tuple | None = vector("m", None)  # by which it is moved, after that
    open_sides: tuple = words(())
    slip: str = choice("no_slip", "free_slip")
    # whether a wall can pull, with a pressure below 0; None: full between two phases, where walls mirror the pressure
    suction: str | None = choice("none", "full", default=None)
    outlet_radius: float = quantity("m", 0.0, least=0.0)
    outlet_length: float = quantity("m", 0.0, least=0.0)
    outlet_centre: tuple | None = vector("m", None)  # of a box, in its floor; None: the middle of it


class TankP(NamedTuple):
    """1 for no slip, 0 for free slip; least pressure of a wall [Pa]; inverse of the distance from a wall particle at
    which it begins to hold liquid off [1/m]; c^2 [m2/s2]."""

    stick: float
    least: float
    near: float
    stiffness: float


def kernel(case) -> TankP:
    own = case.parameters["tank"]
    if case.gas_phase is not None and own.suction == "none":
        why = "between two phases walls mirror the pressure in front and pull"
        raise CaseError(f"tank.suction = 'none'; {why}: set tank.suction = \"full\", or leave it out")
    least = -math.inf if own.suction == "full" or case.gas_phase is not None else 0.0
    return acts(case, float(own.slip == "no_slip"), least)


def acts(case, stick: float, least: float) -> TankP:
    """Walls of particles of the case's spacing; `stick` and `least` as there."""
    # of the surface, no place is further from the wall's lattice
    near = 0.5 * math.sqrt(case.dimensions) * case.resolution.spacing
    return TankP(stick, least, 1.0 / near, case.fastest_sound**2)


def shape_of(case):
    """The shape (sdph.engine.walls.shapes) of a case's tank."""
    own, d = case.parameters["tank"], case.dimensions
    if case.liquid and any(case.liquid_period) and own.shape not in ("box", "outline"):
        given = f"tank.shape = {own.shape!r} is closed, and liquid.periodic = {list(case.liquid.periodic)} goes on"
        raise CaseError(f"{given} beyond it: give a box or an outline, or leave liquid.periodic out")
    if own.outlet_radius:
        _refuse_outlet(case, own)
    if own.shape == "box":
        return _with_outlet_in_floor(case, own, _box(case, own))
    if own.shape == "outline":
        return _outline(case, own)
    if d == 2 and own.shape != "sphere":
        raise CaseError(
            f"tank.shape = {own.shape!r} needs dimensions = 3; in 2-D there are box, sphere (a disc) and outline"
        )
    if own.open_sides:
        given = f"tank.open_sides = {list(own.open_sides)}, but tank.shape = {own.shape!r} is closed all around"
        raise CaseError(f"{given}; only a box and an outline have open sides: leave it out, or give one of these")
    if own.shape == "mesh":
        return _mesh(case, own.mesh, surface.unit(own))
    if own.centre is None or own.radius is None or len(own.centre) != d:
        raise CaseError(f"tank: a {own.shape} needs centre_m with {d} components, and radius_m")
    centre = np.array(own.centre)
    if d == 2:
        return shapes.Disc(centre, own.radius)
    reach = layers(case) * case.resolution.spacing
    if own.shape == "cylinder":
        if not own.length:
            raise CaseError("tank.length_m is missing; a cylinder needs it")
        tank = shapes.Cylinder(centre, own.radius, own.length, reach)
        bottom = centre[2] - 0.5 * own.length
    else:
        tank = shapes.Capsule(centre, own.radius, own.length if own.shape == "capsule" else 0.0)
        bottom = centre[2] - own.radius - 0.5 * tank.length
    return _with_outlet(own, tank, bottom, reach)


def refuse_outside(case, name: str, points, world=ALONE) -> None:
    """CaseError where particles of a pool at points (N, d) [m] would stand outside the tank: nothing holds them there,
    and no picture shows them."""
    beyond = shape_of(case).distance(points) if "tank" in case.effects else np.zeros(0)
    if outside := world.sum(int((beyond > ROUND_OFF * case.resolution.spacing).sum())):
        count, furthest = world.sum(len(points)), world.most(float(beyond.max(initial=0.0)))
        around = f', or fill the tank around what stands in it: pools.{name}.shape = "tank" with fill'
        raise CaseError(
            f"pools.{name}: {outside} of its {count} particles would stand outside the tank, up to "
            f"{furthest:.3g} m from it; move the pool, or make it smaller{'' if case.incompressible else around}"
        )


@functools.lru_cache(maxsize=4)
def _of_file(path: str, changed: float, unit: surface.Unit, domain: tuple, spacing: float):
    """The mesh of a file as it is since `changed` [s], and where its walls are too thin for a spacing [m]."""
    shape = shapes.Mesh(path, unit=unit)
    surface.refuse_size("tank.mesh", path, shape.triangles.points, domain, spacing)
    return shape, shape.thin(spacing)


def _mesh(case, path: str, unit: surface.Unit):
    spacing = case.resolution.spacing
    changed = os.path.getmtime(path) if os.path.exists(path) else 0.0
    shape, thin = _of_file(path, changed, unit, case.domain.size, spacing)
    _refuse_thin("tank.mesh", thin, spacing)
    return shape


def _outline(case, own):
    if case.dimensions != 2 or own.corners is None:
        raise CaseError("tank.shape = 'outline' is of 2-D cases and needs tank.corners_m; in 3-D give a mesh")
    ends, spacing = _open_ends(case, own), case.resolution.spacing
    open_at = [(axis, (case.domain.corner, case.domain.upper)[end][axis]) for axis, end in sorted(ends)]
    shape = outline("tank.corners_m", own.corners, open_at)
    if not all(shape.lies_at(*at).any() for at in open_at):
        raise CaseError(
            f"tank.open_sides = {list(own.open_sides)}: each needs a side of tank.corners_m that lies in that side of "
            "the domain; move the corners there, or leave the side out"
        )
    _refuse_thin("tank.corners_m", shape.thin(spacing), spacing)
    return shape


def _refuse_thin(key: str, thin, spacing: float) -> None:
    """CaseError at the first of the places `thin` (P, d) [m] where a wall is thinner than two spacings."""
    if len(thin):
        where = ", ".join(f"{x:.4g}" for x in thin[0])
        raise CaseError(
            f"{key}: the wall at ({where}) m is thinner than two spacings, {2e3 * spacing:g} mm, which hold liquid on "
            "both of its sides; lower resolution.spacing_mm or make the wall thicker"
        )


def _refuse_outlet(case, own) -> None:
    """CaseError where there can be no outlet pipe as it is given."""
    given, box = f"tank.outlet_radius_m = {own.outlet_radius:g}", own.shape == "box"
    if own.shape == "mesh":
        raise CaseError(f"{given}; a mesh has its pipe in its file, closed at the end: give 0 here")
    if case.dimensions == 2 and not box:
        raise CaseError(f"{given}; in 2-D a box has an outlet, a disc none, an outline by tank.corners_m alone: give 0")
    if not box and own.outlet_radius >= (own.radius or math.inf):
        raise CaseError(f"{given}; an outlet is narrower than its tank, {own.radius:g} m")
    if own.outlet_radius < 0.5 * case.resolution.spacing:
        raise CaseError(f"{given}; a pipe is a particle wide at least: half of resolution.spacing_mm, or 0 for none")
    if own.outlet_length < case.resolution.spacing:
        raise CaseError(f"tank.outlet_length_m = {own.outlet_length:g}; a pipe is a spacing long at least: lengthen it")
    if own.outlet_centre and not box:
        raise CaseError("tank.outlet_centre_m is given; a round tank has its outlet in the middle: leave it out")


def _with_outlet_in_floor(case, own, box):
    """A box with an outlet in its floor: a round pipe, in two dimensions a slot."""
    if not own.outlet_radius:
        return box
    across, d, radius = slice(0, case.dimensions - 1), case.dimensions, own.outlet_radius
    middle = 0.5 * (box.lower + box.upper)[across] if own.outlet_centre is None else np.array(own.outlet_centre)
    if middle.shape != (d - 1,):
        raise CaseError(
            f"tank.outlet_centre_m = {list(own.outlet_centre)}; it is a place in the floor: give {d - 1} numbers"
        )
    if (
        (d - 1, 0) in box.open
        or (middle - radius < box.lower[across]).any()
        or (middle + radius > box.upper[across]).any()
    ):
        raise CaseError(
            f"tank.outlet_radius_m = {radius:g} about tank.outlet_centre_m = {middle.tolist()}; an outlet lies within "
            "the floor, which is a wall: move it, or make it narrower"
        )
    floor, reach = box.lower[-1], layers(case) * case.resolution.spacing
    if d == 2:
        corner = np.array([middle[0] - radius, floor - own.outlet_length])
        return shapes.Joined(box, shapes.Box(corner, np.array([middle[0] + radius, floor]), ((1, 1),)))
    centre = np.array([*middle, floor - 0.5 * own.outlet_length])
    return shapes.Joined(box, shapes.Cylinder(centre, radius, own.outlet_length, reach, open_top=True))


def _with_outlet(own, tank, bottom: float, reach: float):
    """The tank with its pipe, which reaches up into the tank by as much as the bottom is curved."""
    if not own.outlet_radius:
        return tank
    inside = own.radius - math.sqrt(own.radius**2 - own.outlet_radius**2) if own.shape != "cylinder" else 0.0
    middle = np.array([*tank.centre[:2], bottom + 0.5 * (inside - own.outlet_length)])
    pipe = shapes.Cylinder(middle, own.outlet_radius, own.outlet_length + inside, reach, open_top=True)
    return shapes.Joined(tank, pipe)


def corners(case) -> tuple[tuple, tuple]:
    """Lower and upper corner (d,) [m] of a case's box tank."""
    own = case.parameters["tank"]
    return own.lower or case.domain.corner, own.upper or case.domain.upper


def _box(case, own):
    lower, upper = corners(case)
    given = f"tank: from lower_m = {list(lower)} to upper_m = {list(upper)}"
    if any(high <= low for low, high in zip(lower, upper)):
        raise CaseError(f"{given}; upper_m must lie above lower_m along every axis, as one of the domain does")
    if any(high - low < case.resolution.spacing * (1.0 - 1e-9) for low, high in zip(lower, upper)):
        raise CaseError(f"{given} it is narrower than resolution.spacing_mm along an axis; widen it")
    return shapes.Box(np.array(lower), np.array(upper), tuple(_open_ends(case, own)))


def names(case) -> list[str]:
    """Names of walls that `run.forces` may hold: sides of a box that have one, `tank` for all but the outlet pipe's,
    the parts of the case."""
    return [*sides(case), ALL, *case.parts] if "tank" in case.parameters else []


def sides(case) -> list[str]:
    """Names of the sides of a box tank that have a wall; none of other shapes."""
    own = case.parameters["tank"]
    open_ends = _open_ends(case, own) if own.shape == "box" else set(SIDES.values())
    return [side for side, (axis, end) in SIDES.items() if axis < case.dimensions and (axis, end) not in open_ends]


def _open_ends(case, own) -> set[tuple[int, int]]:
    """(axis, end) of the sides of a box, or of an outline in its domain, that have no wall."""
    periodic = case.liquid.periodic or (0,) * case.dimensions
    sides = [own.open_sides] if isinstance(own.open_sides, str) else own.open_sides
    for side in sides:
        if side not in SIDES:
            raise CaseError(f"tank.open_sides holds {side!r}; allowed: {', '.join(SIDES)}")
    return {SIDES[side] for side in sides} | {(a, end) for a, on in enumerate(periodic) if on for end in (0, 1)}


def layers(case) -> int:
    """Layers that fill the support of the kernel."""
    return math.ceil(2.0 * case.resolution.smoothing_ratio - 1e-9)


def call(scales) -> Judgement:
    """Way of the liquid within the run when nothing holds it, or along a channel the depth of the walls' friction, over
    its width."""
    across, along = scales.pull
    way = 0.5 * (across + scales.shaken) * scales.end**2 / scales.length
    reach = max(way, scales.layer if along else 0.0)
    return Judgement("way of the liquid within the run / its width", reach, 0.01, "geometry", min(1.0, reach))


EFFECT = Effect(
    name="tank",
    summary="walls of a tank for a liquid",
    parameters=Tank,
    kernel=kernel,
    moves=True,
    matter=("liquid",),
    call=call,
)
