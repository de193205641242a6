"""The ledger of solids: mass, momentum and energy, and who gave and took them, one row a window.

Momentum comes from gravity, rigid sides, what is held, and a liquid around. Energy is kinetic, elastic, and of the
springs of contact. Gravity and the pressure in a cavity or of a liquid around work on it; plastic flow, viscosity and
cuts take from it; hourglass control takes and gives. Every work is integrated with the kicks that do it; what is
missing is `numerical_work_J`, that of explicit steps on elastic energy. Two-dimensional amounts are per
metre of depth.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from sdph.engine import state as particles
from sdph.engine.ledger import both, ratio, vector
from sdph.engine.sums import Sums
from sdph.methods.solids.method import IMPULSES, WORKS

GIVEN = ("work_of_gravity_J", "work_of_pressure_J", "work_of_scaling_J")
TAKEN = ("plastic_J", "viscosity_J", "hourglass_J", "damage_J")
AMOUNTS = (*GIVEN, *TAKEN, "numerical_work_J")


class SolidLedger(Sums):
    """Keeps the sums of solids: what is there, and what came and went."""

    KEPT = (*Sums.KEPT, "impulses", "works", "moved", "scale", "most")  # see sdph.engine.kept
    AMOUNTS = AMOUNTS

    def __init__(self, path: Path):
        super().__init__(path)
        self.impulses, self.works = np.zeros((len(IMPULSES), 3)), np.zeros(len(WORKS))  # of the stepper, at last row
        self.moved = self.scale = 0.0  # impulses [kg m/s] and works [J] without sign
        self.most = 0.0  # most energy [J] that there was

    def open(self, stepper) -> None:
        """The row of the start."""
        self._write(stepper, 0.0, totals(stepper), np.zeros_like(self.impulses), dict.fromkeys(AMOUNTS, 0.0))

    def close_window(self, stepper, dt: float) -> None:
        """The row of a window of `dt` [s]."""
        now, impulses = totals(stepper), stepper.impulses - self.impulses
        amounts = _amounts(stepper.works - self.works)
        given = sum(amounts[name] for name in GIVEN) - sum(amounts[name] for name in TAKEN)
        amounts["numerical_work_J"] = energy(now) - energy(self.last) - given
        self.add(amounts)
        self.moved += float(np.linalg.norm(impulses, axis=1).sum())
        self.scale += sum(abs(amounts[name]) for name in GIVEN)
        self._write(stepper, dt, now, impulses, amounts)

    def _write(self, stepper, dt: float, now: dict, impulses, amounts: dict) -> None:
        row = {"time_s": stepper.time, "window_s": dt, "limit": stepper.limit} | now
        for name, impulse in zip(IMPULSES, impulses):
            row |= vector(f"impulse_of_{name}", impulse)
        self.impulses, self.works = stepper.impulses.copy(), stepper.works.copy()
        self.most = max(self.most, energy(now))
        self.put(row, amounts)

    def summary(self) -> dict[str, float]:
        """Closure of the run: mass, momentum relative to impulses and to all mass with all the energy, energy to the
        most that there was or came in."""
        first, last = self.first, self.last
        drift = float(np.linalg.norm(self.gained() - self.impulses.sum(axis=0)))
        inertia = math.sqrt(2.0 * first["mass_kg"] * (self.scale + self.most))
        whole = self.scale + energy(first)
        return self.sums | {
            **both("mass_drift", "kg", abs(last["mass_kg"] - first["mass_kg"]), first["mass_kg"]),
            **both("momentum_drift", "kg_m_s", drift, self.moved + inertia),
            "energy_missing_rel": ratio(abs(self.sums["numerical_work_J"]), whole),
        }


def _amounts(works) -> dict[str, float]:
    """Columns of the works of a window, by their causes: what was given, and what was taken."""
    own = dict(zip(WORKS, map(float, works)))
    return {
        "work_of_gravity_J": own["gravity"], "work_of_pressure_J": own["pressure"], "plastic_J": own["plastic"],
        "viscosity_J": -own["viscosity"], "hourglass_J": -own["hourglass"], "damage_J": own["cut"],
        "work_of_scaling_J": own["scaling"],
    }  # fmt: skip


def totals(stepper) -> dict[str, float]:
    """Columns of what there is now."""
    s = stepper.state
    velocity = particles.velocities(s)
    row = {"particles": len(s.x), "mass_kg": float(s.mass.sum())} | vector("momentum", s.mass @ velocity)
    return row | {
        "kinetic_energy_J": particles.energy_of_motion(s),
        "elastic_energy_J": stepper.elastic_energy,
        "contact_energy_J": stepper.springs,
        "free_particles": int(stepper.free.sum()),
    }


def energy(row: dict) -> float:
    """Kinetic, elastic and contact energy [J] of a row."""
    return row["kinetic_energy_J"] + row["elastic_energy_J"] + row["contact_energy_J"]
