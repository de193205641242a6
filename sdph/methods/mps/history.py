"""Columns of history.csv of moving particles."""

from __future__ import annotations

import math

from sdph.engine import state as particles
from sdph.engine.state import LIQUID

NEAR = 2.0  # l0 about the middle of the liquid, whose pressure is told; as of weakly compressible liquids


def row(run) -> dict[str, float]:
    """Sums over the liquid, its extent, its pressure, and what its tank feels."""
    s, stepper, axes = run.inside(), run.stepper, "xyz"[: run.case.dimensions]
    size, places = particles.lengths(particles.velocities(s)), particles.positions(s)
    pressure = stepper.gauge[run.state.kind == LIQUID]
    values = {
        "time_s": run.time, "particles": len(s.x), "mass_kg": float(s.mass.sum()),
        "kinetic_energy_J": particles.energy_of_motion(s), "fastest_m_s": float(size.max(initial=0.0)),
        "pressure_largest_Pa": float(pressure.max(initial=0.0)),
        "centre_pressure_Pa": _in_the_middle(places, pressure, run.case.resolution.spacing),
        "number_density_largest_rel": float(stepper.number.max(initial=0.0) / stepper.cloud.number),
        "left": stepper.openings.left if stepper.openings else 0,
    }  # fmt: skip
    for a, name in enumerate(axes):
        values[f"largest_{name}_m"] = float(places[:, a].max()) if len(places) else math.nan
        values[f"momentum_{name}_kg_m_s"] = float(s.mass @ particles.velocities(s)[:, a])
        values |= _spread(name, s.mass, places[:, a])
    return values | (_loads(run) if stepper.walls else {})


def _spread(name: str, mass, place) -> dict[str, float]:
    """Centre [m] of the liquid and variance [m2] of its places along an axis."""
    if not len(mass):
        return {f"liquid_centre_{name}_m": math.nan, f"liquid_spread_{name}_m2": math.nan}
    centre = float(mass @ place / mass.sum())
    return {
        f"liquid_centre_{name}_m": centre,
        f"liquid_spread_{name}_m2": float(mass @ (place - centre) ** 2 / mass.sum()),
    }


def _loads(run) -> dict[str, float]:
    """Force on the tank [N]: the mean since the last row by what the momentum gained, and of the pressure now."""
    wall, span = run.stepper.load, run.time - run.since
    mean = (run.impulse - run.stepper.impulses[1]) / span if span > 0.0 else wall
    forces = {"mean": mean, "wall": wall}
    return {f"{kind}_force_{a}_N": float(value) for kind, force in forces.items() for a, value in zip("xyz", force)}


def _in_the_middle(places, pressure, spacing: float) -> float:
    """Mean pressure [Pa] within NEAR spacings of the middle of the liquid; nan where there is none."""
    if not len(places):
        return math.nan
    near = ((places - places.mean(axis=0)) ** 2).sum(axis=1) < (NEAR * spacing) ** 2
    return float(pressure[near].mean()) if near.any() else math.nan


__all__ = ["row"]
