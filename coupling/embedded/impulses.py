"""Impulses on the gas in a window, each integrated where it acts: over boundary faces, or over cells.

The control volumes of the velocities along an axis fill the box. Their rims are the faces that momentum crosses: the
outer rim that of all of them, on the boundary, and the free rim that of those that are solved for. Between the two lie
the halves of cells at walls and inlets: what convection brings into them, the boundary holds by its pressure, besides
weight and particles, against which the pressure of its ghosts stands (`Pressure._lean`).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy import sparse

from coupling.embedded.boundaries import Faces
from coupling.embedded.box import Box, Flow, Window
from coupling.embedded.grid import Grid
from coupling.embedded.output import cell_velocity, pressure_gradient
from coupling.embedded.works import inside


class Rim(NamedTuple):
    """Faces (R,) of axis (R,), and sign (R,): 1 where what they let through upwards comes in; `share` (B, R) by which
    they are of each boundary face."""

    axis: np.ndarray
    face: np.ndarray
    sign: np.ndarray
    share: sparse.csr_array

    def entered(self, through: np.ndarray) -> np.ndarray:
        """(B,) what came in by the boundary faces that are near; through (d, S)."""
        return self.share @ (self.sign * through[self.axis, self.face])


class Rims(NamedTuple):
    """Rims of the velocities along one axis: of all, of the free ones, and of those of them with a cell on both
    sides."""

    outer: Rim
    free: Rim
    whole: Rim


def rim_of(grid: Grid, faces: Faces, along: int, members: np.ndarray) -> Rim:
    """The faces between control volumes of the velocities along an axis that are members (S,) and others.

    A face on the boundary is of the boundary faces that it covers, by their areas; one within, beside a half of a cell
    at a wall or inlet, is of the boundary face that this half stands at.
    """
    steps = np.stack([members * 1.0 - np.roll(members * 1.0, stride) for stride in grid.strides])
    axis, face = np.nonzero(steps)
    number, stride = np.full(steps.shape, -1), np.array(grid.strides)[axis]
    number[faces.axis, faces.face] = np.arange(len(faces.face))
    covered = np.stack([number[axis, face], number[axis, face - grid.strides[along]]])
    covered[:, axis == along] = -1
    ends = np.where(members[face], (face - stride, face), (face, face - stride))  # what is no member comes first
    beside = number[along, ends]
    alone = (covered < 0).all(axis=0)
    covered[0, alone] = np.where(beside[0] >= 0, *beside)[alone]
    area = grid.geometry.area[faces.axis, faces.face][covered] * (covered >= 0)
    rows, columns = covered.ravel(), np.tile(np.arange(len(face)), 2)
    given, shape = (area / area.sum(axis=0)).ravel(), (len(faces.face), len(face))
    return Rim(
        axis, face, steps[axis, face],
        sparse.csr_array((given[rows >= 0], (rows[rows >= 0], columns[rows >= 0])), shape=shape),
    )  # fmt: skip


def rims_of(grid: Grid, faces: Faces, axis: int, free: np.ndarray) -> Rims:
    """Rims of the velocities along `axis`; free (S,): those that are solved for."""
    every, own = free.copy(), faces.axis == axis
    every[faces.face[own]] = True
    room = grid.geometry.volume > 0.0
    whole = free & room & np.roll(room, grid.strides[axis])
    return Rims(*(rim_of(grid, faces, axis, members) for members in (every, free, whole)))


def crossed(rims: Rims, carried: np.ndarray, rubbed: np.ndarray, stress: np.ndarray) -> tuple[np.ndarray, ...]:
    """Momentum [kg m/s] by boundary faces (B,): what convection brought over the outer rim, what it brought into the
    halves of cells at walls and inlets, and what viscosity brought over the free rim.

    carried, rubbed (d, S): upwards, of convection and of implicit viscosity; stress (d, S): the rest of it, downwards.
    """
    came = rims.outer.entered(carried)
    return came, came - rims.free.entered(carried), rims.free.entered(rubbed) - rims.whole.entered(stress)


def on_faces(box: Box, old: Flow, window: Window, flow: Flow, over) -> tuple[np.ndarray, np.ndarray]:
    """(d, B) [kg m/s] of the pressure on each boundary face in a window, and of the viscous stress; `over` (3, d, B),
    see `crossed`."""
    _, stopped, rubbed = over
    faces, pressed = box.faces, -stopped
    area = box.grid.geometry.area[faces.axis, faces.face]
    own = held(box, flow) - held(box, old) - window.dt * faces.sign * area * flow.pressure[faces.ghost]
    pressed[faces.axis, np.arange(len(own))] += own
    return pressed, rubbed


def impulses(box: Box, window: Window, flow: Flow, came, pressed, rubbed) -> np.ndarray:
    """(6, 3) [kg m/s] of `coupling.gas.IMPULSES` in a window; came, pressed, rubbed (d, B), see `crossed` and
    `on_faces`."""
    cells, dt, d = box.grid.cells, window.dt, box.grid.dimensions
    velocity, room = cell_velocity(box, flow)[:, :d], (1.0 - flow.alpha[cells]) * box.grid.geometry.volume[cells]
    weight = dt * flow.mass[cells].sum() * np.array(box.gravity)
    given = dt * (window.push[:, cells].sum(axis=1) - (window.pull - window.mass)[cells] @ velocity)
    leant = dt * (room @ pressure_gradient(box, flow)[:, :d])
    found = np.zeros((6, 3))
    found[:, :d] = *(part.sum(axis=1) for part in (came, pressed, rubbed)), weight, given, leant
    return found


def of_patches(box: Box, pressed: np.ndarray, rubbed: np.ndarray) -> np.ndarray:
    """(P, 3, 3) [kg m/s], [kg m2/s] of each boundary: see `coupling.gas.Budget.patches`."""
    in_space = np.zeros((4, len(box.faces.face), 3))
    d = box.grid.dimensions
    in_space[0, :, :d], in_space[1, :, :d], in_space[3, :, :d] = pressed.T, rubbed.T, box.faces.middle
    in_space[2] = np.cross(in_space[3], in_space[0] + in_space[1])
    found = np.zeros((len(box.names), 3, 3))
    for kind in range(3):
        np.add.at(found[:, kind], box.faces.owner, in_space[kind])
    return found


def held(box: Box, flow: Flow) -> np.ndarray:
    """(B,) [kg m/s] of the half of a cell at each boundary face whose velocity the boundary gives; 0 at others."""
    faces = box.faces
    own = 0.5 * flow.mass[faces.cell] * inside(box, flow)[faces.axis, faces.face]
    return np.where(faces.open, 0.0, own)
