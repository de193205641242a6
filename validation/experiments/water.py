"""Water, its vapour and dry air, as the case of a drop needs them; temperatures in K, pressures in Pa."""

from __future__ import annotations

from sdph.laws import evaporation, exact
from sdph.laws.constants import GAS_CONSTANT

ICE = 273.15  # K
ATMOSPHERE = 101325.0  # Pa, standard atmosphere (CGPM 1954)
MOLAR_MASS, DENSITY = 18.015, 998.2  # kg/kmol; kg/m3 at 293 K, of the feed (IAPWS)
AIR_MOLAR_MASS, AIR_HEAT_CAPACITY = 28.96, 1006.0  # kg/kmol; J/(kg K) at 300 K (Incropera)
# up to K: A, B, C of log10(p/bar) = A - B/(C + T), Bridgeman & Aldrich 1964 (NIST Chemistry WebBook)
ANTOINE = {303.5: (5.40221, 1838.675, -31.737), 333.0: (5.20389, 1733.926, -39.485)}
BAR = 5.0  # log10 Pa


def antoine(temperature: float) -> tuple[float, float, float]:
    """A [log10 Pa], B [K], C [K] of the fit for a temperature; 273 to 333 K."""
    a, b, c = next(fit for end, fit in ANTOINE.items() if temperature <= end)
    return a + BAR, b, c


def latent_heat(temperature: float) -> float:
    """h [J/kg], linear: 2501 kJ/kg at 0 C, 2.36 less by K (Rogers & Yau 1989; IAPWS to 0.1 % up to 60 C)."""
    return 2.501e6 - 2.36e3 * (temperature - ICE)


def diffusivity(temperature: float, pressure: float) -> float:
    """D [m2/s] of vapour in air. Massman 1998, Atmos. Environ. 32, 1111: 273 to 373 K."""
    return 0.2178e-4 * (temperature / ICE) ** 1.81 * ATMOSPHERE / pressure


def sutherland(temperature: float, at_ice: float, constant: float) -> float:
    """Viscosity or conductivity of a gas, with its value at 273.15 K and Sutherland's constant [K]."""
    return at_ice * (temperature / ICE) ** 1.5 * (ICE + constant) / (temperature + constant)


def air(temperature: float, pressure: float) -> dict[str, float]:
    """Keys of [gas] of dry air. Sutherland's numbers: White 2006, Viscous Fluid Flow, tables 1-2 and 1-3."""
    return {
        "density_kg_m3": pressure * AIR_MOLAR_MASS / (GAS_CONSTANT * temperature),
        "viscosity_Pa_s": sutherland(temperature, 1.716e-5, 111.0),
        "conductivity_W_m_K": sutherland(temperature, 0.0241, 194.0),
        "heat_capacity_J_kg_K": AIR_HEAT_CAPACITY,
        "operating_pressure_Pa": pressure,
    }


def vapour(film: float, pressure: float) -> dict[str, float]:
    """Keys of [vapour]; heat capacity at 300 K (Incropera), as is conductivity, which one drop does not use."""
    return {
        "molar_mass_kg_kmol": MOLAR_MASS,
        "diffusivity_m2_s": diffusivity(film, pressure),
        "heat_capacity_J_kg_K": 1872.0,
        "conductivity_W_m_K": 0.0196,
        "viscosity_Pa_s": 9.09e-6,
    }


def wet_bulb(air_temperature: float, pressure: float) -> float:
    """T [K] of a drop in dry air by the closed form with Nu = Sh, the air as it is midway between both.

    It only says where the properties of a run are taken.
    """
    drop = 293.0
    for _ in range(20):  # a fixed point that each step comes several times nearer to
        film, own = 0.5 * (air_temperature + drop), antoine(drop)
        drop = exact.wet_bulb_temperature(
            air_temperature,
            lambda T, own=own: evaporation.saturation_antoine(T, own),
            diffusivity(film, pressure),
            MOLAR_MASS,
            latent_heat(drop),
            air(film, pressure)["conductivity_W_m_K"],
        )
    return drop
