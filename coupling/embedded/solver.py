"""A small finite-volume gas solver in the process of the particles, behind the door of `coupling.gas`.

Low-Mach equations of a gas of volume fraction alpha on a Cartesian staggered grid:

    ddt(alpha rho)      + div(alpha rho u)      = Gamma
    ddt(alpha rho u)    + div(alpha rho u u)    = -alpha grad p + div tau + alpha rho g + beta v_p - beta u + Gamma v_p
    ddt(alpha rho Y)    + div(alpha rho u Y)    = -div J + Gamma_v,    J = -alpha rho D grad Y
    ddt(alpha rho cp T) + div(alpha rho u cp T) = div(alpha k grad T) - div((cp_v - cp_g) T J) + eps T_p - eps T + q
                                                  + alpha u.grad p

First order in time, second in space. Convection is explicit, in as many sub-steps as the window needs, the rest
implicit: accuracy alone limits a window. Mass, vapour and heat of a cell are what the fluxes brought, so totals close
to round-off; Gamma is vapour Gamma_v and the rest of the gas, and vapour that is used up is gone before any flows on.
Where the velocity of an inlet changes in time, gas comes in at its mean in the window. Laminar. A gas of `constant`
density is a low-Mach ideal gas: h = cp T, so that the pressure works on it (Eq. 30 of the closure sheet): with the
heat of drag, q, a throttled gas keeps its temperature. Of Dp/Dt the rate dp/dt is left out: without sound the pressure
is as high for an instant as any sudden motion asks for.

Velocity is carried by the mass fluxes of the window before and takes no mass along: even velocity stays even. Where
no mass of a cell changes in a window, momentum is then kept to the tolerance of continuity, on graded cells too; where
particles that move or vapour change it, to first order in the window (`gas_numerical_impulse` of the ledger).

In a box without opening the mass is given, so its density is the equation of state's times one factor for the
whole box: with `operating` that is the rise of the operating pressure, with `constant` the gas is squeezed alike
everywhere. `gas_box_rel` of the history is the factor less 1. Its pressure has zero mean.
"""

from __future__ import annotations

import dataclasses
import os
from pathlib import Path

import numpy as np

from coupling.embedded.box import Box, Flow, restored, window_of
from coupling.embedded.grid import build_grid
from coupling.embedded.impulses import impulses, of_patches, on_faces
from coupling.embedded.linear import not_converged
from coupling.embedded.momentum import Momentum
from coupling.embedded.output import budget, cell_fields
from coupling.embedded.pressure import Pressure
from coupling.embedded.scalars import Scalars
from coupling.embedded.works import power, through_motion, viscous_work
from coupling.gas import IMPULSES, SOURCES, CheckpointError, GasError, GasState, Mesh, Unfinished, known_fields
from sdph.case.gas_cells import cell_edges
from sdph.engine.reading import Unreadable, read_arrays

PASSES = 2  # of a window whose density follows temperature (shared/openfoam.md: one if constant, else two)
CHECKPOINT = "embedded_gas.npz"
MOST_HEADERS = 2**16  # bytes of a checkpoint that are not of arrays; our choice


