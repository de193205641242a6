"""Impulses on the gas in a window, each integrated where it acts: over boundary faces, or over cells.

The control volumes of the velocities along an axis fill the box. Their rims are the faces that momentum crosses: the
outer rim that of all of them, on the boundary, and the free rim that of those that are solved for. Between the two lie
the halves of cells at walls and inlets: what convection brings into them, the boundary holds by its pressure, besides
weight and particles, against which the pressure of its ghosts stands (`Pressure._lean`).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from coupling.embedded.boundaries import Faces
from coupling.embedded.box import Box, Flow, Window
from coupling.embedded.grid import Grid
from coupling.embedded.output import cell_velocity, pressure_gradient
from coupling.embedded.works import inside


class Rim(NamedTuple):
    """Faces (R,) of axis (R,), and sign (R,): 1 where what they let through upwards comes in."""

    axis: np.ndarray
    face: np.ndarray
    sign: np.ndarray

    def entered(self, through: np.ndarray) -> float:
        """Sum of what came in; through (d, S)."""
        return float(self.sign @ through[self.axis, self.face])


class Rims(NamedTuple):
    """Rims of the velocities along one axis: of all, of the free ones, and of those of them with a cell on both
    sides."""

    outer: Rim
    free: Rim
    whole: Rim


def rim_of(grid: Grid, members: np.ndarray) -> Rim:
    """The faces between control volumes that are members (S,) and others."""
    steps = np.stack([members * 1.0 - np.roll(members * 1.0, stride) for stride in grid.strides])
    axis, face = np.nonzero(steps)
    return Rim(axis, face, steps[axis, face])


def rims_of(grid: Grid, faces: Faces, axis: int, free: np.ndarray) -> Rims:
    """Rims of the velocities along `axis`; free (S,): those that are solved for."""
    every, own = free.copy(), faces.axis == axis
    every[faces.face[own]] = True
    room = grid.geometry.volume > 0.0
    whole = free & room & np.roll(room, grid.strides[axis])
    return Rims(*(rim_of(grid, members) for members in (every, free, whole)))


def crossed(rims: Rims, carried: np.ndarray, rubbed: np.ndarray, stress: np.ndarray) -> tuple[float, float, float]:
    """Momentum [kg m/s] that convection brought over the outer rim, what it brought into the halves of cells at walls
    and inlets, and what viscosity brought over the free rim.

    carried, rubbed (d, S): upwards, of convection and of implicit viscosity; stress (d, S): the rest of it, downwards.
    """
    came = rims.outer.entered(carried)
    return came, came - rims.free.entered(carried), rims.free.entered(rubbed) - rims.whole.entered(stress)


def impulses(box: Box, old: Flow, window: Window, flow: Flow, over: np.ndarray) -> np.ndarray:
    """(6, 3) [kg m/s] of `coupling.gas.IMPULSES` in a window; over (3, d), see `crossed`."""
    cells, dt, d = box.grid.cells, window.dt, box.grid.dimensions
    came, stopped, rubbed = over
    velocity, room = cell_velocity(box, flow)[:, :d], (1.0 - flow.alpha[cells]) * box.grid.geometry.volume[cells]
    pressed = dt * on_boundary(box, flow.pressure) + held(box, flow) - held(box, old) - stopped
    weight = dt * flow.mass[cells].sum() * np.array(box.gravity)
    given = dt * (window.push[:, cells].sum(axis=1) - (window.pull - window.vapour)[cells] @ velocity)
    leant = dt * (room @ pressure_gradient(box, flow)[:, :d])
    found = np.zeros((6, 3))
    found[:, :d] = came, pressed, rubbed, weight, given, leant
    return found


def on_boundary(box: Box, pressure: np.ndarray) -> np.ndarray:
    """(d,) [N] of the pressure (S,) on the boundary faces, in their ghosts: -p S."""
    faces = box.faces
    force = -faces.sign * box.grid.geometry.area[faces.axis, faces.face] * pressure[faces.ghost]
    return np.bincount(faces.axis, weights=force, minlength=box.grid.dimensions)


def held(box: Box, flow: Flow) -> np.ndarray:
    """(d,) [kg m/s] of the halves of cells at walls and inlets, whose velocity the boundary gives."""
    faces = box.faces
    fixed = ~faces.open
    axis, face, cell = faces.axis[fixed], faces.face[fixed], faces.cell[fixed]
    own = 0.5 * flow.mass[cell] * inside(box, flow)[axis, face]
    return np.bincount(axis, weights=own, minlength=box.grid.dimensions)
