"""The effects that a case can switch on, one file each, and the registry of them."""

from sdph.effects import (
    artificial_viscosity,
    conduction,
    density_diffusion,
    drag,
    drain,
    evaporation,
    frame,
    friction,
    gas_pressure,
    grain_shifting,
    granular_pressure,
    granular_temperature,
    granular_viscosity,
    gravity,
    heat,
    inflow,
    laminar_viscosity,
    liquid_damping,
    outflow,
    shifting,
    surface_tension,
    tank,
    walls,
    xsph,
)
from sdph.effects.effect import OFF, Effect, kernel_of

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
