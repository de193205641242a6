"""The pressure that lets every cell hold the mass it should, and the mass fluxes that go with it.

With D the diagonal of momentum (mass and drag), u' = u - dt alpha V/D grad p. What the solver leaves over is not
lost: the mass that a cell carries on is what the fluxes brought, and the next window aims at the full target.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from coupling.embedded.boundaries import resting_pressure
from coupling.embedded.box import Box, Flow, Window, window_of
from coupling.embedded.linear import not_converged
from coupling.embedded.multigrid import build_levels, solve_pressure
from coupling.gas import Unfinished
from sdph.laws.compiled import serial

CONTINUITY = 1e3  # tolerances: what of a cell's mass the solver may leave over in a window; our choice


@serial
def face_fluxes(wide, active, grid, alpha, density, diagonal, velocity, dt, flux, conductance):
    """Mass fluxes [kg/s] of the predicted velocity on the active faces, and dt^2 alpha rho A alpha V/(D distance)
    [kg/Pa]. density (S,): alpha rho, ghosts as their neighbours."""
    rows, run, steps = wide
    volume, area, gap, reach = grid.volume, grid.area, grid.gap, grid.reach
    for a in range(len(steps)):
        s = steps[a]
        for row in rows:
            for f in range(row, row + run):
                here = density[f - s] + (density[f] - density[f - s]) * reach[a, f] / gap[a, f]
                gas = 0.5 * (alpha[f] * volume[f] + alpha[f - s] * volume[f - s])
                flux[a, f] = here * area[a, f] * velocity[a, f] if active[a, f] else flux[a, f]
                ease = dt * dt * here * area[a, f] * gas / (diagonal[a, f] * gap[a, f])
                conductance[a, f] = ease if active[a, f] else 0.0


@serial
def balance(inner, flux, gained, mass, dt, out):
    """out (S,) = mass + dt (gained - div flux) of every cell [kg]."""
    rows, run, steps = inner
    for row in rows:
        for c in range(row, row + run):
            change = gained[c]
            for a in range(len(steps)):
                change += flux[a, c] - flux[a, c + steps[a]]
            out[c] = mass[c] + dt * change


@serial
def correct(wide, active, grid, alpha, diagonal, conductance, correction, dt, velocity, flux):
    """Velocity and fluxes after the correction of the pressure, in place."""
    rows, run, steps = wide
    volume, gap = grid.volume, grid.gap
    for a in range(len(steps)):
        s = steps[a]
        for row in rows:
            for f in range(row, row + run):
                gas = 0.5 * (alpha[f] * volume[f] + alpha[f - s] * volume[f - s])
                drop = correction[f - s] - correction[f] if active[a, f] else 0.0
                velocity[a, f] += dt * gas / (diagonal[a, f] * gap[a, f]) * drop
                flux[a, f] += conductance[a, f] * drop / dt


class Aim(NamedTuple):
    """Mass (S,) [kg] that the cells should hold at the end of a window, the ratio of their density to the
    equation of state, and the mass flux (B,) [kg/s] out of each inlet face (0 elsewhere)."""

    mass: np.ndarray
    ratio: float
    outward: np.ndarray


class Pressure:
    """The projection of a box."""

    def __init__(self, box: Box, active: np.ndarray):
        self.box, self.active = box, active
        faces, grid = box.faces, box.grid
        self.levels = build_levels(grid)
        self.work = np.zeros((grid.dimensions, self.levels.first[-1])), *np.zeros((3, self.levels.first[-1]))
        self.density = box.properties.density(faces.temperature, faces.vapour)  # of what flows in
        self.blow()

    def blow(self) -> None:
        """Take note of the velocities that the boundaries have now."""
        faces, grid = self.box.faces, self.box.grid
        normal = faces.velocity[np.arange(len(faces.face)), faces.axis]
        # m3/s outward
        self.inlet = np.where(faces.inlet, normal * faces.sign * grid.geometry.area[faces.axis, faces.face], 0.0)
        self.standing = grid.zeros(grid.dimensions)
        self.standing[faces.axis, faces.face] = np.where(faces.inlet, normal, 0.0)

    def let_in(self, velocity: np.ndarray) -> np.ndarray:
        """Velocity (d, S) [m/s] of faces with that of the inlets as it is now."""
        faces, found = self.box.faces, velocity.copy()
        own = faces.axis[faces.inlet], faces.face[faces.inlet]
        found[own] = self.standing[own]
        return found

    def at_start(self) -> np.ndarray:
        """(S,) pressure of the gas of the case at rest; on the boundary it is in the ghosts, and in openings it
        stays."""
        box = self.box
        fraction = box.vapour.mass_fraction if box.vapour else 0.0
        density = float(box.properties.density(np.array([box.temperature]), fraction)[0])
        outside, inside = resting_pressure(box.faces, box.grid, box.gravity, density)
        pressure = box.grid.padded(inside)
        pressure[box.faces.ghost] = outside
        return pressure

    def at_once(self, rest: Flow) -> Flow:
        """The flow into which inlets set gas at `rest` at once: what of a window is left as it gets short, the impulse
        of the pressure alone. What comes in takes its room, whatever its density. A closed box has no such flow: its
        gas cannot give way at once; nor does one without room, of which the first window tells."""
        if self.box.closed or not self.inlet.any():
            return rest
        grid, fastest = self.box.grid, np.abs(self.standing).max()
        crossed = min(width[grid.cells].min() for width in grid.geometry.width) / fastest  # any time gives the same
        mass = np.array([0.5 * (rest.mass + np.roll(rest.mass, step)) for step in grid.strides])
        faces, room = self.box.faces, (rest.alpha * grid.geometry.volume)[grid.cells]
        inside = rest.mass[grid.cells].sum() / room.sum()  # the density of the gas, the same everywhere
        aim = Aim(rest.mass, 1.0, self.inlet * inside)
        try:
            nothing = window_of(self.box, rest, crossed, {})
            flow, _ = self.project(rest, nothing, aim, rest.velocity, np.where(self.active, mass, 1.0))
        except Unfinished:
            return rest
        own = faces.axis[faces.inlet], faces.face[faces.inlet]
        flow.flux[own] = (faces.sign * self.inlet * self.density)[faces.inlet]
        self._carry_beyond(flow.flux)
        return replace(rest, velocity=flow.velocity, flux=flow.flux)

    def aim(self, old: Flow, window: Window, temperature: np.ndarray, fraction: np.ndarray) -> Aim:
        """Mass by the equation of state; in a closed box times the one factor that leaves its total right."""
        cells = self.box.grid.cells
        mass = self.box.grid.zeros()
        state = self.box.properties.density(temperature[cells], fraction[cells])
        mass[cells] = window.alpha[cells] * self.box.grid.geometry.volume[cells] * state
        outward, ratio = self.inlet * self.density * old.ratio, 1.0
        if self.box.closed:
            ratio = (old.mass[cells].sum() + window.dt * (window.mass[cells].sum() - outward.sum())) / mass.sum()
        return Aim(mass * ratio, ratio, outward)

    def project(self, old: Flow, window: Window, aim: Aim, velocity: np.ndarray, diagonal: np.ndarray):
        """The flow at the end of the window but for its temperature and vapour, and the residual that is left."""
        box, grid, dt = self.box, self.box.grid, window.dt
        fine = self.work[0][:, : grid.size]
        flux, mass, correction = self._inflow(aim), grid.zeros(), grid.zeros()
        density = grid.per_volume(aim.mass)
        setting = grid.wide, self.active, grid.geometry, window.alpha
        face_fluxes(*setting, density, diagonal, velocity, dt, flux, fine)
        balance(grid.inner, flux, window.mass, old.mass, dt, mass)
        excess = mass - aim.mass
        tolerance = CONTINUITY * box.tolerance
        _, error = solve_pressure(self.levels, grid.inner, self.work, excess, aim.mass, correction, tolerance)
        if not error <= tolerance:
            raise Unfinished(not_converged("pressure", old.time + dt, error))
        if box.closed:
            correction[grid.cells] -= correction[grid.cells].mean()
        correct(*setting, diagonal, fine, correction, dt, velocity, flux)
        balance(grid.inner, flux, window.mass, old.mass, dt, mass)
        self._carry_beyond(flux)
        pressure = old.pressure + correction
        self._lean(window, mass, flux, pressure)
        new = {"alpha": window.alpha, "mass": mass, "velocity": velocity, "flux": flux, "ratio": aim.ratio}
        totals = {"time": old.time + dt, "mass_in": old.mass_in - float(dt * box.outward(flux).sum())}
        return replace(old, pressure=pressure, **new, **totals), error

    def _inflow(self, aim: Aim) -> np.ndarray:
        """(d, S) mass flux of the inlets, nothing elsewhere."""
        faces, flux = self.box.faces, self.box.grid.zeros(self.box.grid.dimensions)
        flux[faces.axis, faces.face] = faces.sign * aim.outward
        return flux

    def _carry_beyond(self, flux: np.ndarray) -> None:
        """Carry the flux through an opening on beyond it: half the control volume of the velocity there ends on it."""
        faces = self.box.faces
        beyond = faces.face + (faces.sign * np.array(self.box.grid.strides)[faces.axis]).astype(np.int64)
        flux[faces.axis, beyond] = flux[faces.axis, faces.face]

    def _lean(self, window: Window, mass: np.ndarray, flux: np.ndarray, pressure: np.ndarray) -> None:
        """Set the pressure in the ghosts where the boundary gives the velocity: it holds the gas there against weight
        and particles, between which it is as fast as its flux asks for."""
        faces, grid = self.box.faces, self.box.grid
        fixed = np.flatnonzero(~faces.open)
        axis, cell, face = faces.axis[fixed], faces.cell[fixed], faces.face[fixed]
        velocity = flux[axis, face] * grid.geometry.volume[cell] / (mass[cell] * grid.geometry.area[axis, face])
        force = mass[cell] * np.array(self.box.gravity)[axis] + window.push[axis, cell] - window.pull[cell] * velocity
        slope = force / (window.alpha[cell] * grid.geometry.volume[cell])
        pressure[faces.ghost[fixed]] = pressure[cell] + faces.sign[fixed] * grid.geometry.gap[axis, face] * slope
