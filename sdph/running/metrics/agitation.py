"""Metrics of agitated grains on the move, of particles and of the cells of a two-fluid run alike."""

from __future__ import annotations

import numpy as np

from sdph.engine import state as particles


def metrics(points, masses, velocities, theta) -> dict[str, float]:
    """Sums of one instant over particles or cells: places (P, 3) [m], masses of grains (P,) [kg], velocities (P, 3)
    [m/s], granular temperature (P,) [m2/s2].

    motion_J and agitation_J, m v^2/2 and 3/2 m theta, and for every axis centre_m and spread_m, the root of the mean
    square distance from it.
    """
    mass = masses.sum()
    centre = masses @ points / mass
    spread = np.sqrt(masses @ (points - centre) ** 2 / mass)
    found = {"motion_J": 0.5 * masses @ (velocities**2).sum(axis=1), "agitation_J": 1.5 * masses @ theta}
    for axis, place, width in zip("xyz", centre, spread):
        found |= {f"centre_{axis}_m": place, f"spread_{axis}_m": width}
    return {name: float(value) for name, value in found.items()}


def of_run(simulation) -> dict[str, float]:
    """motion_J and agitation_J, m v^2/2 and 3/2 m theta of the grains; centre_x_m and spread_x_m, their mean place
    along x and the root of the mean square distance from it, likewise of the other axes; alpha_p_max, the densest."""
    state = simulation.grains.inside
    theta = state.theta if len(state.theta) else np.zeros(len(state.x))
    found = metrics(particles.positions(state), state.mass, particles.velocities(state), theta)
    own = particles.by_material(state.grain_density, simulation.case.grains.density)
    return found | {"alpha_p_max": float((state.density / own).max(initial=0.0))}