class EmbeddedGas:
    """The `Gas` of a case on a Cartesian grid; `limited` False takes first-order upwind convection instead of van
    Leer's."""

    def __init__(self, case, *, limited: bool = True):
        self.box = Box(case, build_grid(cell_edges(case)), limited)
        self.momentum = Momentum(self.box)
        self.pressure = Pressure(self.box, self.momentum.active)
        self.scalars = Scalars(self.box)
        self.sources: tuple[str, ...] = ()
        self.fields: tuple[str, ...] = ()  # on request
        self.flow: Flow | None = None
        self.state: GasState | None = None
        grid = self.box.grid
        centres = np.zeros((len(grid.cells), 3))
        centres[:, : grid.dimensions] = grid.centres
        self.mesh = Mesh(centres, grid.geometry.volume[grid.cells], grid.dimensions)

    def start(self, alpha_g: np.ndarray | None, sources: tuple[str, ...], fields: tuple[str, ...] = ()) -> GasState:
        """Gas at the temperature of the case, with the vapour of its start, at rest but for what inlets set moving at
        once."""
        self.sources, self.fields = _known(sources, self.box), known_fields(fields)
        box, grid = self.box, self.box.grid
        alpha = grid.extended(grid.padded(np.ones(len(grid.cells)) if alpha_g is None else alpha_g))
        temperature = np.full(grid.size, box.temperature)
        fraction = box.vapour.mass_fraction if box.vapour else 0.0
        mass, density = grid.zeros(), box.properties.density(temperature[grid.cells], fraction)
        mass[grid.cells] = alpha[grid.cells] * grid.geometry.volume[grid.cells] * density
        pressure = self.pressure.at_start()
        velocity = self.pressure.standing.copy()
        sums = [np.zeros(shape) for shape in ((len(IMPULSES), 3), (len(box.names), 3, 3), (len(box.names), 4))]
        moving = velocity, grid.zeros(grid.dimensions), *sums
        self.flow = self.pressure.at_once(Flow(0.0, alpha, mass, fraction * mass, temperature, pressure, *moving))
        self.state = self._state()
        return self.state

    def advance(self, dt: float, sources: dict[str, np.ndarray]) -> GasState:
        """Advance one window: mass to be reached, momentum predictor, pressure projection, transport of scalars."""
        self._check(dt, sources)
        self.before = self.flow, self.state
        old = new = self._blown(dt)
        window = window_of(self.box, old, dt, sources)
        for _ in range(PASSES if self.box.properties.varies else 1):
            aim = self.pressure.aim(old, window, new.temperature, new.fraction())
            velocity, diagonal, residual, over, rubbed = self.momentum.predict(old, window, aim.mass, new.fraction())
            new, left = self.pressure.project(old, window, aim, velocity, diagonal)
            new, courant, residuals = self.scalars.carry(old, window, new)
        residuals["momentum"] = residual
        _converged(new.time, residuals, self.box.tolerance)
        came, lifted = through_motion(self.box, old, new, dt)
        sums = {"kinetic_in": old.kinetic_in + came, "gravity_work": old.gravity_work + lifted}
        sums["viscous_work"] = old.viscous_work + viscous_work(self.box, old, new, rubbed)
        pressed, rubbed = on_faces(self.box, old, window, new, over)
        sums["impulses"] = old.impulses + impulses(self.box, window, new, over[0], pressed, rubbed)
        sums["on_patches"] = old.on_patches + of_patches(self.box, pressed, rubbed)
        self.flow = dataclasses.replace(new, **sums)
        found = self._state()
        found.fields["power"] = power(self.box, old, window, new) / self.mesh.volumes
        held = {"gas_box_rel": abs(float(new.ratio - 1.0)), "gas_mass_left_rel": left}
        told = {"courant": courant, "residuals": residuals | {"pressure": left}, "held": held}
        full = dataclasses.replace(found.budget, **told)
        self.state = dataclasses.replace(found, budget=full)
        return self.state

    def _blown(self, dt: float) -> Flow:
        """The flow at the start of a window of `dt` [s], its inlets with their velocities in the mean of it."""
        flow = self.flow
        if not self.box.blow(flow.time, flow.time + dt):
            return flow
        self.momentum.blow()
        self.pressure.blow()
        return dataclasses.replace(flow, velocity=self.pressure.let_in(flow.velocity))

    def retreat(self) -> GasState:
        """Go back to where the last window began: no window changes the arrays of the one before."""
        self.flow, self.state = self.before
        return self.state

    def checkpoint(self, folder: Path) -> None:
        """Write `Flow` to one file, whole or not at all."""
        path = Path(folder) / CHECKPOINT
        path.parent.mkdir(parents=True, exist_ok=True)
        part = path.with_suffix(".part")
        with open(part, "wb") as file:
            np.savez(file, sources=np.array(self.sources, dtype=np.str_), **vars(self.flow))
            file.flush()
            os.fsync(file.fileno())
        os.replace(part, path)

    def restore(self, folder: Path, sources: tuple[str, ...] | None = None, fields: tuple[str, ...] = ()) -> GasState:
        """Go on from what `checkpoint` wrote; `sources` are those that will come (None: those of the checkpoint)."""
        path, grid, self.fields = Path(folder) / CHECKPOINT, self.box.grid, known_fields(fields)
        try:
            saved = read_arrays(
                path, MOST_HEADERS + 8 * grid.size * len(dataclasses.fields(Flow)) * (1 + grid.dimensions)
            )
            self.sources = _known(tuple(str(name) for name in np.atleast_1d(saved.pop("sources"))), self.box)
            self.flow = restored(self.box, saved)
        except KeyError as missing:
            raise CheckpointError(f"{path} lacks {missing}") from None
        except (Unreadable, GasError, ValueError) as error:
            raise CheckpointError(f"{path} is no checkpoint of this gas: {error}") from None
        if sources is not None and sources != self.sources:
            raise CheckpointError(
                f"{path} is of the sources {', '.join(self.sources)}; to come are {', '.join(sources)}"
            )
        self.state = self._state()
        return self.state

    def close(self) -> None:
        """Do nothing: the solver has no process of its own."""

    def _state(self) -> GasState:
        self.box.blow(self.flow.time, self.flow.time)
        fields = cell_fields(self.box, self.flow, self.fields)
        return GasState(self.flow.time, fields, budget(self.box, self.flow, fields))

    def _check(self, dt: float, sources: dict[str, np.ndarray]) -> None:
        """Sources must be those announced, of the right shape, and finite."""
        if self.flow is None:
            raise GasError("the embedded gas solver was not started; call start or restore first")
        if not (np.isfinite(dt) and dt > 0.0):
            raise GasError(f"window of {dt} s; it must be above 0")
        if set(sources) != set(self.sources):
            announced = ", ".join(self.sources)
            raise GasError(f"the window brings {', '.join(sources)}, but announced at the start were {announced}")
        for name, values in sources.items():
            self._check_values(name, values)

    def _check_values(self, name: str, values: np.ndarray) -> None:
        shape = (len(self.mesh.volumes), 3)[: 1 + (SOURCES[name][1] == 3)]
        if np.shape(values) != shape:
            raise GasError(f"source {name} has shape {np.shape(values)}; it must be {shape}")
        if not np.isfinite(np.sum(values)):
            cell = int(np.argmin(np.isfinite(values).reshape(shape[0], -1).all(axis=1)))
            raise GasError(f"source {name} is not finite in cell {cell}")


def _converged(time: float, residuals: dict[str, float], tolerance: float) -> None:
    for name, residual in residuals.items():
        if not residual <= tolerance:
            raise Unfinished(not_converged(name, time, residual))


def _known(sources: tuple[str, ...], box: Box) -> tuple[str, ...]:
    for name in sources:
        if name not in SOURCES:
            raise GasError(f"unknown source {name!r}; a gas solver knows {', '.join(SOURCES)}")
    if "vapour" in sources and box.vapour is None:
        raise GasError("the particles give off vapour or use it up, but the case has no [vapour]")
    return tuple(sources)
