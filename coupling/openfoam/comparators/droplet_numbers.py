"""Numbers that reactingParcelFoam wants in another form than a case has them: `constant/sdphDroplets`,
`constant/nozzle`."""

from __future__ import annotations

import math
from dataclasses import dataclass

from coupling.openfoam.comparators.two_fluid_numbers import divided
from sdph.case.sections import Case
from sdph.laws import heat as heat_law

COURANT = 0.04  # of the droplets; 2e-4 s in the paper's jet, where OpenFOAM was checked
API_DIFFUSION = 3.6059e-3  # OpenFOAM's APIdiffCoefFunc: D = 3.6059e-3 (1.8 T)^1.75 alpha/(p beta), with alpha = 1 here


@dataclass(frozen=True)
class Nozzle:
    """A slot in the left wall that droplets come from: middle and width along y [m], speed [m/s] along x,
    temperature [K], volume fraction of liquid [-]."""

    middle: float
    width: float
    speed: float
    temperature: float
    volume_fraction: float

    def mass(self, case: Case) -> float:
        """Liquid [kg] that comes in during the run, per metre of depth."""
        return self.volume_fraction * case.grains.density * self.speed * self.width * case.run.end_time

    def duration(self, case: Case) -> float:
        """Time [s] in which it comes in."""
        return case.run.end_time

    def places(self, case: Case) -> list[tuple[float, float]]:
        """Points [m] that parcels start from: one per particle spacing across the slot, just inside the wall."""
        count = round(self.width / case.resolution.spacing)
        return [(1e-6, self.middle + self.width * ((i + 0.5) / count - 0.5)) for i in range(count)]


@dataclass(frozen=True)
class Plug:
    """Droplets that are there at the start, over the whole height of the domain: ends along x [m], speed [m/s] along
    x, temperature [K], volume fraction of liquid [-]."""

    ends: tuple[float, float]
    speed: float
    temperature: float
    volume_fraction: float

    def mass(self, case: Case) -> float:
        """Liquid [kg] per metre of depth."""
        return self.volume_fraction * case.grains.density * (self.ends[1] - self.ends[0]) * case.domain.size[1]

    def duration(self, case: Case) -> float:
        """Time [s] of the one step in which it comes in."""
        return time_step(case, self)

    def places(self, case: Case) -> list[tuple[float, float]]:
        """Points [m] that parcels start from: a lattice of the particle spacing."""
        dx = case.resolution.spacing
        along, up = round((self.ends[1] - self.ends[0]) / dx), round(case.domain.size[1] / dx)
        return [(self.ends[0] + (i + 0.5) * dx, (j + 0.5) * dx) for i in range(along) for j in range(up)]


@dataclass(frozen=True)
class Liquid:
    """Evaporation data of the droplets: onset temperature [K], saturation pressure [Pa], latent heat [J/kg]."""

    onset_temperature: float
    saturation_pressure: float
    latent_heat: float


def macros(case: Case, source: Nozzle | Plug, liquid: Liquid, courant: float = COURANT) -> dict[str, str]:
    """Macros of the droplet templates: name -> text."""
    gas, vapour, dt = case.gas, case.vapour, time_step(case, source, courant)
    return {
        "gas_prandtl": repr(heat_law.prandtl_number(gas.viscosity, gas.heat_capacity, gas.conductivity)),
        "vapour_prandtl": repr(heat_law.prandtl_number(vapour.viscosity, vapour.heat_capacity, vapour.conductivity)),
        "liquid_onset_temperature": repr(liquid.onset_temperature),
        "liquid_log_saturation_pressure": repr(math.log(liquid.saturation_pressure)),
        "liquid_latent_heat": repr(liquid.latent_heat),
        "liquid_diffusion_volume": repr(diffusion_volume(case, source, liquid)),
        "nozzle_temperature": repr(source.temperature),
        "nozzle_mass": repr(source.mass(case)),
        "nozzle_duration": repr(source.duration(case)),
        "nozzle_rows_per_second": repr((1.0 + 1e-9) / dt),  # each row once a step: its number is rounded down
        "time_step": repr(dt),
    }


def time_step(case: Case, source: Nozzle | Plug, courant: float = COURANT) -> float:
    """Time step [s]."""
    return divided(case.run.output_interval, courant * case.resolution.cell / source.speed)


def diffusion_volume(case: Case, source: Nozzle | Plug, liquid: Liquid) -> float:
    """The two volumes a = b of OpenFOAM's D with which it is the case's at the film temperature where evaporation
    starts: at the onset, or in the nozzle where that is hotter."""
    begins = max(liquid.onset_temperature, source.temperature)
    film = (2.0 * begins + case.gas.temperature) / 3.0  # OpenFOAM's surface values: T + (T_gas - T)/3
    beta = API_DIFFUSION * (1.8 * film) ** 1.75 / (case.gas.operating_pressure * case.vapour.diffusivity)
    return (beta / 4.0) ** 1.5  # beta = (a^(1/3) + b^(1/3))^2


def source_rows(case: Case, source: Nozzle | Plug) -> str:
    """OpenFOAM's table of injectors."""
    places, grains = source.places(case), case.grains
    each = source.mass(case) / source.duration(case) / len(places)
    tail = (
        f"{grains.diameter!r} {grains.density!r} {each!r} {source.temperature!r} {grains.heat_capacity!r} (0 1 0) "
        "() (1) ()"
    )
    rows = "".join(f"({x!r} {y!r} 0.5) ({source.speed!r} 0 0) {tail}\n" for x, y in places)
    return f"(\n{rows})\n"
