"""What a jet of grains looks like, from the first nozzle of its case: how far it is, how it sags, how warm its core is."""

from __future__ import annotations

import math

import numpy as np

from sdph import particles
from sdph.effects.inflow import streams_of, unit

HEAD = 2.0  # smoothing lengths: grains no further behind the front are the head
CORE = 0.9  # of the nozzle's volume fraction: denser grains are the core


def metrics(simulation) -> dict[str, float]:
    """front_m along the nozzle's direction; sag_m of the head below its axis along gravity; temperatures [K] of grains and
    core; vapour_mass_fraction_max; gas_temperature_K the coldest and hottest; diameter_m the smallest mean."""
    case, state = simulation.case, simulation.grains
    row = {"grains": len(state.x)} | _gas(simulation.gas_state.fields)
    none = dict.fromkeys(("front_m", "sag_m", "alpha_p_max", "core_temperature_K", "grain_temperature_min_K", "grain_temperature_max_K", "speed_max_m_s"), math.nan)
    return row | (_grains(case, state) if len(state.x) else none)


def _grains(case, state) -> dict[str, float]:
    nozzle = next(iter(case.nozzles.values()))
    place = particles.positions(state)[:, : case.dimensions] - np.array(nozzle.centre)
    along = place @ unit(nozzle.direction)
    head = along >= along.max() - HEAD * case.smoothing_length
    core = state.density >= CORE * streams_of(case, nozzle).alpha_p * case.grains.density
    temperature = state.temperature if len(state.temperature) else np.full(len(along), math.nan)
    return {
        "front_m": float(along.max()),
        "sag_m": _sag(case, place[head] - np.outer(along[head], unit(nozzle.direction))),
        "alpha_p_max": float(state.density.max() / case.grains.density),
        "core_temperature_K": float(temperature[core].mean()) if core.any() else math.nan,
        "grain_temperature_min_K": float(temperature.min()),
        "grain_temperature_max_K": float(temperature.max()),
        "speed_max_m_s": float(np.linalg.norm(particles.velocities(state), axis=1).max()),
    }


def _sag(case, across) -> float:
    """Mean place of the head off the axis, along gravity [m]; without gravity 0."""
    strength = math.hypot(*case.domain.gravity)
    return float((across @ np.array(case.domain.gravity)).mean() / strength) if strength else 0.0


def _gas(fields) -> dict[str, float]:
    row = {"gas_temperature_min_K": float(fields["temperature"].min()), "gas_temperature_max_K": float(fields["temperature"].max())}
    if "vapour_mass_fraction" in fields:
        row["vapour_mass_fraction_max"] = float(fields["vapour_mass_fraction"].max())
    return row
