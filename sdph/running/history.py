"""Rows of history.csv: probes fixed in space, and what the grains tell of themselves."""

from __future__ import annotations

import math

import numpy as np

from coupling.transfer import gather
from sdph.engine import state as particles
from sdph.methods.grains.history import carried
from sdph.methods.grains.method import REACH

PROBED = ("temperature_K", "gas_temperature_K")  # of particles and gas


def row(simulation) -> dict[str, float]:
    """All columns of one instant."""
    columns = {"time_s": simulation.time}
    for name, point in simulation.case.probes.items():
        columns |= {f"{name}_{key}": value for key, value in probe(simulation, point.at).items()}
    return columns | simulation.grains.row()


def probe(simulation, point) -> dict[str, float]:
    """Values of PROBED at a point, by kernel interpolation: of particles where they have it, nan if none are near."""
    here = np.zeros((1, 3))
    here[0, : len(point)] = point
    gas = gather(simulation.transfer.weights(here), simulation.gas_state.fields["temperature"])[0]
    state = simulation.grains.inside
    if "temperature" not in carried(simulation.case):
        return {"gas_temperature_K": float(gas)}
    reach = REACH * simulation.case.smoothing_length
    r = particles.lengths(particles.positions(state) - here)
    near = np.flatnonzero(r < reach)
    weight = state.mass[near] * (1.0 - r[near] / reach) ** 2
    own = (weight * state.temperature[near]).sum() / weight.sum() if len(near) else math.nan
    return {"temperature_K": float(own), "gas_temperature_K": float(gas)}
