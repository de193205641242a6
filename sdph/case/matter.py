"""Sections of a case about the gas, its turbulence, vapour and the material of grains."""

from __future__ import annotations

from sdph.laws.break_up import sauter_diameter
from sdph.schema import choice, quantity, record, section, words

STANDARD_ATMOSPHERE = 101325.0  # Pa, ISO 2533


@record
class Turbulence:
    """Turbulence of the gas by a model of OpenFOAM's library: eddy viscosity, and with it diffusion and conduction. k,
    epsilon and omega are those of gas that flows in, and of all of it at the start."""

    model: str = choice("laminar", "kEpsilon", "kOmegaSST", "WALE")
    schmidt_number: float = quantity("", 0.7, above=0.0)  # Fluent's default (theory guide)
    prandtl_number: float = quantity("", 0.85, above=0.0)  # the same
    intensity: float = quantity("", 0.05, above=0.0, most=10.0)  # medium, as in Fluent and OpenFOAM's tutorials
    mixing_length: float | None = quantity("m", None, above=0.0)
    k: float | None = quantity("m2_s2", None, above=0.0)
    epsilon: float | None = quantity("m2_s3", None, above=0.0)
    omega: float | None = quantity("1_s", None, above=0.0)


@record
class GasProperties:
    fluid: str = words("")  # of CoolProp: fills what is left out (sdph.case.fluids)
    density: float = quantity("kg_m3", above=0.0)
    viscosity: float = quantity("Pa_s", above=0.0)
    conductivity: float = quantity("W_m_K", above=0.0)
    heat_capacity: float = quantity("J_kg_K", above=0.0)
    temperature: float = quantity("K", above=0.0)
    equation_of_state: str = choice("constant", "operating", "ideal")
    molar_mass: float = quantity("kg_kmol", 28.96, above=0.0)  # dry air, ISO 2533
    operating_pressure: float = quantity("Pa", STANDARD_ATMOSPHERE, above=0.0)
    turbulence: Turbulence | None = section(Turbulence)

    @property
    def turbulent(self) -> bool:
        """True where a model of turbulence is on."""
        return self.turbulence is not None and self.turbulence.model != "laminar"


@record
class Vapour:
    """The species of the gas that droplets give to it, or that burns grains."""

    mass_fraction: float = quantity("", 0.0, least=0.0, most=1.0)  # of the gas at the start
    molar_mass: float = quantity("kg_kmol", above=0.0)
    diffusivity: float = quantity("m2_s", above=0.0)
    heat_capacity: float = quantity("J_kg_K", above=0.0)
    conductivity: float = quantity("W_m_K", above=0.0)
    viscosity: float = quantity("Pa_s", above=0.0)


@record
class Grains:
    """Grains of one material; each SPH particle carries a log-normal distribution of diameters (by number). Of several
    materials (sdph.case.materials) each has a section of its own."""

    fluid: str = words("")  # of droplets: fills what is left out, of evaporation and vapour too (sdph.case.fluids)
    # that its numbers are taken at; none: the mean of what regions and nozzles give
    fluid_temperature: float | None = quantity("K", None, above=0.0)
    density: float = quantity("kg_m3", above=0.0)
    diameter: float = quantity("mm", above=0.0)
    heat_capacity: float = quantity("J_kg_K", above=0.0)
    conductivity: float = quantity("W_m_K", above=0.0, tiny=True)  # grains may insulate
    diameter_std: float = quantity("mm", 0.0, least=0.0)
    # not in the paper: Fluent's default (sdph-notes, section 2)
    restitution: float = quantity("", 0.9, least=0.0, most=0.9999)
    packing_limit: float = quantity("", 0.63, above=0.0, most=0.74)  # the same
    # of droplets: for Weber and Bond numbers of `sdph explain`
    surface_tension: float | None = quantity("N_m", None, above=0.0)
    granular_temperature: float = quantity("m2_s2", 1e-4, least=0.0)  # at the start; the same

    @property
    def sauter_diameter(self) -> float:
        """<d^3>/<d^2> [m] of the sizes at the start: that of grains with as much surface for their volume."""
        return sauter_diameter(self.diameter, self.diameter_std**2)

    @property
    def of_particles(self) -> tuple[float, float, float]:
        """Density [kg/m3], specific heat [J/kg/K], conductivity [W/m/K]: OF_MATERIAL of sdph.engine.state, but the
        first."""
        return self.density, self.heat_capacity, self.conductivity
