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
from sdph.effects.effect import NO_LIMIT, OFF, Effect, kernel_of

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


def limits(parameters, case, state) -> dict[str, float]:
    """Longest sub-step [s] that each effect that is on bears with the particles as they are; those without a limit left out."""
    found = {name: REGISTRY[name].dt_limit(parameters[name], case, state) for name in case.effects}
    return {name: limit for name, limit in found.items() if limit != NO_LIMIT}


__all__ = ["OFF", "REGISTRY", "Effect", "kernel_of", "limits", "moving"]
