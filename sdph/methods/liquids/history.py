"""Columns of history.csv of a liquid: of all of it, of each phase where there are two, and what its tank feels."""

from __future__ import annotations

import math

import numpy as np

from sdph import effects
from sdph.engine import state as particles
from sdph.engine.state import GAS, LIQUID
from sdph.methods.liquids import account
from sdph.methods.liquids.loads import kinetic_energy, pipe_energy, pipe_loads, wall_loads


def row(run) -> dict[str, float]:
    """Columns of history.csv: of the whole liquid, of which each process of a world has a part."""
    stepper, case, world = run.stepper, run.case, run.stepper.world
    state, wet = stepper.domain.own(run.state), stepper.active
    mass, pressure = state.mass[wet], stepper.pressure[wet]
    places, velocities = particles.positions(state)[wet], particles.velocities(state)[wet]
    whole, gravity = world.sum(float(mass.sum())), np.array(case.domain.gravity) * ("gravity" in case.effects)
    values = {
        "time_s": run.time,
        "mass_kg": whole,
        "kinetic_energy_J": world.sum(kinetic_energy(state)),
        "potential_energy_J": -world.sum(float((mass * (places[:, : case.dimensions] @ gravity)).sum())),
        "fastest_m_s": world.most(float(np.sqrt((velocities**2).sum(axis=1)).max(initial=0.0))),
        "pressure_largest_Pa": world.most(float(pressure.max(initial=0.0))),
        "centre_pressure_Pa": _in_the_middle(world, places, pressure, case.resolution.spacing),
    }
    for a, name in enumerate("xyz"[: case.dimensions]):
        moment, furthest = world.sum(float((mass * places[:, a]).sum())), places[:, a].max(initial=-np.inf)
        values[f"centre_{name}_m"] = moment / whole if whole else math.nan
        values[f"momentum_{name}_kg_m_s"] = world.sum(float((mass * velocities[:, a]).sum()))
        values[f"largest_{name}_m"] = world.most(float(furthest)) if whole else math.nan
    values |= stepper.void.row() if stepper.void else {}
    return values | columns(stepper) | _drained(run) | _told(stepper)


def _told(stepper) -> dict[str, float]:
    """Columns that effects tell themselves."""
    told = [
        row.tells(stepper.p[name], stepper.domain.own(stepper.state))
        for name in stepper.case.effects
        if (row := effects.REGISTRY[name]).tells
    ]
    return {key: value for own in told for key, value in own.items()}


def _drained(run) -> dict[str, float]:
    if not run.outlet:
        return {}
    commanded = (run.outlet.fill - run.fill(run.time)) * run.stepper.capacity
    return {
        "drained_kg": float(run.outlet.gone[0]),
        "commanded_kg": commanded,
        "pipe_kinetic_energy_J": run.stepper.world.sum(pipe_energy(run.stepper)),
    }


def loads(run) -> dict[str, float]:
    """Columns of loads on the tank: mean since the last row by the momentum theorem, and what the walls feel now."""
    if "tank" not in run.case.effects:
        return {}
    mean = run.impulse / (run.time - run.since) if run.time > run.since else run.rates[account.LOADS]
    names = ("force_x_N", "force_y_N", "force_z_N", "moment_x_Nm", "moment_y_Nm", "moment_z_Nm")
    found = {"mean": mean, "wall": wall_loads(run.stepper)}
    if run.case.parameters["tank"].outlet_radius:
        found["pipe"] = pipe_loads(run.stepper)  # the part of "wall" that the outlet pipe feels
    return {f"{kind}_{name}": float(value) for kind, load in found.items() for name, value in zip(names, load)}


def columns(stepper) -> dict[str, float]:
    """Centre [m], velocity [m/s], variance of places [m2] and furthest place [m] of each phase along each axis; means
    by mass."""
    s, world, values = stepper.domain.own(stepper.state), stepper.world, {}
    if stepper.case.gas_phase is None:
        return values
    for phase, kind in (("liquid", LIQUID), ("gas", GAS)):
        own = s.kind == kind
        if not world.any(own.any()):
            continue
        mass, places, velocities = s.mass[own], particles.positions(s)[own], particles.velocities(s)[own]
        whole = world.sum(float(mass.sum()))
        centre = world.sum(mass @ places) / whole
        for a, axis in enumerate("xyz"[: stepper.case.dimensions]):
            values[f"{phase}_centre_{axis}_m"] = float(centre[a])
            values[f"{phase}_velocity_{axis}_m_s"] = world.sum(float(mass @ velocities[:, a])) / whole
            values[f"{phase}_spread_{axis}_m2"] = world.sum(float(mass @ (places[:, a] - centre[a]) ** 2)) / whole
            values[f"{phase}_largest_{axis}_m"] = world.most(float(places[:, a].max(initial=-np.inf)))
        fastest = world.most(float((velocities**2).sum(axis=1).max(initial=0.0)))
        values[f"{phase}_fastest_m_s"] = float(np.sqrt(fastest))
    return values


def _in_the_middle(world, places, pressure, spacing: float) -> float:
    """Mean pressure [Pa] within two spacings of the middle of the liquid; nan where there is none."""
    count = world.sum(len(places))
    middle = world.sum(places.sum(axis=0)) / (count or 1)
    near = ((places - middle) ** 2).sum(axis=1) < (2.0 * spacing) ** 2
    return world.mean(pressure[near]) if world.any(near.any()) else math.nan
