"""Grains of a run that hide each other from the surroundings that they radiate to."""

from __future__ import annotations

import numpy as np

from sdph.effects.gas import radiation
from sdph.engine import state as particles
from sdph.laws.radiation import extinction


def depth(simulation) -> float:
    """Optical depth [-] across the narrowest side of the domain, of grains as they are, by the mean over the gas's
    cells."""
    case, exchange = simulation.case, simulation.exchange
    with simulation.grains.ashore():
        state = simulation.grains.inside
        surface = np.zeros(len(state.x))
        radiation.surfaces(exchange.sizes_p, state, surface)  # over volume, 6/d
        volume = state.mass / particles.by_material(state.grain_density, case.grains.density)
        total = simulation.world.sum(float((volume * surface).sum()))
    mean = extinction(total / 6.0 / float(exchange.volumes.sum()), 1.0)  # of alpha_p/d
    return mean * min(case.domain.size)


def warnings(simulation) -> list[str]:
    """A line where radiation is on and grains at the end of the run are no haze that it goes through."""
    found = depth(simulation) if "radiation" in simulation.case.effects else 0.0
    if found <= radiation.THICK:
        return []
    return [f"the optical depth of the grains across the domain is {found:.2g} in the end: {radiation.HIDDEN}"]
