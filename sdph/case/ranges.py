"""Ranges of values that are possible, by key: beyond them a value is a slip of a unit, as a rule (sdph.case.usual).

Bounds are our choice, a factor of two or more beyond what tables of matter hold, unless a line says otherwise.
"""

from __future__ import annotations

from typing import NamedTuple

CELSIUS = "degrees Celsius"


class Range(NamedTuple):
    """Least and most of a key, in its unit; what lies there; and units that are given by mistake, with their factor."""

    least: float
    most: float
    what: str
    slips: tuple = ()


OF_GRAINS = Range(5.0, 25000.0, "from foam to gold", (("g/cm3", 1e3),))
TEMPERATURE = Range(200.0, 5000.0, "from dry ice to where all is vapour", ((CELSIUS, 273.15),))
OF_COLD = Range(1.0, 5000.0, "from liquid helium to where all is vapour", ((CELSIUS, 273.15),))  # see sdph.case.usual
# a micrometre is finer than any powder that flows, and 0.3 to 1 mm, given in metres, is below it
SIZE = Range(1e-3, 100.0, "from fine dust to stones", (("m", 1e3), ("um", 1e-3)))
CAPACITY = Range(100.0, 20000.0, "from xenon to hydrogen", (("kJ/(kg K)", 1e3),))
MOLAR = Range(2.0, 2000.0, "from hydrogen to a polymer", (("kg/mol", 1e3),))
TENSION = Range(1e-5, 5.0, "from near the critical point to molten metal", (("mN/m", 1e-3),))
SPEED = Range(1e-6, 3000.0, "from creep to a rocket's exhaust", (("mm/s", 1e-3),))
PRESSURE = Range(500.0, 1e9, "from a drying vacuum to a gun", (("bar", 1e5), ("kPa", 1e3)))
OF_STIFFNESS = ("GPa", 1e9), ("MPa", 1e6)
MODULUS = Range(10.0, 5e12, "from jelly to diamond", OF_STIFFNESS)
# pattern of a key -> its range; * is a name. Our choice: a factor of two or more beyond what tables of matter hold
USUAL = {
    "domain.gravity_m_s2": Range(1e-7, 200.0, "from a free fall in orbit to a fast turn", (("mm/s2", 1e-3),)),
    "gas.temperature_K": TEMPERATURE, "particles.*.temperature_K": TEMPERATURE, "nozzles.*.temperature_K": TEMPERATURE,
    "boundaries.*.temperature_K": TEMPERATURE, "parts.*.temperature_K": TEMPERATURE,
    "evaporation.onset_temperature_K": TEMPERATURE, "evaporation.boiling_temperature_K": TEMPERATURE,
    "evaporation.saturation_temperature_K": TEMPERATURE,
    "gas.density_kg_m3": Range(1e-4, 500.0, "from a vacuum pump to carbon dioxide at 200 bar",
                               (("g/cm3", 1e3), ("g/m3", 1e-3))),
    "gas.viscosity_Pa_s": Range(1e-6, 5e-4, "from vapours to gas at 10 000 K",
                                (("mPa s", 1e-3), ("uPa s", 1e-6))),
    "gas.conductivity_W_m_K": Range(1e-3, 5.0, "from vapours to hydrogen at 3000 K", (("mW/(m K)", 1e-3),)),
    "gas.heat_capacity_J_kg_K": CAPACITY, "vapour.heat_capacity_J_kg_K": CAPACITY,
    "grains.heat_capacity_J_kg_K": CAPACITY, "grains.*.heat_capacity_J_kg_K": CAPACITY,
    "gas.molar_mass_kg_kmol": MOLAR, "vapour.molar_mass_kg_kmol": MOLAR,
    "gas.operating_pressure_Pa": PRESSURE,
    "vapour.viscosity_Pa_s": Range(1e-6, 5e-4, "from vapours to gas at 10 000 K", (("mPa s", 1e-3), ("uPa s", 1e-6))),
    "vapour.conductivity_W_m_K": Range(1e-3, 5.0, "from vapours to hydrogen at 3000 K", (("mW/(m K)", 1e-3),)),
    "vapour.diffusivity_m2_s": Range(1e-9, 0.02, "from gas at 1000 bar to hydrogen in near vacuum",
                                     (("cm2/s", 1e-4), ("mm2/s", 1e-6))),
    "evaporation.latent_heat_J_kg": Range(1e4, 1e8, "from helium to metals", (("kJ/kg", 1e3),)),
    "grains.density_kg_m3": OF_GRAINS, "grains.*.density_kg_m3": OF_GRAINS,
    "grains.diameter_mm": SIZE, "grains.*.diameter_mm": SIZE, "nozzles.*.diameter_mm": SIZE,
    "grains.surface_tension_N_m": TENSION,
    "nozzles.*.speed_m_s": SPEED, "boundaries.*.velocity_m_s": SPEED, "particles.*.velocity_m_s": SPEED,
    "solid.youngs_modulus_Pa": MODULUS, "micro_explosion.youngs_modulus_Pa": MODULUS,
    "inflation.bulk_modulus_Pa": Range(1e4, 1e12, "from gas at a tenth of a bar to diamond", OF_STIFFNESS),
}  # fmt: skip
# the same of liquids and solids, in cases with units
OF_LIQUIDS = {
    "liquid.density_kg_m3": Range(50.0, 25000.0, "from liquid hydrogen to molten metal", (("g/cm3", 1e3),)),
    "solid.density_kg_m3": Range(5.0, 25000.0, "from foam to gold", (("g/cm3", 1e3),)),
    "gas_phase.density_kg_m3": Range(0.01, 25000.0, "from thin gas to molten metal", (("g/cm3", 1e3),)),
    "surface_tension.coefficient_N_m": TENSION, "free_energy_tension.coefficient_N_m": TENSION,
    "bubble.surface_tension_N_m": TENSION, "bubble.around_Pa": PRESSURE,
}  # fmt: skip
# keys of `sdph droplet`
OF_DROPLET = {"droplet.ambient_pressure_Pa": PRESSURE, "shell.youngs_modulus_Pa": MODULUS}
# What is denser is metal, mineral, ceramic (from 1 GPa on), PTFE (0.4 GPa) or rubber filled with them (from about 1 MPa
# on), while steel in MPa is 2e5: our choice. Lighter matter may be jelly, and its modulus in MPa is not seen
DENSE = 2000.0  # kg/m3
OF_DENSE = Range(1e6, 5e12, f"of what is denser than {DENSE:g} kg/m3, from filled rubber to diamond", OF_STIFFNESS)
# (key, key that it is divided by) -> range of the ratio: slips that no key shows alone. A pure crystal yields at 1e-5
# of its modulus, ideal ones and rubber at 0.1 and more; ten times as wide: our choice
OF_STRENGTH = Range(1e-6, 1.0, "from a pure crystal to rubber", OF_STIFFNESS)
RATIOS = {
    (f"{section}.{key}", f"{section}.youngs_modulus_Pa"): OF_STRENGTH
    for section in ("solid", "micro_explosion") for key in ("yield_stress_Pa", "hardening_Pa")
}  # fmt: skip
