"""Amounts that particles and gas hand each other in a window of `sdph.exchange.exchange`."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from coupling.transfer import Weights
from sdph.engine.ledger import vector
from sdph.engine.world import here
from sdph.exchange import bursts


@dataclass(frozen=True)
class Loss:
    """Evaporation or burn-off in one window, of each particle: mass [kg], its effect on the sizes (see
    sdph.exchange.droplets and burning), condensation that was refused [kg], the rest of those that have finished [kg],
    and the energy of motion that goes with it [J]; `held`, shares of the particles that its limiters hold; `thrown`,
    vapour of torn droplets, where there are any; `slow`, a third effect on the sizes, of burn-off, and `terms`, what
    that tells the gas, as in `Handed`."""

    mass: np.ndarray
    still: np.ndarray
    moving: np.ndarray
    refused: np.ndarray
    rest: np.ndarray
    motion: np.ndarray
    held: dict[str, float] = field(default_factory=dict)
    thrown: bursts.Thrown | None = None
    slow: np.ndarray | None = None
    terms: dict[tuple[str, str], np.ndarray] = field(default_factory=dict)

    @property
    def vapour(self) -> np.ndarray:
        """All vapour (N,) [kg]."""
        return self.mass + self.thrown.mass if self.thrown else self.mass

    def warmth(self, temperature) -> np.ndarray:
        """All vapour times its temperature (N,) [kg K], where what evaporates has that of the particles (N,) [K]."""
        evaporated = self.mass * temperature
        return evaporated + self.thrown.warmth if self.thrown else evaporated


@dataclass(frozen=True)
class Handed:
    """Amounts that one window hands over: what the gas is told, and what the reaction is computed from.

    heat (N,) [W/K] and pull (N,) [W]: the particle takes heat * (T'_g - origin) - pull; drag (N,) [kg/s] is m_k
    f_k/dt; force (N, 3) [N] what the gas does besides, held over the window (no row where no effect does);
    temperature and velocity are those of the particles when they were computed; against (N, 3) [m/s] is that
    velocity less the eddies', which drag pulls to that of the gas, and eddies (N, 3) what turbulent_dispersion
    keeps; damping (N,) [1/s] is beta/(alpha_p rho_p); mass (N,) [kg] what is in the gas at the window's end. terms
    (C,) or (C, 3) per volume of the cells, by quantity and by what it comes from: a sum over effects
    ("conductance", counted from origin [K] on, "drag", "force"), or an effect; alpha_g (C,) at the window's end,
    where the gas is told; gone [kg m/s] the held impulse, summed by its length, of droplets that are gone at the
    window's end and do not get it; around: slip (N,) [m/s] and density (N,) [kg/m3] of the gas.
    """

    dt: float
    weights: Weights
    heat: np.ndarray
    pull: np.ndarray
    drag: np.ndarray
    force: np.ndarray
    damping: np.ndarray
    temperature: np.ndarray
    velocity: np.ndarray
    mass: np.ndarray
    loss: Loss | None
    origin: float
    terms: dict[tuple[str, str], np.ndarray] = field(default_factory=dict)
    alpha_g: np.ndarray | None = None
    gone: float = 0.0
    around: tuple = ()
    against: np.ndarray | None = None
    eddies: np.ndarray | None = None

    def columns(self) -> dict[str, float]:
        """Amounts that were held back or given at once, for the ledger."""
        rest = float(self.loss.rest.sum()) if self.loss else 0.0
        thrown = float(self.loss.thrown.mass.sum()) if self.loss and self.loss.thrown else 0.0
        return {"finished_kg": rest, "thrown_kg": thrown, "impulse_of_gone_kg_m_s": self.gone}

    def held(self) -> dict[str, float]:
        """Particles beside the mesh and shares that limiters of the exchange hold, by column of history.csv."""
        return outside(self.weights) | (self.loss.held if self.loss else {})

    @property
    def sources(self) -> dict[str, np.ndarray]:
        """Sources as the gas is told them: each quantity is the sum of what is given to it."""
        told = {} if self.alpha_g is None else {"alpha_g": self.alpha_g}
        for (quantity, _), values in self.terms.items():
            told[quantity] = told[quantity] + values if quantity in told else values
        if "heat_coefficient" in told:
            told["heat"] = told["heat"] + self.origin * told["heat_coefficient"]
        return {name: np.ascontiguousarray(values) for name, values in told.items()}


def outside(weights) -> dict[str, float]:
    """Particles that cover no cell of the mesh, of all processes: a column of history.csv."""
    return {"outside_mesh_particles": float(here().sum(len(weights.outside)))}


@dataclass(frozen=True)
class Taken:
    """Reaction on the particles in a window: heat (N,) [J], impulse (N, 3) [kg m/s]; and what the gas gave by its own
    sum, of momentum by its force (C, 3) [N/m3] too.

    lost (N,) [J] is what leaves the system to its surroundings (no entry where no effect gives any); warming (N,) [J]
    the heat less that and less that of evaporation, or with that of a reaction; vapour and reacted [kg] what left
    particles, vapour_to_gas and carrier_to_gas [kg] what the gas got; latent_heat [J] and capacity_heat [J] what
    evaporation binds, and what the other heat capacity of what comes does, reaction_heat [J] what is set free;
    vapour_motion [J] the energy of motion that went with it, vapour_impulse (3,) [kg m/s] what it brought to the gas.
    """

    heat: np.ndarray
    warming: np.ndarray
    impulse: np.ndarray
    heat_from_gas: float
    impulse_from_gas: np.ndarray
    force: np.ndarray
    lost: np.ndarray = field(default_factory=lambda: np.zeros(0))
    vapour: float = 0.0
    vapour_to_gas: float = 0.0
    reacted: float = 0.0
    carrier_to_gas: float = 0.0
    reaction_heat: float = 0.0
    latent_heat: float = 0.0
    capacity_heat: float = 0.0
    refused: float = 0.0
    vapour_motion: float = 0.0
    vapour_impulse: np.ndarray = field(default_factory=lambda: np.zeros(3))

    def columns(self) -> dict[str, float]:
        """The particles' side of the exchange for the ledger."""
        vapour = {
            "heat_to_particles_J": float(self.heat.sum()),
            "evaporated_kg": self.vapour,
            "condensation_refused_kg": self.refused,
            "vapour_motion_J": self.vapour_motion,
            "reacted_kg": self.reacted,
            "reaction_heat_J": self.reaction_heat,
        }
        bound = {"latent_heat_J": self.latent_heat, "capacity_heat_J": self.capacity_heat}
        bound |= {"heat_to_surroundings_J": float(self.lost.sum())}
        return vapour | bound | vector("impulse_to_particles", np.einsum("ij->j", self.impulse))

    def columns_of_gas(self) -> dict[str, float]:
        """The gas's side, by its own sums over the cells."""
        got = {"heat_to_gas_J": -self.heat_from_gas, "vapour_to_gas_kg": self.vapour_to_gas}
        got |= {"carrier_to_gas_kg": self.carrier_to_gas}
        return got | vector("impulse_to_gas", -self.impulse_from_gas) | vector("impulse_of_vapour", self.vapour_impulse)
