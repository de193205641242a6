"""The ledger: mass, momentum, energy and species of each phase and what they exchanged, one row a window.

Energy of the particles is their enthalpy m c T; that of the gas sum(alpha rho cp T V). What crosses the gas
boundary is counted by the gas itself. Two-dimensional amounts are per metre of depth.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from sdph.engine import state as particles
from sdph.engine.kept import ROW, Maybe, Unfit
from sdph.engine.table import Table

VECTORS = (
    "impulse_to_particles", "impulse_to_gas", "impulse_of_body_forces", "impulse_of_walls", "impulse_of_inflow",
    "impulse_of_outflow", "impulse_of_contact",
)  # fmt: skip
AMOUNTS = (
    "heat_to_particles_J", "heat_to_gas_J", "drag_heat_J", "mechanical_heat_J", "evaporated_kg", "vapour_to_gas_kg",
    "condensation_refused_kg", "latent_heat_J", "capacity_heat_J", "heat_to_surroundings_J", "injected_kg",
    "injected_J", "left_kg", "left_J",
)  # fmt: skip
NOTHING = dict.fromkeys(AMOUNTS, 0.0) | {f"{name}_{a}_kg_m_s": 0.0 for name in VECTORS for a in "xyz"}


def vector(name: str, values) -> dict[str, float]:
    """Columns of an impulse (3,) [kg m/s]."""
    return {f"{name}_{a}_kg_m_s": float(value) for a, value in zip("xyz", values)}


class Ledger:
    """Keeps the rows of one run and writes each to `ledger.csv` as it comes."""

    # see sdph.engine.kept
    KEPT = ("sums", "heat_mismatch", "impulse_mismatch", "mass_mismatch", "first", "last", "table")
    FORMS = {"first": Maybe(ROW), "last": Maybe(ROW)}

    def __init__(self, path: Path, case, depth: float):
        self.case, self.depth = case, depth
        self.sums = dict.fromkeys((*NOTHING, "heat_exchanged_J", "impulse_exchanged_kg_m_s"), 0.0)
        # largest |particles - gas| of a window [J], [kg m/s], [kg]
        self.heat_mismatch = self.impulse_mismatch = self.mass_mismatch = 0.0
        self.first = self.last = None
        self.table = Table(path)

    def admit(self, kept: dict) -> None:
        refuse_rows(kept)

    def open(self, state, budget) -> None:
        """The row of the start."""
        self._write({"time_s": 0.0, "window_s": 0.0, "limit": ""} | self._totals(state, budget) | NOTHING)

    def close_window(self, time: float, dt: float, limit: str, state, gas_state, exchanged: dict) -> None:
        """The row of a window; `exchanged` has the keys of NOTHING."""
        self._write(
            {"time_s": time, "window_s": dt, "limit": limit} | self._totals(state, gas_state.budget) | exchanged
        )
        for key, value in exchanged.items():
            self.sums[key] += value
        self.sums["heat_exchanged_J"] += abs(exchanged["heat_to_particles_J"])
        self.heat_mismatch = max(self.heat_mismatch, abs(exchanged["heat_to_particles_J"] + exchanged["heat_to_gas_J"]))
        self.mass_mismatch = max(self.mass_mismatch, abs(exchanged["evaporated_kg"] - exchanged["vapour_to_gas_kg"]))
        impulse = [
            (exchanged[f"impulse_to_particles_{a}_kg_m_s"], exchanged[f"impulse_to_gas_{a}_kg_m_s"]) for a in "xyz"
        ]
        self.sums["impulse_exchanged_kg_m_s"] += math.hypot(*(own for own, _ in impulse))
        self.impulse_mismatch = max(self.impulse_mismatch, math.hypot(*(own + other for own, other in impulse)))

    def summary(self) -> dict[str, float]:
        """Closure of the run: relative drifts and mismatches. Energy is relative to the heat exchanged."""
        sums = {key: self.sums[key] for key in ("heat_exchanged_J", "drag_heat_J", "mechanical_heat_J")}
        drifts = self._mass_drifts()
        if "inflow" in self.case.effects or "outflow" in self.case.effects:
            sums |= {key: self.sums[key] for key in ("injected_kg", "left_kg")}
        if "evaporation" in self.case.effects:
            sums |= {
                key: self.sums[key]
                for key in ("evaporated_kg", "condensation_refused_kg", "latent_heat_J", "capacity_heat_J")
            }
        if self.sums["heat_to_surroundings_J"]:
            sums["heat_to_surroundings_J"] = self.sums["heat_to_surroundings_J"]
        if self.case.coupling.one_way:  # the gas feels nothing, so there is no balance of energy to close
            return sums | drifts
        if "evaporation" in self.case.effects:
            vapour = self._change("gas_vapour_kg", 1) + self._change("gas_vapour_in_kg", -1)
            drifts |= {
                "species_drift_rel": _ratio(
                    abs(math.fsum((*vapour, -self.sums["vapour_to_gas_kg"]))), self.sums["evaporated_kg"]
                ),
                "exchange_mass_mismatch_rel": _ratio(self.mass_mismatch, self.sums["evaporated_kg"]),
            }
        return (
            sums
            | drifts
            | {
                "exchange_energy_mismatch_rel": _ratio(self.heat_mismatch, self.sums["heat_exchanged_J"]),
                "exchange_momentum_mismatch_rel": _ratio(self.impulse_mismatch, self.sums["impulse_exchanged_kg_m_s"]),
                "energy_drift_rel": _ratio(
                    abs(self._energy_drift()), self.sums["heat_exchanged_J"] + abs(self.sums["heat_to_surroundings_J"])
                ),
            }
        )

    def _mass_drifts(self) -> dict[str, float]:
        """Of both phases together, and of the particles, over all the mass that there was or that came in."""
        came = self.sums["injected_kg"] - self.sums["left_kg"]
        whole = self.first["particle_mass_kg"] + self.sums["injected_kg"]
        particles = (*self._change("particle_mass_kg", 1), -came)
        gas = self._change("gas_mass_kg", 1) + self._change("gas_mass_in_kg", -1)
        vapour = self.sums["evaporated_kg"]
        lost = vapour if self.case.coupling.one_way else 0.0  # the gas feels nothing of it
        return {
            "mass_drift_rel": _ratio(abs(math.fsum((*particles, *gas, lost))), whole + self.first["gas_mass_kg"]),
            "particle_mass_drift_rel": _ratio(abs(math.fsum((*particles, vapour))), whole),
        }

    def _energy_drift(self) -> float:
        """What the energy of both phases grew by beyond what came in and was made [J]."""
        change = (
            self._change("particle_energy_J", 1) + self._change("gas_energy_J", 1) + self._change("gas_energy_in_J", -1)
        )
        made = [self.sums[key] for key in ("mechanical_heat_J", "drag_heat_J", "injected_J")]
        bound = [self.sums[key] for key in ("latent_heat_J", "capacity_heat_J", "heat_to_surroundings_J", "left_J")]
        return math.fsum((*change, *bound, *(-value for value in made)))

    def _change(self, key: str, sign: int) -> tuple[float, float]:
        """Change of a column over the run, as terms of an exact sum."""
        return sign * self.last[key], -sign * self.first[key]

    def _totals(self, state, budget) -> dict[str, float]:
        velocity = particles.velocities(state)
        momentum = np.einsum("i,ij->j", state.mass, velocity)
        enthalpy = (
            state.mass * state.temperature * self.case.grains.heat_capacity if len(state.temperature) else np.zeros(1)
        )
        row = {
            "particles": len(state.x),
            "particle_mass_kg": float(state.mass.sum()),
            "particle_energy_J": math.fsum(enthalpy.tolist()),
            "particle_kinetic_energy_J": float(0.5 * np.einsum("i,ij,ij->", state.mass, velocity, velocity)),
        }
        row |= {f"particle_momentum_{a}_kg_m_s": float(p) for a, p in zip("xyz", momentum)}
        scalars = {"mass": "kg", "energy": "J", "vapour": "kg", "mass_in": "kg", "energy_in": "J", "vapour_in": "kg"}
        row |= {f"gas_{name}_{unit}": getattr(budget, name) / self.depth for name, unit in scalars.items()}
        return row | {f"gas_momentum_{a}_kg_m_s": p / self.depth for a, p in zip("xyz", budget.momentum)}

    def _write(self, row: dict) -> None:
        self.first, self.last = self.first or row, row
        self.table.write(row)


def refuse_rows(kept: dict, not_first=()) -> None:
    """Unfit where the first row of a kept ledger, which lacks `not_first`, or the last is not of its columns, or where
    a value is no number."""
    columns = set(kept["table"]["columns"])
    for row, expected in ((kept["first"], columns - set(not_first)), (kept["last"], columns)):
        if not row or set(row) != expected or not isinstance(row.get("limit"), str):
            raise Unfit("the first or the last row of the ledger is not of its columns")
        if not all(key == "limit" or _finite(value) for key, value in row.items()):
            raise Unfit("a value in the first or the last row of the ledger is no finite number")


def _finite(value) -> bool:
    return not isinstance(value, str) and math.isfinite(value)


def _ratio(part: float, whole: float) -> float:
    return part / whole if whole else 0.0
