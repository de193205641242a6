"""The one door between the particles and any gas solver.

A gas solver owns a finite-volume mesh and the gas fields on it. Once per window it is handed what the
particles do to it (`SOURCES`), takes one step, and hands back its fields (`FIELDS`) and its `Budget`.
Cells are numbered 0..C-1; vectors are (C, 3) also in two dimensions; every array is float64.
Two-dimensional meshes are one cell deep; volumes stay the real ones, and `Mesh.depth` says how deep.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol

import numpy as np

# What the particles hand to the gas, by quantity, whatever effects it comes from: into the gas go `momentum` -
# `momentum_coefficient` u and `heat` - `heat_coefficient` T. What no effect sends costs nothing.
# name -> (unit, components, meaning)
SOURCES = {
    "alpha_g": ("1", 1, "gas volume fraction at the end of the window"),
    "momentum": ("N/m3", 3, "momentum that enters the gas: beta v_p of drag, Gamma v_p of mass"),
    "momentum_coefficient": ("kg/m3/s", 1, "beta, taken times the new velocity of the gas from that"),
    "heat": ("W/m3", 1, "heat that enters the gas: eps T_p, heat of drag, enthalpy Gamma cp_v T_p of mass"),
    "heat_coefficient": ("W/m3/K", 1, "eps, taken times the new temperature of the gas from that"),
    "vapour": ("kg/m3/s", 1, "mass of vapour Gamma that enters the gas; below 0 what is used up, before it flows on"),
    "carrier": ("kg/m3/s", 1, "mass of the rest of the gas that enters it; mass of the gas grows by both"),
}

USED_UP = 1e-9  # of the gas in a cell: most of its vapour that it may lack when some is used up; round-off, our choice

# What the gas hands back after a step.
FIELDS = {
    "velocity": ("m/s", 3, "interstitial gas velocity"),
    "pressure": ("Pa", 1, "gas pressure"),
    "pressure_gradient": ("Pa/m", 3, "gradient of the gas pressure, as the momentum equation saw it"),
    "temperature": ("K", 1, "gas temperature"),
    "density": ("kg/m3", 1, "gas density"),
    "power": ("W/m3", 1, "power of what the particles gave in `momentum` and `momentum_coefficient`, in the last step"),
    "vapour_mass_fraction": ("1", 1, "mass fraction of vapour (only where a vapour is solved for)"),
}

# What it hands back besides, where an effect asks for it at the start.
ON_REQUEST = {
    "vorticity": ("1/s", 3, "curl of the velocity"),
    "turbulent_energy": ("m2/s2", 1, "k of a model of turbulence"),
    "turbulent_dissipation": ("m2/s3", 1, "epsilon of a model of turbulence"),
    "turbulent_energy_gradient": ("m/s2", 3, "gradient of k"),
}


# What moves the gas: names of `Budget` whose growth is that of its momentum, but for what is numerical.
IMPULSES = ("momentum_in", "impulse_pressure", "impulse_walls", "impulse_gravity", "impulse_exchange", "impulse_room")
NOTHING = (0.0, 0.0, 0.0)


class GasError(RuntimeError):
    """The gas side failed: what happened, and where its log is."""


class Unfinished(GasError):
    """A window that the gas could not finish: not a number, out of bounds, not converged. `Gas.retreat` goes back
    before it."""


class CheckpointError(GasError):
    """A checkpoint that a gas solver cannot go on from: what is wrong with it."""


@dataclass(frozen=True)
class Mesh:
    """Cells of the gas solver.

    centres (C, 3) [m]; volumes (C,) [m3]; dimensions 2 or 3; depth [m] of a 2-D mesh (1 in 3-D). `spread` is places
    (M, 3) [m] that fill the cells evenly and the cell (M,) of each, of a mesh that does not fill its box.
    """

    centres: np.ndarray
    volumes: np.ndarray
    dimensions: int
    depth: float = 1.0
    spread: tuple[np.ndarray, np.ndarray] | None = None

    def fills(self, box) -> bool:
        """True where the cells fill a box of sides (d,) [m]."""
        return bool(np.isclose(np.prod(box) * self.depth, self.volumes.sum(), rtol=1e-9))


@dataclass(frozen=True)
class Budget:
    """Totals over the mesh, and what crossed the boundary since the start of the run (in minus out).

    mass [kg], energy [J] (enthalpy, sum of alpha rho cp T V, reference 0 K), kinetic [J] (sum of alpha rho U^2/2 V),
    vapour [kg], momentum (3,) [kg m/s] of the gas; `*_in` the same through the boundaries. `pressure_work` [J] is what
    alpha U.grad p gave the enthalpy since the start, out of the motion of the gas; `boundary_work` [J] what that motion
    got from the pressure besides; `gravity_work` [J] what gravity gave it; `viscous_work` [J] what its viscous stress
    gave it, below 0 but for walls that slide. In works and powers U is the mean of the velocities before and after a
    step.

    Impulses (3,) [kg m/s] as given to the gas since the start, each integrated where it acts: `impulse_pressure` of
    the pressure on boundary faces, -p S; `impulse_walls` of the viscous stress on them; `impulse_gravity`;
    `impulse_exchange` of `momentum` and `momentum_coefficient` of the particles; `impulse_room` of the pressure on the
    room of the particles, (1 - alpha) grad p, since the equation has -alpha grad p. What `momentum` grew by besides
    these and `momentum_in` is numerical. `courant` is the largest Courant number of the last step.
    `residuals` names the final linear-solver residual of each equation, `held` what limiters of the gas took in the
    last step, by column of history.csv, each 0 or more (docs/limiters.md).

    `patches` has by name of a boundary (3, 3) what it gave since the start: its parts of `impulse_pressure` and of
    `impulse_walls` [kg m/s], and the moment of both about the origin [kg m2/s]; `crossed` (4,) what gas came in
    through it [kg], and what left through it: gas [kg], its enthalpy cp T [J], vapour [kg].
    """

    mass: float
    energy: float
    vapour: float
    momentum: tuple[float, float, float]
    mass_in: float
    energy_in: float
    vapour_in: float
    courant: float
    kinetic: float = 0.0
    kinetic_in: float = 0.0
    pressure_work: float = 0.0
    boundary_work: float = 0.0
    gravity_work: float = 0.0
    viscous_work: float = 0.0
    momentum_in: tuple[float, float, float] = NOTHING
    impulse_pressure: tuple[float, float, float] = NOTHING
    impulse_walls: tuple[float, float, float] = NOTHING
    impulse_gravity: tuple[float, float, float] = NOTHING
    impulse_exchange: tuple[float, float, float] = NOTHING
    impulse_room: tuple[float, float, float] = NOTHING
    residuals: dict[str, float] = field(default_factory=dict)
    held: dict[str, float] = field(default_factory=dict)
    patches: dict[str, list] = field(default_factory=dict)
    crossed: dict[str, list] = field(default_factory=dict)


@dataclass(frozen=True)
class GasState:
    """Fields of the gas (name -> array, see `FIELDS` and `ON_REQUEST`) at `time` [s], and its budget."""

    time: float
    fields: dict[str, np.ndarray]
    budget: Budget


def known_fields(names) -> tuple[str, ...]:
    """The names of fields that are asked for; GasError where one is not among `ON_REQUEST`."""
    for name in names:
        if name not in ON_REQUEST:
            raise GasError(f"unknown field {name!r}; on request a gas solver hands {', '.join(ON_REQUEST)}")
    return tuple(names)


def refuse_full_cells(alpha_g: np.ndarray, centres: np.ndarray) -> None:
    """`Unfinished` where the voidage (C,) leaves the gas no room; `centres` (C, d) [m] of the cells."""
    if not alpha_g.min() > 0.0:
        cell = int(np.argmin(alpha_g))
        place = ", ".join(f"{a:.4g}" for a in centres[cell])
        raise Unfinished(
            f"alpha_g is {alpha_g[cell]:g} in cell {cell} at ({place}) m; the gas needs some room: the cell is "
            "over-packed"
        )


class Gas(Protocol):
    """A gas solver. `advance` raises `GasError` when the solver fails or does not answer, `Unfinished` where a shorter
    step may do."""

    mesh: Mesh

    def start(self, alpha_g: np.ndarray | None, sources: tuple[str, ...], fields: tuple[str, ...] = ()) -> GasState:
        """Initial fields; `alpha_g` is the gas volume fraction at the start (None: 1 everywhere), `sources` names
        what every later `advance` brings, `fields` what of `ON_REQUEST` every state holds."""

    def advance(self, dt: float, sources: dict[str, np.ndarray]) -> GasState:
        """One step of `dt` [s] with the sources held over it, except `alpha_g`, which goes linearly
        from its last value to the one given."""

    def retreat(self) -> GasState:
        """Go back to where the last `advance` began, finished or not; bit for bit."""

    def checkpoint(self, folder: Path) -> None:
        """Write all that `restore` needs to go on bit for bit into `folder`."""

    def restore(self, folder: Path, sources: tuple[str, ...] | None = None, fields: tuple[str, ...] = ()) -> GasState:
        """Go back to a checkpoint, instead of `start`; `sources` (None: those of the checkpoint) and `fields` as there.
        `CheckpointError` where it is not whole, or of another mesh or other sources."""

    def close(self) -> None:
        """End the solver; nothing is left running."""
