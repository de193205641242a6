"""Constants of a run (`Box`), the state that every window hands on to the next (`Flow`), and the input of one
(`Window`)."""

from __future__ import annotations

import dataclasses

import numpy as np

from coupling.embedded import boundaries
from coupling.embedded.grid import Grid
from coupling.embedded.properties import Properties
from coupling.gas import IMPULSES, refuse_full_cells
from sdph.laws.constants import ROUND_OFF

MOST = 1e4  # times its usual density that a gas may have; our choice


class Box:
    """Grid, boundaries and properties of a case; `limited` False takes upwind instead of van Leer."""

    def __init__(self, case, grid: Grid, limited: bool):
        self.grid, self.limited = grid, limited
        self.properties = Properties(case)
        self.faces, self.names = boundaries.boundary_faces(case, grid), tuple(case.boundaries)
        self.gravity = case.domain.gravity
        self.tolerance = case.coupling.gas_tolerance
        self.temperature = case.gas.temperature
        self.vapour = case.vapour
        self.everywhere = np.zeros(grid.size, dtype=bool)
        self.everywhere[grid.cells] = True
        self.case, self.unsteady = case, any(boundary.velocities for boundary in case.boundaries.values())

    def blow(self, begin: float, end: float) -> bool:
        """Give the inlets their mean velocities from `begin` to `end` [s]; True where any changes in time."""
        if self.unsteady:
            self.faces = boundaries.blown(self.case, self.faces, begin, end)
        return self.unsteady

    @property
    def closed(self) -> bool:
        """True where nothing opens to a given pressure."""
        return not self.faces.open.any()

    def outward(self, flux: np.ndarray) -> np.ndarray:
        """(B,) what a face field (d, S) takes out through each boundary face."""
        return self.faces.sign * flux[self.faces.axis, self.faces.face]


@dataclasses.dataclass
class Flow:
    """All that the next window needs. Cells (S,): alpha, mass, vapour [kg], temperature [K], pressure [Pa];
    faces (d, S): velocity [m/s], flux [kg/s]; `ratio` of the density to the equation of state; what came in
    through the boundary since the start [kg, J, kg, J]; works since the start [J], see `coupling.gas.Budget`, and the
    `impulses` (6, 3) [kg m/s] of `coupling.gas.IMPULSES`; on_patches (P, 3, 3) those of each boundary, and crossed
    (P, 4) [kg, kg, J, kg] what passed it."""

    time: float
    alpha: np.ndarray
    mass: np.ndarray
    vapour: np.ndarray
    temperature: np.ndarray
    pressure: np.ndarray
    velocity: np.ndarray
    flux: np.ndarray
    impulses: np.ndarray
    on_patches: np.ndarray
    crossed: np.ndarray
    ratio: float = 1.0
    mass_in: float = 0.0
    energy_in: float = 0.0
    vapour_in: float = 0.0
    kinetic_in: float = 0.0
    pressure_work: float = 0.0
    boundary_work: float = 0.0
    gravity_work: float = 0.0
    viscous_work: float = 0.0

    def fraction(self):
        """Mass fraction of vapour in the cells, 0 in ghosts."""
        return np.divide(self.vapour, self.mass, out=np.zeros_like(self.mass), where=self.mass > 0.0)


def restored(box: Box, saved: dict[str, np.ndarray]) -> Flow:
    """The flow from its saved attributes (name -> array); ValueError where they are not of this box or no gas is like
    that."""
    cells, faces = (box.grid.size,), (box.grid.dimensions, box.grid.size)
    shapes = {"velocity": faces, "flux": faces, "impulses": (len(IMPULSES), 3)}
    shapes |= {"on_patches": (len(box.names), 3, 3), "crossed": (len(box.names), 4)}
    for field in dataclasses.fields(Flow):
        value = saved[field.name]
        shape = () if field.type == "float" else shapes.get(field.name, cells)
        if value.dtype != np.float64 or value.shape != shape:
            raise ValueError(
                f"{field.name} is {value.dtype} of shape {value.shape}; this mesh has float64 of shape {shape}"
            )
        if not np.isfinite(value).all():
            raise ValueError(f"{field.name} is not finite everywhere")
    flow = Flow(
        **{
            field.name: value if (value := saved[field.name]).ndim else float(value)
            for field in dataclasses.fields(Flow)
        }
    )
    inside, usual = box.grid.cells, box.properties.density(box.temperature, 0.0)
    for name in ("alpha", "mass", "temperature"):
        if not (getattr(flow, name)[inside] > 0.0).all():
            raise ValueError(f"{name} is not above 0 everywhere")
    times = flow.mass[inside] / (flow.alpha[inside] * box.grid.geometry.volume[inside] * usual)
    if not (times.min() > 1.0 / MOST and times.max() < MOST and 1.0 / MOST < flow.ratio < MOST):
        raise ValueError(f"its density is not within {MOST:g} times that of this case")
    if flow.alpha[inside].max() > 1.0 + ROUND_OFF or np.abs(flow.vapour).max() > flow.mass.max() or flow.time < 0.0:
        raise ValueError("its volume fraction, its vapour or its time cannot be")
    return flow


@dataclasses.dataclass(frozen=True)
class Window:
    """One window: dt [s], alpha (S,) at its end, and per cell, not per volume, what the particles do:
    pull (S,) [kg/s] and push (d, S) [N], vapour and carrier (S,) [kg/s], cling (S,) [W/K], warmth (S,) [W]."""

    dt: float
    alpha: np.ndarray
    pull: np.ndarray
    push: np.ndarray
    vapour: np.ndarray
    carrier: np.ndarray
    cling: np.ndarray
    warmth: np.ndarray

    @property
    def mass(self) -> np.ndarray:
        """Mass (S,) [kg/s] that enters the gas."""
        return self.vapour + self.carrier

    @property
    def given(self) -> np.ndarray:
        """Vapour (S,) [kg/s] that enters the gas where none is used up."""
        return np.maximum(self.vapour, 0.0)


def window_of(box: Box, flow: Flow, dt: float, sources: dict[str, np.ndarray]) -> Window:
    """The window that `sources` (see `coupling.gas.SOURCES`) describe."""
    grid, volume = box.grid, box.grid.geometry.volume

    def total(*names: str) -> np.ndarray:
        given = [sources[name] for name in names if name in sources]
        return grid.padded(sum(given)) * volume if given else grid.zeros()

    def push() -> np.ndarray:
        if "momentum" not in sources:
            return grid.zeros(grid.dimensions)
        return np.stack([grid.padded(sources["momentum"][:, a]) * volume for a in range(grid.dimensions)])

    alpha = grid.extended(grid.padded(sources["alpha_g"])) if "alpha_g" in sources else flow.alpha
    refuse_full_cells(alpha[grid.cells], grid.centres)
    return Window(
        dt=dt, alpha=alpha, pull=total("momentum_coefficient", "vapour", "carrier"), vapour=total("vapour"),
        carrier=total("carrier"), cling=total("heat_coefficient"), push=push(), warmth=total("heat"),
    )  # fmt: skip
