"""Momentum of the gas on the faces: convection explicit, viscosity and drag implicit.

Half of what a cell holds (mass, volume, drag) belongs to each of its two faces along an axis. The drag on all
faces is then sum_f (beta v_p - beta u_f) V_f = sum_c (beta v_p - beta U_c) V_c to round-off if U_c, the velocity
handed to the particles, is the mean of the two faces. A face that does not move freely (wall, inlet) passes its
half on to the boundary.
"""

from __future__ import annotations

import numpy as np

from coupling.embedded.boundaries import active_nodes, component_ghosts, on_faces
from coupling.embedded.box import Box, Flow, Window
from coupling.embedded.convection import Nodes, convect, substeps
from coupling.embedded.grid import component_spacing
from coupling.embedded.impulses import crossed, rims_of
from coupling.embedded.linear import fill, solve_implicit
from sdph.laws.compiled import serial


@serial
def corner(values, f, s, t):
    """Mean of the four cells round the edge between f, f - s, f - t and f - s - t."""
    return 0.25 * (values[f] + values[f - s] + values[f - t] + values[f - s - t])


@serial
def viscous_conductances(wide, axis, viscosity, grid, hold, dt, out):
    """dt alpha mu A/distance [kg] between the velocities along `axis` and their neighbours, into out (d, S)."""
    rows, run, steps = wide
    area, s = grid.area, steps[axis]
    for b in range(len(steps)):
        t = steps[b]
        for row in rows:
            for f in range(row, row + run):
                if b == axis:
                    c = f - s
                    out[b, f] = dt * viscosity[c] * grid.volume[c] / grid.width[b, c] ** 2
                else:
                    held = 0.5 * (hold[b, f - s] * area[b, f - s] + hold[b, f] * area[b, f])
                    out[b, f] = dt * corner(viscosity, f, s, t) * held / grid.gap[b, f]


@serial
def divergence(inner, velocity, width, out):
    """div v of the cells, into out (S,)."""
    rows, run, steps = inner
    for row in rows:
        for c in range(row, row + run):
            out[c] = 0.0
            for a in range(len(steps)):
                out[c] += (velocity[a, c + steps[a]] - velocity[a, c]) / width[a, c]


@serial
def rest_of_stress(wide, axis, viscosity, velocity, spread, grid, out):
    """Part of tau (Eq. 5 of the closure sheet) that the Laplacian leaves out, times area [N], on the faces of the
    control volumes of the velocity along `axis`, into out (d, S): alpha mu (dv_b/dx_axis - 2/3 div v on the normal
    ones)."""
    rows, run, steps = wide
    area, s = grid.area, steps[axis]
    for b in range(len(steps)):
        t = steps[b]
        for row in rows:
            for f in range(row, row + run):
                if b == axis:
                    slope = (velocity[axis, f] - velocity[axis, f - s]) / grid.width[axis, f - s]
                    out[b, f] = viscosity[f - s] * (slope - 2.0 / 3.0 * spread[f - s]) * area[axis, f - s]
                else:
                    slope = (velocity[b, f] - velocity[b, f - s]) / grid.gap[axis, f]
                    out[b, f] = corner(viscosity, f, s, t) * slope * 0.5 * (area[b, f - s] + area[b, f])


@serial
def momentum_balance(wide, axis, active, grid, cells, stress, moved, gravity, dt, diagonal, source):
    """Diagonal [kg] and source [kg m/s] of the implicit equation for the velocity along `axis`.

    m' u' = m' u + dt (-alpha V grad p + m' g + push - pull u' + div tau), where moved (S,) is u after convection and
    cells holds alpha, m', p, pull [kg/s] and push [N], each (S,).
    """
    rows, run, steps = wide
    alpha, mass, pressure, pull, push = cells
    volume, s = grid.volume, steps[axis]
    for row in rows:
        for f in range(row, row + run):
            m = 0.5 * (mass[f] + mass[f - s])
            gas = 0.5 * (alpha[f] * volume[f] + alpha[f - s] * volume[f - s])
            force = (
                m * gravity + 0.5 * (push[f] + push[f - s]) - gas * (pressure[f] - pressure[f - s]) / grid.gap[axis, f]
            )
            viscous = 0.0
            for b in range(len(steps)):
                viscous += stress[b, f + steps[b]] - stress[b, f]
            force += viscous if mass[f] > 0.0 and mass[f - s] > 0.0 else 0.0
            diagonal[f] = m + dt * 0.5 * (pull[f] + pull[f - s]) if active[f] else 1.0
            source[f] = m * moved[f] + dt * force


