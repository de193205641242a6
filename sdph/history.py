"""Rows of history.csv: probes fixed in space, and the particles that `[track]` names."""

from __future__ import annotations

import math

import numpy as np

from coupling.transfer import gather
from sdph import particles
from sdph.step import REACH


def row(simulation) -> dict[str, float]:
    """All columns of one instant."""
    columns = {"time_s": simulation.time}
    for name, point in simulation.case.probes.items():
        columns |= {f"{name}_{key}": value for key, value in probe(simulation, point.at).items()}
    return columns | tracked(simulation)


def probe(simulation, point) -> dict[str, float]:
    """Temperatures [K] of particles and gas at a point, by kernel interpolation; no particles near: nan."""
    here = np.zeros((1, 3))
    here[0, : len(point)] = point
    gas = gather(simulation.transfer.weights(here), simulation.gas_state.fields["temperature"])[0]
    reach = REACH * simulation.case.smoothing_length
    state = simulation.grains
    r = particles.lengths(particles.positions(state) - here)
    near = np.flatnonzero(r < reach)
    weight = state.mass[near] * (1.0 - r[near] / reach) ** 2
    own = (weight * state.temperature[near]).sum() / weight.sum() if len(near) else math.nan
    return {"temperature_K": float(own), "gas_temperature_K": float(gas)}


def tracked(simulation) -> dict[str, float]:
    """Place, velocity, temperatures and heat rates of the tracked particles (paper, figures 9 and 10); nan before they come
    in and once they are gone."""
    names = simulation.case.track
    if not names:
        return {}
    state, columns = simulation.state, {}
    conducted = simulation.stepper.conduction_rates()
    received = np.zeros(len(state.x))
    if simulation.received:
        known = np.isin(state.ident, simulation.received.ident)  # not what has come in since
        received[known] = simulation.received.now(state.ident[known])[0]
    fields = {
        "x_m": state.x, "y_m": state.y, "z_m": state.z, "u_m_s": state.u, "v_m_s": state.v, "w_m_s": state.w,
        "temperature_K": state.temperature, "granular_temperature_m2_s2": state.theta,
        "diameter_m": state.diameter, "mass_kg": state.mass,
        "convective_heat_W": received, "conductive_heat_W": conducted,
    }  # fmt: skip
    for ident in names:
        place = np.flatnonzero((state.ident == ident) & (state.kind != particles.INFLOW))
        columns |= {
            f"particle_{ident}_{key}": float(values[place[0]]) if len(place) else math.nan
            for key, values in fields.items()
            if len(values)
        }
    return columns
