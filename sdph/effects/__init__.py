"""The effects that a case can switch on, one file each, and the registry of them."""

import dataclasses

from sdph.effects.around import (
    by_nozzle,
    drain,
    electric_field,
    frame,
    gravity,
    inflow,
    outflow,
    tank,
    wall_heat,
    walls,
)
from sdph.effects.effect import NO_LIMIT, OFF, Effect, kernel_of
from sdph.effects.gas import (
    break_up,
    drag,
    evaporation,
    gas_pressure,
    heat,
    lift,
    micro_explosion,
    radiation,
    reaction,
    turbulent_dispersion,
)
from sdph.effects.grains import (
    artificial_viscosity,
    conduction,
    friction,
    grain_drag,
    grain_shifting,
    granular_pressure,
    granular_temperature,
    granular_viscosity,
)
from sdph.effects.liquids import (
    bubble,
    density_diffusion,
    free_energy_tension,
    laminar_viscosity,
    liquid_damping,
    liquid_heat,
    perforation,
    shear_thinning,
    shifting,
    suction,
    surface_tension,
    time_scaling,
    xsph,
)
from sdph.effects.solids import inflation, rigid_sides
from sdph.engine.ledger import Column
from sdph.engine.state import OF_MATERIAL

FILES = (
    drag,
    lift,
    turbulent_dispersion,
    gas_pressure,
    gravity,
    electric_field,
    granular_pressure,
    friction,
    granular_viscosity,
    granular_temperature,
    artificial_viscosity,
    grain_drag,
    grain_shifting,
    walls,
    heat,
    radiation,
    conduction,
    wall_heat,
    density_diffusion,
    laminar_viscosity,
    shear_thinning,
    liquid_damping,
    shifting,
    surface_tension,
    free_energy_tension,
    perforation,
    suction,
    bubble,
    liquid_heat,
    time_scaling,
    xsph,
    tank,
    frame,
    drain,
    evaporation,
    micro_explosion,
    reaction,
    break_up,
    inflow,
    outflow,
    inflation,
    rigid_sides,
)
REGISTRY: dict[str, Effect] = {file.EFFECT.name: file.EFFECT for file in FILES}


def moving(case) -> bool:
    """Tell whether an effect that is on moves grains."""
    return any(REGISTRY[name].moves for name in case.effects)


def limits(parameters, case, state) -> dict[str, float]:
    """Longest sub-step [s] that each effect that is on bears with the particles as they are; NO_LIMIT where there is
    none, so that processes that share a run tell of the same ones."""
    return {name: REGISTRY[name].dt_limit(parameters[name], case, state) for name in case.effects}


def finite(limits: dict[str, float]) -> dict[str, float]:
    """Limits without those that are none."""
    return {name: limit for name, limit in limits.items() if limit != NO_LIMIT}


def arrays(case) -> set[str]:
    """Arrays of the state that the effects that are on need, and grains of several materials or that pass through."""
    of_grains = (*OF_MATERIAL, "diameter", "diameter_variance") if case.mixed else ()
    passing = ("entered",) if case.grains and {"inflow", "outflow"}.issubset(case.effects) else ()
    return {*of_grains, *passing, *(name for effect in case.effects for name in REGISTRY[effect].arrays)}


def window_limits(parameters, case, state) -> dict[str, float]:
    """Longest window [s] that each effect that is on and limits it bears with the particles as they are."""
    asked = [REGISTRY[name] for name in case.effects if REGISTRY[name].window_limit]
    return {row.name: row.window_limit(parameters[row.name], case, state) for row in asked}


def held(parameters, case, method) -> dict[str, float]:
    """Shares and numbers of particles that limiters of the effects that are on hold in a method now, by column of
    history.csv."""
    asked = {REGISTRY[name].held: name for name in case.effects if REGISTRY[name].held}  # those of two effects once
    return {column: value for ask, name in asked.items() for column, value in ask(parameters[name], method).items()}


def in_ledger(case) -> tuple[tuple[Column, ...], tuple[str, ...]]:
    """Columns that effects have in the ledger, on or off; names of those whose sums this case tells."""
    on = (row for name, row in REGISTRY.items() if name in case.effects)
    told = dict.fromkeys(name for row in on for name in row.sums)
    columns, parts = (column for row in REGISTRY.values() for column in row.columns), by_nozzle.names(case)
    return (*columns, *map(Column, parts)), (*told, *parts)  # of parts of other columns balances know nothing


def without_input(matter: str) -> dict:
    """Parameters of the effects on grains or a liquid that can judge themselves and need no input."""
    rows = [row for row in REGISTRY.values() if row.call and matter in row.matter]
    return {
        row.name: row.parameters()
        for row in rows
        if all(f.default is not dataclasses.MISSING for f in dataclasses.fields(row.parameters))
    }


__all__ = [
    "OFF", "REGISTRY", "Effect", "arrays", "held", "in_ledger", "kernel_of", "limits", "moving", "window_limits",
    "without_input",
]  # fmt: skip
