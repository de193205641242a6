"""The effects that a case can switch on, one file each, and the registry of them."""

from sdph.effects.around import drain, frame, gravity, inflow, outflow, tank, walls
from sdph.effects.effect import OFF, Effect, kernel_of
from sdph.effects.gas import drag, evaporation, gas_pressure, heat
from sdph.effects.grains import (
    artificial_viscosity,
    conduction,
    friction,
    grain_shifting,
    granular_pressure,
    granular_temperature,
    granular_viscosity,
)
from sdph.effects.liquids import density_diffusion, laminar_viscosity, liquid_damping, shifting, surface_tension, xsph

FILES = (
    drag,
    gas_pressure,
    gravity,
    granular_pressure,
    friction,
    granular_viscosity,
    granular_temperature,
    artificial_viscosity,
    grain_shifting,
    walls,
    heat,
    conduction,
    density_diffusion,
    laminar_viscosity,
    liquid_damping,
    shifting,
    surface_tension,
    xsph,
    tank,
    frame,
    drain,
    evaporation,
    inflow,
    outflow,
)
REGISTRY: dict[str, Effect] = {file.EFFECT.name: file.EFFECT for file in FILES}


def moving(case) -> bool:
    """Tell whether an effect that is on moves grains."""
    return any(REGISTRY[name].moves for name in case.effects)


__all__ = ["OFF", "REGISTRY", "Effect", "kernel_of", "moving"]
