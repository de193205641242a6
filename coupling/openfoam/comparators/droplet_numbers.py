"""Numbers that reactingParcelFoam wants in another form than a case has them, written as `constant/sdphDroplets`."""

from __future__ import annotations

import math

from coupling.openfoam.comparators import droplet_liquid
from coupling.openfoam.comparators.droplet_sources import Drops, velocities
from coupling.openfoam.comparators.two_fluid_numbers import divided, finest
from coupling.openfoam.poly_mesh import PolyMesh
from sdph.case.matter import Vapour
from sdph.case.sections import Case
from sdph.effects.gas.evaporation import ALWAYS
from sdph.laws import heat as heat_law

COURANT = 0.04  # of the fastest droplet or inlet; 2e-4 s in the paper's jet, where OpenFOAM was checked
API_DIFFUSION = 3.6059e-3  # OpenFOAM's APIdiffCoefFunc: D = 3.6059e-3 (1.8 T)^1.75 alpha/(p beta), with alpha = 1 here
GAS_LAWS = {"constant": "rhoConst", "operating": "incompressiblePerfectGas"}  # gas.equation_of_state -> OpenFOAM's
CORRECTORS = 2  # of the pressure on cells that are no boxes; our choice
REST = 10.0  # steps between two outputs of what stands still


def macros(case: Case, drops: Drops, courant: float = COURANT, mesh: PolyMesh | None = None) -> dict[str, str]:
    """Macros of the droplet template: name -> text; `mesh` is one of the case's own."""
    gas, vapour = case.gas, vapour_of(case)
    own, fit = case.parameters.get("evaporation"), droplet_liquid.fitted(case)
    numbers = {
        "gas_prandtl": heat_law.prandtl_number(gas.viscosity, gas.heat_capacity, gas.conductivity),
        "vapour_prandtl": heat_law.prandtl_number(vapour.viscosity, vapour.heat_capacity, vapour.conductivity),
        "species_molar_mass": vapour.molar_mass,
        "species_heat_capacity": vapour.heat_capacity,
        "species_viscosity": vapour.viscosity,
        "liquid_temperature": hottest(case, drops),
        "liquid_onset_temperature": (own and own.onset_temperature) or ALWAYS,
        "liquid_boiling_temperature": fit.boiling,
        "liquid_hottest": fit.end,
        **{f"liquid_pv_{name}": value for name, value in zip("abcd", fit.numbers)},
        "liquid_latent_heat": own.latent_heat if own else 0.0,
        "liquid_diffusion_volume": diffusion_volume(case, drops),
        "time_step": time_step(case, drops, courant, finest(case, mesh)),
        "correctors": CORRECTORS if mesh else 0,
    }
    words = {
        "gas_law": GAS_LAWS[gas.equation_of_state],
        "coupled": "false" if case.coupling.one_way else "true",
        "non_orthogonal": "corrected" if mesh else "orthogonal",
    }
    return {name: repr(value) for name, value in numbers.items()} | words


def vapour_of(case: Case) -> Vapour:
    """The vapour, or where nothing evaporates a species that is the gas."""
    gas = case.gas
    return case.vapour or Vapour(
        molar_mass=gas.molar_mass, diffusivity=gas.viscosity / gas.density, heat_capacity=gas.heat_capacity,
        conductivity=gas.conductivity, viscosity=gas.viscosity,
    )  # fmt: skip


def hottest(case: Case, drops: Drops) -> float:
    """Temperature [K] of the hottest droplets as they come in or are there at the start."""
    given = [nozzle.temperature for nozzle in case.nozzles.values()]
    return max([*given, *drops.temperature.tolist()])


def time_step(case: Case, drops: Drops, courant: float, cell: float) -> float:
    """Time step [s]: `courant` cells [m] of the fastest that comes in or is there at the start, or where all rests, of
    what falls through the domain."""
    speeds = [*(boundary.fastest for boundary in case.boundaries.values()), *velocities(case, drops)]
    fall = math.sqrt(2.0 * sum(abs(g) * size for g, size in zip(case.domain.gravity, case.domain.size)))
    fastest = max(speeds, default=0.0) or fall
    step = courant * cell / fastest if fastest else case.run.output_interval / REST
    return divided(case.run.output_interval, step)


def diffusion_volume(case: Case, drops: Drops) -> float:
    """The two volumes a = b of OpenFOAM's D with which it is the case's at the film temperature where evaporation
    starts: at the onset, or of the hottest droplets as they come in where these are hotter."""
    own = case.parameters.get("evaporation")
    begins = max((own and own.onset_temperature) or 0.0, hottest(case, drops))
    film = (2.0 * begins + case.gas.temperature) / 3.0  # OpenFOAM's surface values: T + (T_gas - T)/3
    beta = API_DIFFUSION * (1.8 * film) ** 1.75 / (case.gas.operating_pressure * vapour_of(case).diffusivity)
    return (beta / 4.0) ** 1.5  # beta = (a^(1/3) + b^(1/3))^2
