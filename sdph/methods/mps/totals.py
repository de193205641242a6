"""The ledger of moving particles: mass, momentum and energy, and who gave and took them, one row a window.

Energy of motion changes by the work of every kick, each integrated with it, and by what comes in and leaves. What
tension takes from it goes into the cohesion of pairs, of which there is more as liquid comes in. The ledger closes by
construction, as a pressure that does work is booked as one that may. What the scheme makes of nothing is
`energy_made_J`: walls at rest do no work, and the pressure between them moves energy about. Two-dimensional amounts are
per metre of depth.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from sdph.engine.ledger import IN, OUT, both, ratio, vector
from sdph.engine.sums import Sums
from sdph.methods.mps import alone
from sdph.methods.mps.method import WORKS

FLOWS = ("injected_kg", "injected_J", "left_kg", "left_J")
AMOUNTS = (*(f"work_of_{name}_J" for name in WORKS), "fallen_J", "drawn_J", *FLOWS)


class MpsLedger(Sums):
    """Keeps the sums of moving particles: what is there, and what came and went."""

    KEPT = (
        *Sums.KEPT,
        "works",
        "impulses",
        "passed",
        "momentum",
        "moved",
        "fallen",
        "drawn",
        "made",
        "most",
    )  # see sdph.engine.kept
    AMOUNTS = AMOUNTS

    def __init__(self, path: Path | None, alone: bool = False):
        super().__init__(path)
        self.alone = alone  # whether particles act on nothing but each other: neither walls nor what waits upstream
        # of the stepper, at the last row
        self.works, self.impulses, self.passed = np.zeros(len(WORKS)), np.zeros((2, 3)), np.zeros((2, 5))
        self.momentum = np.zeros(3)  # impulses since the start, and momentum in less that out [kg m/s]
        self.moved = 0.0  # the same without sign
        # of the stepper, at the last row; most energy [J] beyond what came in, and most of motion
        self.fallen = self.drawn = self.made = self.most = 0.0

    def open(self, stepper) -> None:
        """The row of the start."""
        self._write(stepper, 0.0, totals(stepper), np.zeros((2, 3)), dict.fromkeys(AMOUNTS, 0.0))

    def close_window(self, stepper, dt: float) -> None:
        """The row of a window of `dt` [s]."""
        now, impulses, passed = totals(stepper), stepper.impulses - self.impulses, _passed(stepper) - self.passed
        amounts = {f"work_of_{name}_J": float(work) for name, work in zip(WORKS, stepper.works - self.works)}
        amounts |= {"fallen_J": stepper.fallen - self.fallen, "drawn_J": stepper.drawn - self.drawn}
        amounts |= dict(zip(FLOWS, (passed[IN, 0], passed[IN, 4], passed[OUT, 0], passed[OUT, 4])))
        self.add(amounts)
        flows = np.concatenate((impulses, passed[IN : IN + 1, 1:4], -passed[OUT : OUT + 1, 1:4]))
        self.momentum = self.momentum + flows.sum(axis=0)
        self.moved += float(np.linalg.norm(flows, axis=1).sum())
        self._write(stepper, dt, now, impulses, amounts)
        self.made = max(self.made, self._beyond())

    def _beyond(self) -> float:
        """Energy [J] of motion and in gravity that there is now beyond what there was and what came in. Tension and
        holes work from outside: cohesion is of the lattice more than of its surface."""
        gained = self.last["kinetic_energy_J"] - self.first["kinetic_energy_J"]
        given = ("fallen_J", "drawn_J", "work_of_holes_J", "injected_J")
        return float(gained - sum(self.sums[name] for name in given) + self.sums["left_J"])

    def _write(self, stepper, dt: float, now: dict, impulses, amounts: dict) -> None:
        row = {"time_s": stepper.time, "window_s": dt, "limit": stepper.limit} | now
        row |= vector("impulse_of_gravity", impulses[0]) | vector("impulse_of_pairs_with_inflow", impulses[1])
        self.works, self.impulses, self.passed = stepper.works.copy(), stepper.impulses.copy(), _passed(stepper)
        self.fallen, self.drawn, self.most = stepper.fallen, stepper.drawn, max(self.most, now["kinetic_energy_J"])
        self.put(row, amounts)

    def summary(self) -> dict[str, float]:
        """Closure of the run: mass, momentum and energy of motion, relative to what there was and what moved; what
        the scheme made to the largest energy of motion."""
        first, last, sums = self.first, self.last, self.sums
        mass = last["mass_kg"] - first["mass_kg"] - sums["injected_kg"] + sums["left_kg"]
        works = sum(sums[f"work_of_{name}_J"] for name in WORKS)
        energy = last["kinetic_energy_J"] - first["kinetic_energy_J"] - works - sums["injected_J"] + sums["left_J"]
        whole = first["mass_kg"] + sums["injected_kg"]
        turned = math.sqrt(2.0 * whole * (first["kinetic_energy_J"] + sums["injected_J"] + abs(works)))
        scale = first["kinetic_energy_J"] + sums["injected_J"] + sum(abs(sums[f"work_of_{n}_J"]) for n in WORKS)
        # forces of pairs have no sum; corrected differences of pressure have one
        made, drift = (float(np.linalg.norm(own)) for own in (self.impulses[1], self.gained() - self.momentum))
        found = {"momentum_made_rel": ratio(made, self.moved + turned)} if self.alone else {}
        return (
            sums
            | found
            | {"energy_made_J": self.made, "energy_made_rel": ratio(self.made, self.most)}
            | both("mass_drift", "kg", abs(mass), whole)
            | both("momentum_drift", "kg_m_s", drift, self.moved + turned)
            | both("energy_drift", "J", abs(energy), scale)
        )


def _passed(stepper) -> np.ndarray:
    return stepper.openings.passed.copy() if stepper.openings else np.zeros((2, 5))


def totals(stepper) -> dict[str, float]:
    """Columns of the liquid that there is now, upstream of nozzles left out."""
    s, energy = stepper.domain.own(stepper.state), stepper.domain.mine_of(stepper.energy)
    found = alone.summed(stepper.world, alone.add_all, 7, len(s.x), s, energy)
    many, mass, *momentum, motion, bound = map(float, found)
    row = {"particles": int(many), "mass_kg": mass} | vector("momentum", momentum)
    return row | {"kinetic_energy_J": motion, "cohesion_energy_J": bound}
