"""The ledger: mass, momentum, energy and species of each phase and what they exchanged, one row a window.

Energy of the particles is their enthalpy m c T; that of the gas sum(alpha rho cp T V). What crosses the gas
boundary is counted by the gas itself. Two-dimensional amounts are per metre of depth.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from sdph import particles
from sdph.output import Table


class Ledger:
    """Keeps the rows of one run and writes each to `ledger.csv` as it comes."""

    def __init__(self, path: Path, case, depth: float):
        self.case, self.depth = case, depth
        self.heat_exchanged = 0.0  # sum of |heat| over windows [J]
        self.heat_mismatch = 0.0  # largest |particles - gas| of a window [J]
        self.first = self.last = None
        self.table = Table(path)

    def open(self, state, budget) -> None:
        """The row of the start."""
        self._write({"time_s": 0.0, "window_s": 0.0, "limit": ""} | self._totals(state, budget) | _exchanged(0.0, 0.0))

    def close_window(self, time: float, dt: float, limit: str, state, gas_state, taken) -> None:
        """The row of a window; `taken` is None where nothing was exchanged both ways."""
        to_particles, from_gas = (float(taken.heat.sum()), -taken.heat_from_gas) if taken else (0.0, 0.0)
        self.heat_exchanged += abs(to_particles)
        self.heat_mismatch = max(self.heat_mismatch, abs(to_particles + from_gas))
        head = {"time_s": time, "window_s": dt, "limit": limit}
        self._write(head | self._totals(state, gas_state.budget) | _exchanged(to_particles, from_gas))

    def summary(self) -> dict[str, float]:
        """Closure of the run: relative drifts and mismatches."""
        return {
            "heat_exchanged_J": self.heat_exchanged,
            "exchange_energy_mismatch_rel": _ratio(self.heat_mismatch, self.heat_exchanged),
            "energy_drift_rel": _ratio(self._drift("particle_energy_J", "gas_energy_J", "gas_energy_in_J"), self.heat_exchanged),
            "mass_drift_rel": _ratio(
                self._drift("particle_mass_kg", "gas_mass_kg", "gas_mass_in_kg"), self.first["particle_mass_kg"] + self.first["gas_mass_kg"]
            ),
        }

    def _drift(self, particle: str, gas: str, inflow: str) -> float:
        change = {key: self.last[key] - self.first[key] for key in (particle, gas, inflow)}
        return abs(math.fsum((change[particle], change[gas], -change[inflow])))

    def _totals(self, state, budget) -> dict[str, float]:
        velocity = particles.velocities(state)
        momentum = (state.mass[:, None] * velocity).sum(axis=0)
        enthalpy = state.mass * state.temperature * self.case.grains.heat_capacity if len(state.temperature) else np.zeros(1)
        row = {
            "particles": len(state.x),
            "particle_mass_kg": float(state.mass.sum()),
            "particle_energy_J": math.fsum(enthalpy),
            "particle_kinetic_energy_J": float(0.5 * (state.mass * (velocity**2).sum(axis=1)).sum()),
        }
        row |= {f"particle_momentum_{a}_kg_m_s": float(p) for a, p in zip("xyz", momentum)}
        scalars = {"mass": "kg", "energy": "J", "vapour": "kg", "mass_in": "kg", "energy_in": "J", "vapour_in": "kg"}
        row |= {f"gas_{name}_{unit}": getattr(budget, name) / self.depth for name, unit in scalars.items()}
        return row | {f"gas_momentum_{a}_kg_m_s": p / self.depth for a, p in zip("xyz", budget.momentum)}

    def _write(self, row: dict) -> None:
        self.first, self.last = self.first or row, row
        self.table.write(row)


def _exchanged(to_particles: float, from_gas: float) -> dict[str, float]:
    return {"heat_to_particles_J": to_particles, "heat_to_gas_J": from_gas}


def _ratio(part: float, whole: float) -> float:
    return part / whole if whole else 0.0
