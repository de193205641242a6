"""Columns of history.csv of moving particles."""

from __future__ import annotations

import math

from sdph.engine import state as particles

NEAR = 2.0  # l0 about the middle of the liquid, whose pressure is told; as of weakly compressible liquids


def row(run) -> dict[str, float]:
    """Sums over the liquid, of which each process of a world has a part, its extent, its pressure, and what its tank
    feels."""
    s, stepper, axes = run.inside(), run.stepper, "xyz"[: run.case.dimensions]
    world = stepper.world
    size, places = particles.lengths(particles.velocities(s)), particles.positions(s)
    pressure, count = stepper.gauge[stepper.active], world.sum(len(s.x))
    values = {
        "time_s": run.time, "particles": count, "mass_kg": world.sum(float(s.mass.sum())),
        "kinetic_energy_J": world.sum(particles.energy_of_motion(s)),
        "fastest_m_s": world.most(float(size.max(initial=0.0))),
        "pressure_largest_Pa": world.most(float(pressure.max(initial=0.0))),
        "centre_pressure_Pa": _in_the_middle(world, count, places, pressure, run.case.resolution.spacing),
        "number_density_largest_rel": world.most(float(stepper.number.max(initial=0.0) / stepper.cloud.number)),
        "left": stepper.openings.left if stepper.openings else 0,
    }  # fmt: skip
    for a, name in enumerate(axes):
        furthest = world.most(float(places[:, a].max(initial=-math.inf)))
        values[f"largest_{name}_m"] = furthest if count else math.nan
        values[f"momentum_{name}_kg_m_s"] = world.sum(float(s.mass @ particles.velocities(s)[:, a]))
        values |= _spread(world, name, s.mass, places[:, a])
    return values | (_loads(run) if stepper.walls else {})


def _spread(world, name: str, mass, place) -> dict[str, float]:
    """Centre [m] of the liquid and variance [m2] of its places along an axis; nan where there is none."""
    whole = world.sum(float(mass.sum())) or math.nan
    centre = world.sum(float(mass @ place)) / whole
    spread = world.sum(float(mass @ (place - centre) ** 2)) / whole
    return {f"liquid_centre_{name}_m": centre, f"liquid_spread_{name}_m2": spread}


def _loads(run) -> dict[str, float]:
    """Force on the tank [N]: the mean since the last row by what the momentum gained, and of the pressure now."""
    wall, span = run.stepper.load, run.time - run.since
    mean = (run.impulse - run.stepper.impulses[1]) / span if span > 0.0 else wall
    forces = {"mean": mean, "wall": wall}
    return {f"{kind}_force_{a}_N": float(value) for kind, force in forces.items() for a, value in zip("xyz", force)}


def _in_the_middle(world, count: int, places, pressure, spacing: float) -> float:
    """Mean pressure [Pa] within NEAR spacings of the middle of the `count` particles; nan where there is none."""
    middle = world.sum(places.sum(axis=0)) / (count or 1)
    near = ((places - middle) ** 2).sum(axis=1) < (NEAR * spacing) ** 2
    return world.mean(pressure[near]) if world.any(near.any()) else math.nan


__all__ = ["row"]
