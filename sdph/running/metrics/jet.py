"""Metrics of jets of grains, each from its nozzle: reach, sag, temperature of the core."""

from __future__ import annotations

import math

import numpy as np

from sdph.effects.around.streams import streams_of, unit
from sdph.engine import state as particles
from sdph.schema import CaseError

HEAD = 2.0  # smoothing lengths: grains no further behind the front are the head
CORE = 0.9  # of the nozzle's volume fraction: denser grains are the core
TOLD = (  # of each jet
    "front_m", "sag_m", "alpha_p_max", "core_temperature_K", "grain_temperature_min_K", "grain_temperature_max_K",
    "speed_max_m_s",
)  # fmt: skip


def metrics(simulation) -> dict[str, float]:
    """grains, the number of particles; front_m along the nozzle's direction; sag_m of the head below its axis along
    gravity; alpha_p_max, the densest; core_temperature_K, the mean of grains nearly as dense as at the nozzle;
    grain_temperature_min_K, grain_temperature_max_K; speed_max_m_s of the grains; gas_temperature_min_K,
    gas_temperature_max_K; with vapour vapour_mass_fraction_max.

    Of several nozzles, what is told of one jet has the nozzle's name in front: left_front_m.
    """
    case, state = simulation.case, simulation.grains.inside
    if "inflow" not in case.effects:
        told = "run.metrics holds 'jet', which tells of nozzles"
        raise CaseError(f"{told}; add inflow to effects and a nozzle, or leave it out")
    row = {"grains": len(state.x)} | _gas(simulation.gas_state.fields)
    for number, (name, nozzle) in enumerate(case.nozzles.items(), 1):
        own = _jet(case, nozzle, particles.take(state, state.nozzle == number))
        row |= own if len(case.nozzles) == 1 else {f"{name}_{key}": value for key, value in own.items()}
    return row


def _jet(case, nozzle, state) -> dict[str, float]:
    """Metrics of the grains that came from one nozzle; nan where there are none."""
    return _grains(case, nozzle, state) if len(state.x) else dict.fromkeys(TOLD, math.nan)


def _grains(case, nozzle, state) -> dict[str, float]:
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
    row = {
        "gas_temperature_min_K": float(fields["temperature"].min()),
        "gas_temperature_max_K": float(fields["temperature"].max()),
    }
    if "vapour_mass_fraction" in fields:
        row["vapour_mass_fraction_max"] = float(fields["vapour_mass_fraction"].max())
    return row
