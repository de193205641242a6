"""Rows of history.csv: probes fixed in space, and the particles that `[track]` names."""

from __future__ import annotations

import math

import numpy as np

from coupling.transfer import gather
from sdph.effects import REGISTRY
from sdph.engine import state as particles
from sdph.methods.grains.method import REACH

TRACKED = {
    "x_m": "x", "y_m": "y", "z_m": "z", "u_m_s": "u", "v_m_s": "v", "w_m_s": "w", "temperature_K": "temperature",
    "granular_temperature_m2_s2": "theta", "diameter_m": "diameter", "mass_kg": "mass",
}  # fmt: skip
PROBED = ("temperature_K", "gas_temperature_K")  # of particles and gas


def row(simulation) -> dict[str, float]:
    """All columns of one instant."""
    columns = {"time_s": simulation.time}
    for name, point in simulation.case.probes.items():
        columns |= {f"{name}_{key}": value for key, value in probe(simulation, point.at).items()}
    return columns | tracked(simulation)


def probe(simulation, point) -> dict[str, float]:
    """What is PROBED at a point, by kernel interpolation: of particles where they have it, nan if none are near."""
    here = np.zeros((1, 3))
    here[0, : len(point)] = point
    gas = gather(simulation.transfer.weights(here), simulation.gas_state.fields["temperature"])[0]
    state = simulation.grains
    if "temperature" not in carried(simulation.case):
        return {"gas_temperature_K": float(gas)}
    reach = REACH * simulation.case.smoothing_length
    r = particles.lengths(particles.positions(state) - here)
    near = np.flatnonzero(r < reach)
    weight = state.mass[near] * (1.0 - r[near] / reach) ** 2
    own = (weight * state.temperature[near]).sum() / weight.sum() if len(near) else math.nan
    return {"temperature_K": float(own), "gas_temperature_K": float(gas)}


def tracked(simulation) -> dict[str, float]:
    """Place, velocity, temperatures and heat rates of the tracked particles (paper, figures 9 and 10); nan before they
    come in and once they are gone."""
    names = simulation.case.track
    if not names:
        return {}
    state, columns = simulation.state, {}
    conducted = simulation.stepper.conduction_rates()
    arrays = carried(simulation.case)
    fields = {key: getattr(state, name) for key, name in TRACKED.items() if name in arrays}
    fields |= {
        "convective_heat_W": state.received if len(state.received) else np.zeros(len(state.x)),
        "conductive_heat_W": conducted,
    }
    for ident in names:
        place = np.flatnonzero((state.ident == ident) & (state.kind != particles.INFLOW))
        found = {key: float(values[place[0]]) if len(place) else math.nan for key, values in fields.items()}
        columns |= {f"particle_{ident}_{key}": value for key, value in found.items()}
    return columns


def carried(case) -> set[str]:
    """Names of the arrays that particles of a case have, were there any: so that every row has the same columns."""
    names = {name for effect in case.effects for name in REGISTRY[effect].arrays}
    return {name for name, values in particles.empty(1, names, case.dimensions)._asdict().items() if len(values)}
