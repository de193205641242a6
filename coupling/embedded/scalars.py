"""Temperature and vapour: carried by the mass fluxes, conduction and exchange implicit, totals kept to round-off."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from coupling.embedded.boundaries import Ghosts, on_faces
from coupling.embedded.box import Box, Flow, Window
from coupling.embedded.convection import Nodes, convect, substeps
from coupling.embedded.linear import fill, solve_implicit
from coupling.embedded.works import pressure_work
from coupling.gas import USED_UP, Unfinished
from sdph.laws.compiled import serial

NO_SHIFT = np.uint64(0)


@serial
def face_conductances(wide, grid, cell_value, hold, dt, out):
    """dt k A/distance on every face, k linear between the cells (ghosts as their neighbours), into out (d, S)."""
    rows, run, steps = wide
    for a in range(len(steps)):
        s = steps[a]
        for row in rows:
            for f in range(row, row + run):
                k = cell_value[f - s] + (cell_value[f] - cell_value[f - s]) * grid.reach[a, f] / grid.gap[a, f]
                out[a, f] = dt * hold[a, f] * k * grid.area[a, f] / grid.gap[a, f]


class Scalars:
    """Temperature and vapour of a box."""

    def __init__(self, box: Box):
        self.box = box
        grid, faces = box.grid, box.faces
        held = {"heat": faces.held, "vapour": faces.inlet}
        self.hold = {name: on_faces(grid, faces, where * 1.0, 1.0) for name, where in held.items()}
        self.beyond = 1.0 - box.everywhere  # ghosts hold nothing: divide by one there
        self.nodes = Nodes(grid.inner, grid.wide, NO_SHIFT, box.everywhere, grid.geometry.gap, grid.geometry.reach)

    def carry(self, old: Flow, window: Window, flow: Flow):
        """`flow` with its new vapour and temperature, its Courant number and the residuals."""
        box, grid = self.box, self.box.grid
        carried = flow.mass - window.dt * window.mass  # all but what is new
        if not np.isfinite(carried[grid.cells]).all():
            raise Unfinished("the flow of the gas is not finite; shorten the window")
        if not carried[grid.cells].min() > 0.0:
            raise Unfinished("what one window gives to the gas fills a cell all by itself; shorten the window")
        parts, courant = substeps(grid.inner, flow.flux, old.mass, carried, window.dt)
        residuals, through = {}, np.zeros_like(flow.flux)
        heat = box.properties.gas.heat_capacity
        content, carrier = heat * old.mass, heat * flow.flux
        after = heat * flow.mass
        if box.vapour is not None:
            more = box.vapour.heat_capacity - heat
            flow, through, residuals["vapour"] = self._vapour(old, window, flow, parts)
            content, after = content + more * old.vapour, after + more * flow.vapour
            carrier = carrier + more * through / window.dt
            parts, _ = substeps(grid.inner, carrier, content, after, window.dt)
        flow, warmth, residuals["heat"] = self._heat(old, window, flow, (content, carrier, after, parts))
        crossed = old.crossed + self._crossed(window.dt * flow.flux, warmth, through)
        return replace(flow, crossed=crossed), courant, residuals

    def _crossed(self, mass: np.ndarray, warmth: np.ndarray, vapour: np.ndarray) -> np.ndarray:
        """(P, 4) of `coupling.gas.Budget.crossed`, of what goes through faces (d, S) [kg, J, kg]."""
        box, found = self.box, np.zeros((len(self.box.names), 4))
        through = [box.outward(own) for own in (mass, warmth, vapour)]
        leaves = through[0] > 0.0
        parts = np.where(leaves, 0.0, -through[0]), *(np.where(leaves, own, 0.0) for own in through)
        np.add.at(found, box.faces.owner, np.stack(parts, axis=1))
        return found

    def _vapour(self, old: Flow, window: Window, flow: Flow, parts: int):
        """The new flow, the vapour (d, S) [kg] through every face, and the residual."""
        diffusivity = self.box.vapour.diffusivity * self.box.grid.per_volume(flow.mass)
        carried = (self._left(old, window), old.mass.copy(), flow.flux, parts)
        exchanged = (flow.mass, window.dt * (window.given + window.carrier), window.dt * window.given)
        fraction, through, error = self._transport(flow, window.dt, "vapour", carried, diffusivity, exchanged)
        vapour = np.zeros_like(flow.mass)
        cells = self.box.grid.cells
        vapour[cells] = flow.mass[cells] * fraction[cells]
        vapour_in = flow.vapour_in - float(self.box.outward(through).sum())
        return replace(flow, vapour=vapour, vapour_in=vapour_in), through, error

    def _left(self, old: Flow, window: Window) -> np.ndarray:
        """Mass fraction (S,) of the vapour when what a window uses up is gone, before any flow carries it away."""
        fraction, cells = old.fraction(), self.box.grid.cells
        used = (window.given - window.vapour)[cells]
        fraction[cells] -= window.dt * used / old.mass[cells]
        lacking = (used > 0.0) & (fraction[cells] < -USED_UP)
        if lacking.any():
            cell = int(np.argmax(lacking))
            raise Unfinished(f"cell {cell} has less vapour than one window uses up there; shorten the window")
        return fraction

    def _heat(self, old: Flow, window: Window, flow: Flow, heat):
        """The new flow, what went through faces (d, S) [J], and the residual; heat: content [J/K] before, its flux
        [W/K], content after, sub-steps."""
        before, carrier, after, parts = heat
        conductivity = window.alpha * self.box.properties.mixture("conductivity", flow.fraction())
        grown = window.dt * (window.cling + self.box.properties.gas.heat_capacity * window.carrier)
        if self.box.vapour is not None:
            grown = grown + window.dt * self.box.vapour.heat_capacity * window.vapour
        pressed, unpaid = pressure_work(self.box, old, window, flow)
        given = window.dt * window.warmth + self.box.grid.padded(pressed)
        exchanged = (after + window.dt * window.cling, grown, given)
        carried = (old.temperature.copy(), before.copy(), carrier, parts)
        temperature, through, error = self._transport(flow, window.dt, "heat", carried, conductivity, exchanged)
        energy_in = flow.energy_in - float(self.box.outward(through).sum())
        works = {
            "pressure_work": old.pressure_work + float(pressed.sum()),
            "boundary_work": old.boundary_work + float(unpaid.sum()),
        }
        return replace(flow, temperature=temperature, energy_in=energy_in, **works), through, error

    def _transport(self, flow: Flow, dt: float, name: str, carried, diffusivity: np.ndarray, exchanged):
        """One field from the start of the window to its end, and what went through every face."""
        box, grid = self.box, self.box.grid
        field, mass, flux, parts = carried
        diagonal, grown, source = exchanged
        ghosts = self._ghosts(flow, name)
        through, conductance = grid.zeros(grid.dimensions), grid.zeros(grid.dimensions)
        if parts:
            half = self._half(mass, grown, source)
            through = convect(self.nodes, ghosts, field, mass, flux, dt, parts, box.limited, True, half)
        fill(field, ghosts)
        face_conductances(grid.wide, grid.geometry, grid.extended(diffusivity), self.hold[name], dt, conductance)
        source = mass * field + source
        given, error = solve_implicit(grid.wide, box.everywhere, conductance, diagonal, source, field, box.tolerance)
        return field, through + given, error

    def _half(self, content: np.ndarray, grown: np.ndarray, source: np.ndarray):
        """(share kept, gain), (S,) each, of the implicit exchange of half a window: `grown` is what a whole one adds to
        the diagonal, `source` what it adds to the content."""
        after = content + 0.5 * grown + self.beyond
        return content / after, 0.5 * source / after

    def _ghosts(self, flow: Flow, name: str) -> Ghosts:
        """The boundary value where it is held or where gas flows in, else that of the neighbour."""
        faces = self.box.faces
        held, value = (faces.held, faces.temperature) if name == "heat" else (faces.inlet, faces.vapour)
        return Ghosts(faces.ghost, faces.cell, held | (self.box.outward(flow.flux) < 0.0), value)
