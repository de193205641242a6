"""From the boundaries of a case to values on the boundary faces of the grid.

A fixed value holds on the boundary itself: the ghost carries it, half a cell from the first centre, and `hold`
(1: held, 0: free) multiplies the conductance between the two. Elsewhere the ghost copies its neighbour.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from coupling.embedded.grid import Grid, indices
from sdph.case import inlet_profiles, inlets
from sdph.case.gas_cells import nearest_edge
from sdph.engine.geometry import SIDES
from sdph.schema import CaseError

# kind -> whether the gas passes freely, and whether it clings (takes the tangential velocity of the boundary)
KINDS = {
    "wall": (False, True),
    "slip_wall": (False, False),
    "velocity_inlet": (False, True),
    "pressure_outlet": (True, False),
}


@dataclass(frozen=True)
class Faces:
    """The boundary faces, (B,) each: padded indices of face, inner cell and ghost; axis; outward sign;
    `open` and `held` temperature, vapour (bool); and what the boundary says there: velocity (B, d) [m/s],
    temperature [K], vapour mass fraction, pressure [Pa]; the number of the boundary among those of the case, and the
    middle of the face (B, d) [m]."""

    owner: np.ndarray
    middle: np.ndarray
    face: np.ndarray
    cell: np.ndarray
    ghost: np.ndarray
    axis: np.ndarray
    sign: np.ndarray
    open: np.ndarray
    clings: np.ndarray
    inlet: np.ndarray
    held: np.ndarray
    velocity: np.ndarray
    temperature: np.ndarray
    vapour: np.ndarray
    pressure: np.ndarray


def boundary_faces(case, grid: Grid) -> Faces:
    """All boundary faces of `grid`, each with what the case says of it."""
    parts = [_side(case, grid, axis, upper) for axis in range(grid.dimensions) for upper in (0, 1)]
    return Faces(**{name: np.concatenate([part[name] for part in parts]) for name in parts[0]})


def blown(case, faces: Faces, begin: float, end: float) -> Faces:
    """The faces with the velocities of inlets that change in time as they are in the mean from `begin` to `end` [s]."""
    velocity = faces.velocity.copy()
    for number, boundary in enumerate(case.boundaries.values()):
        if boundary.velocities:
            velocity[faces.owner == number] = inlets.mean(boundary, begin, end)
    return replace(faces, velocity=velocity)


def _side(case, grid: Grid, axis: int, upper: int) -> dict[str, np.ndarray]:
    """The fields of `Faces` on one side."""
    first = [0] * grid.dimensions
    last = list(grid.counts)
    first[axis] = grid.counts[axis] - 1 if upper else 0
    last[axis] = first[axis] + 1
    cell = indices(grid.counts, tuple(first), tuple(last))
    owner = _owners(case, grid, axis, upper, cell)
    rows = [_row(case, name) for name in case.boundaries]
    step = grid.strides[axis] * (1 if upper else -1)
    each = {key: np.array([row[key] for row in rows])[owner] for key in rows[0]}
    place = np.zeros((grid.size, grid.dimensions))
    place[grid.cells] = grid.centres
    middle = place[cell]
    middle[:, axis] = grid.edges[axis][-1 if upper else 0]
    for number, boundary in enumerate(case.boundaries.values()):
        if boundary.profile != "uniform":
            mine = owner == number
            each["velocity"][mine] *= inlet_profiles.over_mean(case, boundary, middle[mine, 1 - axis])[:, None]
    return each | {
        "owner": owner, "middle": middle,
        "face": cell + grid.strides[axis] * upper, "cell": cell, "ghost": cell + step,
        "axis": np.full(len(cell), axis), "sign": np.full(len(cell), 2.0 * upper - 1.0),
    }  # fmt: skip


def _row(case, name: str) -> dict:
    """Values of one boundary, with what it leaves out taken from the gas of the case."""
    boundary = case.boundaries[name]
    if boundary.kind not in KINDS:
        raise CaseError(f"boundaries.{name}.kind = {boundary.kind!r}; the embedded gas solver knows {', '.join(KINDS)}")
    passes, clings = KINDS[boundary.kind]
    inlet = boundary.kind == "velocity_inlet"
    if inlet and boundary.strongest is None:
        raise CaseError(f"boundaries.{name}.velocity_m_s is missing; a velocity_inlet needs it, or velocities")
    if boundary.vapour_mass_fraction and case.vapour is None:
        key = f"boundaries.{name}.vapour_mass_fraction"
        raise CaseError(f"{key} is given, but the case has no [vapour]; add it or remove the key")
    return {
        "open": passes, "clings": clings, "inlet": inlet,
        "held": inlet or (not passes and boundary.temperature is not None),
        "velocity": inlets.at(boundary, 0.0) if boundary.strongest else (0.0,) * case.dimensions,
        "temperature": boundary.temperature or case.gas.temperature,
        "vapour": case.vapour_through(boundary), "pressure": boundary.pressure or 0.0,
    }  # fmt: skip


def _owners(case, grid: Grid, axis: int, upper: int, cell: np.ndarray) -> np.ndarray:
    """(faces,) which boundary owns each face of a side: a span before a whole side before what is left over."""
    owner = np.full(len(cell), -1)
    rank = np.zeros(len(cell), dtype=int)
    for number, (name, boundary) in enumerate(case.boundaries.items()):
        there = list(SIDES)[: 2 * grid.dimensions]
        if boundary.side is not None and boundary.side not in there:
            what = f"a case of {grid.dimensions} dimensions has {', '.join(there)}"
            raise CaseError(f"boundaries.{name}.side = {boundary.side!r}; {what}")
        if boundary.side is not None and SIDES[boundary.side] != (axis, upper):
            continue
        mine = np.ones(len(cell), dtype=bool) if boundary.span is None else _inside(grid, axis, boundary.span, name)
        level = 1 if boundary.side is None else 2 if boundary.span is None else 3
        if np.any(mine & (rank == level)):
            raise CaseError(
                f"boundaries.{name} covers faces that another boundary covers too; give them separate spans"
            )
        mine &= rank < level
        owner[mine], rank[mine] = number, level
    if np.any(owner < 0):
        side = next(name for name, where in SIDES.items() if where == (axis, upper))
        raise CaseError(
            f"no boundary covers all of the {side} side; give one, or one without a side for all that is left over"
        )
    return owner


def _inside(grid: Grid, axis: int, span: tuple, name: str) -> np.ndarray:
    """(faces,) bool: the faces of a side within `span` [m], whose ends must be cell edges."""
    tangential = [b for b in range(grid.dimensions) if b != axis]
    pairs = span if isinstance(span[0], (tuple, list)) else (span,)
    if len(pairs) != len(tangential):
        raise CaseError(
            f"boundaries.{name}.span_m has {len(pairs)} ranges [low, high]; a side here has {len(tangential)}"
        )
    inside = np.ones(1, dtype=bool)
    for b, (low, high) in zip(tangential, pairs):
        edges = grid.edges[b]
        first, last = (nearest_edge(edges, end, f"boundaries.{name}.span_m") for end in (low, high))
        along = np.arange(len(edges) - 1)
        inside = (((along >= first) & (along < last))[:, None] & inside[None, :]).ravel()
    return inside


class Ghosts(NamedTuple):
    """Rule for the ghosts of one field: ghost <- value where pinned, else the field at node."""

    ghost: np.ndarray
    node: np.ndarray
    pinned: np.ndarray
    value: np.ndarray


def on_faces(grid: Grid, faces: Faces, values: np.ndarray, inside: float) -> np.ndarray:
    """(d, S) field of faces: `inside`, but `values` (B,) on the boundary."""
    field = np.full((grid.dimensions, grid.size), inside)
    field[faces.axis, faces.face] = values
    return field


def component_ghosts(grid: Grid, faces: Faces, axis: int) -> Ghosts:
    """Ghosts of the velocity along `axis`: beside the walls the tangential velocity of what clings, beyond an
    opening the velocity of the opening. At the ends of a span two half faces share a node."""
    along = grid.strides[axis]
    beside = faces.axis != axis
    weight = on_faces(grid, faces, faces.clings * 1.0, 0.0) * grid.geometry.area
    moving = on_faces(grid, faces, faces.clings * faces.velocity[:, axis], 0.0) * grid.geometry.area
    ghost, node, pinned, value = [], [], [], []
    for shift in (0, along):  # a face has a node of this component at its lower and at its upper end
        face, b = faces.face[beside] + shift, faces.axis[beside]
        total = weight[b, face] + weight[b, face - along]
        ghost.append(faces.ghost[beside] + shift)
        node.append(faces.cell[beside] + shift)
        pinned.append(total > 0.0)
        value.append(
            np.divide(moving[b, face] + moving[b, face - along], total, out=np.zeros(len(total)), where=total > 0.0)
        )
    own = ~beside
    ghost.append(faces.face[own] + (along * faces.sign[own]).astype(np.int64))
    node.append(faces.face[own])
    pinned.append(np.zeros(own.sum(), dtype=bool))
    value.append(np.zeros(own.sum()))
    return Ghosts(*(np.concatenate(part) for part in (ghost, node, pinned, value)))


def active_nodes(grid: Grid, faces: Faces) -> np.ndarray:
    """(d, S) bool: the faces whose velocity is solved for: those inside, and those that are open."""
    active = np.zeros((grid.dimensions, grid.size), dtype=bool)
    for axis, count in enumerate(grid.counts):
        lower = tuple(1 if a == axis else 0 for a in range(grid.dimensions))
        if count > 1:
            active[axis, indices(grid.counts, lower, grid.counts)] = True
    active[faces.axis[faces.open], faces.face[faces.open]] = True
    return active


def resting_pressure(faces: Faces, grid: Grid, gravity, density: float) -> tuple[np.ndarray, np.ndarray]:
    """Pressure [Pa] of gas of `density` [kg/m3] at rest: on the boundary faces (B,) and in the cells (C,).

    The given pressure of an opening holds at the centre of all openings, so that openings at different heights drive
    no flow by themselves; a closed box has zero mean.
    """
    outside, inside = faces.middle @ np.asarray(gravity), grid.centres @ np.asarray(gravity)
    if not faces.open.any():
        return density * (outside - inside.mean()), density * (inside - inside.mean())
    area = grid.geometry.area[faces.axis, faces.face] * faces.open
    level, given = (np.average(values, weights=area) for values in (outside, faces.pressure))
    return np.where(faces.open, faces.pressure, given) + density * (outside - level), given + density * (inside - level)
