"""Temperature and vapour: carried by the mass fluxes, conduction and exchange implicit, totals kept to round-off."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numba import njit

from coupling.embedded.boundaries import Ghosts, on_faces
from coupling.embedded.box import Box, Flow, Window
from coupling.embedded.convection import convect, substeps
from coupling.embedded.linear import IMPLICIT, fill, solve_implicit
from coupling.gas import GasError

NO_SHIFT = np.uint64(0)


@njit(cache=True, error_model="numpy")
def face_conductances(wide, cell_value, area, gap, reach, hold, dt, out):
    """dt k A/distance on every face, k linear between the cells (ghosts as their neighbours), into out (d, S)."""
    rows, run, steps = wide
    for a in range(len(steps)):
        s = steps[a]
        for row in rows:
            for f in range(row, row + run):
                k = cell_value[f - s] + (cell_value[f] - cell_value[f - s]) * reach[a, f] / gap[a, f]
                out[a, f] = dt * hold[a, f] * k * area[a, f] / gap[a, f]


class Scalars:
    """Temperature and vapour of a box."""

    def __init__(self, box: Box):
        self.box = box
        grid, faces = box.grid, box.faces
        self.hold = {"heat": on_faces(grid, faces, faces.held * 1.0, 1.0), "vapour": on_faces(grid, faces, faces.inlet * 1.0, 1.0)}

    def carry(self, old: Flow, window: Window, flow: Flow):
        """`flow` with its new vapour and temperature, its Courant number and the residuals."""
        box, grid = self.box, self.box.grid
        carried = flow.mass - window.dt * window.vapour  # all but the new vapour
        if not carried[grid.cells].min() > 0.0:
            raise GasError("the vapour of one window fills a cell all by itself; shorten the window")
        parts, courant = substeps(grid.inner, flow.flux, old.mass, carried, window.dt)
        residuals = {}
        heat = box.properties.gas.heat_capacity
        content, carrier = heat * old.mass, heat * flow.flux
        after = heat * flow.mass
        if box.vapour is not None:
            more = box.vapour.heat_capacity - heat
            flow, through, residuals["vapour"] = self._vapour(old, window, flow, parts)
            content, carrier, after = content + more * old.vapour, carrier + more * through / window.dt, after + more * flow.vapour
            parts, _ = substeps(grid.inner, carrier, content, after, window.dt)
        flow, residuals["heat"] = self._heat(old, window, flow, (content, carrier, after, parts))
        return flow, courant, residuals

    def _vapour(self, old: Flow, window: Window, flow: Flow, parts: int):
        """The new flow, the vapour (d, S) [kg] through every face, and the residual."""
        diffusivity = self.box.vapour.diffusivity * flow.mass / np.where(self.box.grid.volume > 0.0, self.box.grid.volume, 1.0)
        carried = (old.fraction(), old.mass.copy(), flow.flux, parts)
        exchanged = (flow.mass, window.dt * window.vapour)
        fraction, through, error = self._transport(flow, window.dt, "vapour", carried, diffusivity, exchanged)
        vapour = np.zeros_like(flow.mass)
        cells = self.box.grid.cells
        vapour[cells] = flow.mass[cells] * fraction[cells]
        return replace(flow, vapour=vapour, vapour_in=flow.vapour_in - self.box.outward(through).sum()), through, error

    def _heat(self, old: Flow, window: Window, flow: Flow, heat):
        """The new flow and the residual; heat: content [J/K] before, its flux [W/K], content after, sub-steps."""
        before, carrier, after, parts = heat
        conductivity = window.alpha * self.box.properties.mixture("conductivity", flow.fraction())
        exchanged = (after + window.dt * window.cling, window.dt * window.warmth)
        carried = (old.temperature.copy(), before.copy(), carrier, parts)
        temperature, through, error = self._transport(flow, window.dt, "heat", carried, conductivity, exchanged)
        return replace(flow, temperature=temperature, energy_in=flow.energy_in - self.box.outward(through).sum()), error

    def _transport(self, flow: Flow, dt: float, name: str, carried, diffusivity: np.ndarray, exchanged):
        """One field from the start of the window to its end, and what went through every face."""
        box, grid, faces = self.box, self.box.grid, self.box.faces
        field, mass, flux, parts = carried
        diagonal, source = exchanged
        ghosts = self._ghosts(flow, name)
        through, conductance = grid.zeros(grid.dimensions), grid.zeros(grid.dimensions)
        if parts:
            through = convect(grid.inner, grid.wide, NO_SHIFT, box.everywhere, field, mass, flux, grid.gap, grid.reach, ghosts, dt, parts, box.limited, True)
        fill(field, ghosts)
        face_conductances(grid.wide, grid.extended(diffusivity), grid.area, grid.gap, grid.reach, self.hold[name], dt, conductance)
        given, error = solve_implicit(grid.wide, box.everywhere, conductance, diagonal, mass * field + source, field, IMPLICIT)
        return field, through + given, error

    def _ghosts(self, flow: Flow, name: str) -> Ghosts:
        """The boundary value where it is held or where gas flows in, else that of the neighbour."""
        faces = self.box.faces
        held, value = (faces.held, faces.temperature) if name == "heat" else (faces.inlet, faces.vapour)
        return Ghosts(faces.ghost, faces.cell, held | (self.box.outward(flow.flux) < 0.0), value)