@serial
def viscous_impulse(wide, axis, active, mass, rubbed, stress, out):
    """Impulse [kg m/s] of viscosity on the free velocities along an axis, into out (S,): of the implicit part, `rubbed`
    (d, S) upwards through faces, and of the rest as `momentum_balance` has it, `stress` (d, S) downwards."""
    rows, run, steps = wide
    s = steps[axis]
    for row in rows:
        for f in range(row, row + run):
            if not active[f]:
                continue
            for b in range(len(steps)):
                out[f] += rubbed[b, f] - rubbed[b, f + steps[b]]
                if mass[f] > 0.0 and mass[f - s] > 0.0:
                    out[f] += stress[b, f + steps[b]] - stress[b, f]


class Momentum:
    """The momentum predictor of a box."""

    def __init__(self, box: Box):
        self.box = box
        grid, faces = box.grid, box.faces
        self.active = active_nodes(grid, faces)
        self.blow()
        self.nodes = [
            Nodes(grid.wide, grid.wide, step, active, *component_spacing(grid, a))
            for a, (step, active) in enumerate(zip(grid.wide[2], self.active))
        ]
        self.hold = on_faces(grid, faces, faces.clings * 1.0, 1.0)
        self.rims = [rims_of(grid, faces, a, active) for a, active in enumerate(self.active)]

    def blow(self) -> None:
        """Take note of the velocities that the boundaries have now."""
        grid, faces = self.box.grid, self.box.faces
        self.ghosts = [component_ghosts(grid, faces, a) for a in range(grid.dimensions)]

    def predict(self, old: Flow, window: Window, mass: np.ndarray, fraction: np.ndarray):
        """Velocity (d, S) under the old pressure, the diagonal D (d, S) [kg] of its equation, the largest residual,
        what crossed the rims along each axis, see `impulses.crossed`, and the impulses of viscosity (d, S) [kg m/s] on
        the faces that move freely. mass (S,): of the cells, at the end."""
        grid = self.box.grid
        inside = grid.geometry.volume > 0.0
        viscosity = grid.extended(window.alpha * self.box.properties.mixture("viscosity", fraction) * inside)
        moved, carried = self.convected(old, window.dt)
        spread, stress = grid.zeros(), grid.zeros(grid.dimensions)
        divergence(grid.inner, old.velocity, grid.geometry.width, spread)
        velocity, diagonal, residual, over = moved.copy(), np.ones_like(moved), 0.0, []
        impulse = np.zeros_like(moved)
        for a in range(grid.dimensions):
            conductance, source, active = np.zeros_like(moved), grid.zeros(), self.active[a]
            viscous_conductances(grid.wide, a, viscosity, grid.geometry, self.hold, window.dt, conductance)
            rest_of_stress(grid.wide, a, viscosity, old.velocity, spread, grid.geometry, stress)
            cells = window.alpha, mass, old.pressure, window.pull, window.push[a]
            given = grid.geometry, cells, stress, moved[a], self.box.gravity[a], window.dt
            momentum_balance(grid.wide, a, active, *given, diagonal[a], source)
            fill(velocity[a], self.ghosts[a])
            rubbed, error = solve_implicit(
                grid.wide, active, conductance, diagonal[a], source, velocity[a], self.box.tolerance
            )
            residual = max(residual, error)
            over.append(crossed(self.rims[a], carried[a], rubbed, window.dt * stress))
            viscous_impulse(grid.wide, a, active, mass, rubbed, window.dt * stress, impulse[a])
        return velocity, diagonal, residual, [np.array(part) for part in zip(*over)], impulse

    def convected(self, old: Flow, dt: float) -> tuple[np.ndarray, np.ndarray]:
        """The old velocity (d, S) carried on by the old mass fluxes, and what of that along each axis every face let
        through upwards (d, d, S) [kg m/s]."""
        grid, velocity = self.box.grid, old.velocity.copy()
        through = np.zeros((grid.dimensions, *velocity.shape))
        parts, _ = substeps(grid.inner, old.flux, old.mass, old.mass, dt)
        for a in range(grid.dimensions if parts else 0):
            mass = 0.5 * (old.mass + np.roll(old.mass, grid.strides[a]))
            how = self.box.limited, False, ()
            through[a] = convect(self.nodes[a], self.ghosts[a], velocity[a], mass, old.flux, dt, parts, *how)
        return velocity, through
