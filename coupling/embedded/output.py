"""Output of the solver: cell fields and the budget."""

from __future__ import annotations

import itertools

import numpy as np

from coupling.embedded.boundaries import component_ghosts
from coupling.embedded.box import Box, Flow
from coupling.embedded.linear import fill
from coupling.embedded.works import inside, kinetic_energy
from coupling.gas import IMPULSES, Budget


def cell_velocity(box: Box, flow: Flow) -> np.ndarray:
    """(C, 3) mean of the two faces of each cell, which makes the drag on both sides equal (see momentum.py). At an
    inlet the face counts with the velocity just inside, where the gas has the room of the cell."""
    grid, velocity = box.grid, inside(box, flow)
    return _cell_vectors(box, lambda a, s: 0.5 * (velocity[a, grid.cells] + velocity[a, grid.cells + s]))


def pressure_gradient(box: Box, flow: Flow) -> np.ndarray:
    """(C, 3) mean of the faces of each cell."""
    cells, gap, p = box.grid.cells, box.grid.geometry.gap, flow.pressure
    rise = lambda a, s, face: (p[face] - p[face - s]) / gap[a, face]  # noqa: E731
    return _cell_vectors(box, lambda a, s: 0.5 * (rise(a, s, cells) + rise(a, s, cells + s)))


def _cell_vectors(box: Box, component) -> np.ndarray:
    vectors = np.zeros((len(box.grid.cells), 3))
    for a, s in enumerate(box.grid.strides):
        vectors[:, a] = component(a, s)
    return vectors


def vorticity(box: Box, flow: Flow) -> np.ndarray:
    """(C, 3) curl of the velocity: mean of the edges of each cell, where the velocities of its faces make it; walls
    count with their own velocity. Exact in a simple shear."""
    grid, velocity, curl = box.grid, flow.velocity.copy(), np.zeros((len(box.grid.cells), 3))
    for a in range(grid.dimensions):
        fill(velocity[a], component_ghosts(grid, box.faces, a))
    for a, b in itertools.combinations(range(grid.dimensions), 2):
        s, t = grid.strides[a], grid.strides[b]
        edges = grid.cells[:, None] + np.array([0, s, t, s + t])
        across = (velocity[b, edges] - velocity[b, edges - s]) / grid.geometry.gap[a, edges]
        along = (velocity[a, edges] - velocity[a, edges - t]) / grid.geometry.gap[b, edges]
        curl[:, 3 - a - b] = (1.0 if b == a + 1 else -1.0) * (across - along).mean(axis=1)
    return curl


ASKED = {"vorticity": vorticity}  # of `coupling.gas.ON_REQUEST`


def cell_fields(box: Box, flow: Flow, asked: tuple[str, ...]) -> dict[str, np.ndarray]:
    """Fields of `coupling.gas.FIELDS` before any window, and those that were asked for."""
    cells = box.grid.cells
    fields = {
        "velocity": cell_velocity(box, flow),
        "pressure": flow.pressure[cells],
        "pressure_gradient": pressure_gradient(box, flow),
        "temperature": flow.temperature[cells],
        "density": flow.mass[cells] / (flow.alpha[cells] * box.grid.geometry.volume[cells]),
        "power": np.zeros(len(cells)),
    } | {name: ASKED[name](box, flow) for name in asked}
    return fields | ({"vapour_mass_fraction": flow.fraction()[cells]} if box.vapour is not None else {})


def budget(box: Box, flow: Flow, fields: dict[str, np.ndarray]) -> Budget:
    """Totals of the gas, nothing yet of a window."""
    cells = box.grid.cells
    capacity = box.properties.gas.heat_capacity * flow.mass[cells]
    if box.vapour is not None:
        capacity = capacity + (box.vapour.heat_capacity - box.properties.gas.heat_capacity) * flow.vapour[cells]
    return Budget(
        mass=float(flow.mass[cells].sum()),
        energy=float((capacity * flow.temperature[cells]).sum()),
        vapour=float(flow.vapour[cells].sum()),
        momentum=tuple(np.einsum("i,ij->j", flow.mass[cells], fields["velocity"]).tolist()),
        kinetic=kinetic_energy(box, flow),
        mass_in=flow.mass_in, energy_in=flow.energy_in, vapour_in=flow.vapour_in, kinetic_in=flow.kinetic_in,
        pressure_work=flow.pressure_work, boundary_work=flow.boundary_work, gravity_work=flow.gravity_work,
        viscous_work=flow.viscous_work, courant=0.0,
        held={"gas_box_rel": 0.0, "gas_mass_left_rel": 0.0},
        patches=dict(zip(box.names, flow.on_patches.tolist())),
        crossed=dict(zip(box.names, flow.crossed.tolist())),
        **{name: tuple(impulse) for name, impulse in zip(IMPULSES, flow.impulses.tolist())},
    )  # fmt: skip
