"""Kinetic energy of the gas and the work of forces on it, face by face, where the momentum equation holds.

Half of a cell moves with each of its two faces along an axis (see momentum.py). With the mean of the velocities before
and after a window the work of all forces is what the kinetic energy of a face changes by, to round-off.
"""

from __future__ import annotations

import numpy as np

from coupling.embedded.box import Box, Flow, Window


def inside(box: Box, flow: Flow) -> np.ndarray:
    """(d, S) velocity of the faces [m/s], at an inlet just inside, where the gas has the room of the cell."""
    grid, faces, velocity = box.grid, box.faces, flow.velocity.copy()
    fixed = ~faces.open
    axis, face, cell = faces.axis[fixed], faces.face[fixed], faces.cell[fixed]
    velocity[axis, face] = (
        flow.flux[axis, face] * grid.geometry.volume[cell] / (flow.mass[cell] * grid.geometry.area[axis, face])
    )
    return velocity


def on_both_faces(box: Box, of_face) -> np.ndarray:
    """(C,) sum over the faces of each cell of half of `of_face` (axis, faces (C,)) -> (C,)."""
    cells = box.grid.cells
    pairs = enumerate(box.grid.strides)
    return sum(0.5 * (of_face(a, cells) + of_face(a, cells + s)) for a, s in pairs)


def kinetic_energy(box: Box, flow: Flow) -> float:
    """Sum of m u^2/2 [J]."""
    velocity = inside(box, flow)
    return float(0.5 * flow.mass[box.grid.cells] @ on_both_faces(box, lambda a, face: velocity[a, face] ** 2))


def power(box: Box, old: Flow, window: Window, flow: Flow) -> np.ndarray:
    """(C,) [W] of the forces that the particles gave in a window."""
    cells, given = box.grid.cells, _given(box, old, window, flow)
    return on_both_faces(box, lambda a, face: given(a, face, cells))


def pressure_work(box: Box, old: Flow, window: Window, flow: Flow) -> tuple[np.ndarray, np.ndarray]:
    """alpha u.grad p V dt (C,) [J] of a window that the enthalpy gets from the motion, and what the motion got from the
    pressure without the enthalpy paying for it: it comes from the boundary.

    Without sound the pressure passes on at once what accelerates the gas: no enthalpy on the way pays for that. Gas
    whose density follows its temperature pays for what its particles resist with alone: any more is of the order of
    u^2/c_p, and where vapour appears at once u has no bound. Of a face's part each half takes first what its own
    particles resist with, as the momentum of the halves asks for where drag jumps from cell to cell; the rest is shared
    by the room of the gas.
    """
    grid, p, gap, room = box.grid, flow.pressure, box.grid.geometry.gap, flow.alpha * box.grid.geometry.volume
    before, after, given = inside(box, old), inside(box, flow), _given(box, old, window, flow)

    def rest(a, face):
        low, high = face - grid.strides[a], face
        both = room[low] + room[high]
        work = both * 0.5 * (before[a, face] + after[a, face]) * (p[high] - p[low]) / gap[a, face]
        return (work - given(a, face, low) - given(a, face, high)) * room[grid.cells] / both

    resisted = window.dt * on_both_faces(box, lambda a, face: given(a, face, grid.cells))
    other = window.dt * on_both_faces(box, rest)
    if box.properties.varies:
        return resisted, -other
    faster = on_both_faces(box, lambda a, face: 0.5 * (after[a, face] ** 2 - before[a, face] ** 2))
    faster *= flow.mass[grid.cells]
    return resisted + other + faster, faster


def _given(box: Box, old: Flow, window: Window, flow: Flow):
    """Function (axis, faces, cells) -> power [W] of what the particles in these cells give the gas on these faces; that
    new mass takes the velocity of the gas is no part of it."""
    after = inside(box, flow)
    mean = 0.5 * (inside(box, old) + after)
    push, pull = window.push, window.pull - window.mass
    return lambda a, face, cell: (push[a, cell] - pull[cell] * after[a, face]) * mean[a, face]


def viscous_work(box: Box, old: Flow, flow: Flow, rubbed: np.ndarray) -> float:
    """Work [J] of the viscous stress in a window, by its impulses (d, S) [kg m/s] on the faces that move freely."""
    return float((rubbed * 0.5 * (inside(box, old) + inside(box, flow))).sum())


def through_motion(box: Box, old: Flow, flow: Flow, dt: float) -> tuple[float, float]:
    """Kinetic energy that came in through the boundary in a window of dt [s], and the work of gravity in it [J]."""
    cells, faces, after, gravity = box.grid.cells, box.faces, inside(box, flow), box.gravity
    outward = box.outward(flow.flux)
    squared = after[faces.axis, faces.face] ** 2 + _along(box, after, outward < 0.0)
    came = -dt * float((outward * 0.5 * squared).sum())
    mean = 0.5 * (inside(box, old) + after)
    return came, dt * float(flow.mass[cells] @ on_both_faces(box, lambda a, face: gravity[a] * mean[a, face]))


def _along(box: Box, velocity: np.ndarray, enters: np.ndarray) -> np.ndarray:
    """(B,) [m2/s2] square of the velocity along each boundary face that gas takes through it: that of the boundary
    where it `enters` through one that clings, else that of the cell."""
    faces, found = box.faces, np.zeros(len(box.faces.cell))
    for b, step in enumerate(box.grid.strides):
        own = 0.5 * (velocity[b, faces.cell] ** 2 + velocity[b, faces.cell + step] ** 2)
        given = np.where(enters & faces.clings, faces.velocity[:, b] ** 2, own)
        found += np.where(faces.axis == b, 0.0, given)
    return found
