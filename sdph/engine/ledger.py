"""The ledger: mass, momentum, energy and species of each phase and what they exchanged, one row a window.

Energy stands in three places for the particles, heat m c T, motion m v^2/2 and agitation 3/2 m theta, and in two for
the gas, enthalpy sum(alpha rho cp T V) and motion. What crosses the gas boundary is counted by the gas itself. Every
work is integrated where it is done; what explicit steps make of it is `numerical_work_J`. Two-dimensional amounts are
per metre of depth.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import NamedTuple

from sdph.engine.kept import ROW, Maybe, Unfit
from sdph.engine.table import Table

VECTORS = (
    "impulse_to_particles", "impulse_to_gas", "impulse_of_body_forces", "impulse_of_walls", "impulse_of_inflow",
    "impulse_of_outflow", "impulse_of_contact", "impulse_of_vapour",
)  # fmt: skip
AMOUNTS = (
    "heat_to_particles_J", "heat_to_gas_J", "drag_heat_J", "friction_J", "mechanical_heat_J", "evaporated_kg",
    "vapour_to_gas_kg", "reacted_kg", "carrier_to_gas_kg", "heat_to_surroundings_J", "vapour_motion_J",
    "injected_kg", "injected_J", "injected_motion_J", "left_kg", "left_J", "left_motion_J",
    "work_of_drag_J", "work_of_pressure_J", "work_of_gravity_J", "work_of_walls_J", "work_of_contact_J",
    "work_of_inflow_J", "agitation_J", "collision_heat_J", "damping_heat_J", "bounds_work_J", "numerical_work_J",
    "impulse_of_gone_kg_m_s",
)  # fmt: skip
# column -> sign with which it changes the motion and agitation of the particles
MOTION = {
    "work_of_drag_J": 1, "work_of_pressure_J": 1, "work_of_gravity_J": 1, "work_of_walls_J": 1, "work_of_contact_J": 1,
    "work_of_inflow_J": 1, "numerical_work_J": 1, "bounds_work_J": 1,
    "injected_motion_J": 1, "left_motion_J": -1,
    "vapour_motion_J": -1, "mechanical_heat_J": -1, "collision_heat_J": -1, "damping_heat_J": -1,
}  # fmt: skip
# the same of the heat of the particles and the enthalpy of the gas
HEAT = {
    "mechanical_heat_J": 1, "collision_heat_J": 1, "friction_J": 1, "injected_J": 1, "left_J": -1,
    "heat_to_surroundings_J": -1,
}  # fmt: skip
# of these what the temperature of the particles takes or gives, where they have one
IN_GRAINS = ("mechanical_heat_J", "collision_heat_J")
OF_GAS = {
    "mass": "kg", "energy": "J", "kinetic": "J", "vapour": "kg", "mass_in": "kg", "energy_in": "J", "kinetic_in": "J",
    "vapour_in": "kg", "pressure_work": "J", "boundary_work": "J", "gravity_work": "J",
    "viscous_work": "J",
}  # fmt: skip
# impulses that the momentum of the gas grows by, of its budget (`coupling.gas.IMPULSES`)
IMPULSES_OF_GAS = (
    "momentum_in", "impulse_pressure", "impulse_walls", "impulse_gravity", "impulse_exchange", "impulse_room",
)  # fmt: skip
# sums of what was exchanged or moved in a window, without sign, which drifts are related to
# of the heat of both phases: of less that is exchanged 1e-8 (sdph.running.balances) is below 1e-15 of all heat, the
# round-off of its sums, so that there is nothing to relate a drift to; our choice
TOLD = 1e-7
SEEN = 1e-3  # of motion, whose sum is good to 1e-14: no drift of less work can be told to 1e-10 of it; our choice
IN, OUT = 0, 1  # rows of what has passed the openings of a method
ROUND_OFF = 2.0**-52  # of a sum
# of the enthalpy of the gas, what its sums may lose in a window; in many it grows as the square root of their number.
# Gas at rest lost 1.2 round-offs times that root in 6540 windows, other runs 0.07 at most; our choice. Over 1e-8
# (sdph.running.balances), so that a drift of that much is at its bar
LOST = 4.0 * ROUND_OFF / 1e-8
RELATED = ("heat_exchanged_J", "impulse_exchanged_kg_m_s", "work_exchanged_J", "gas_impulse_moved_kg_m_s")
COUNT = "windows"  # kept with these sums
NOTHING = dict.fromkeys(AMOUNTS, 0.0) | {f"{name}_{a}_kg_m_s": 0.0 for name in VECTORS for a in "xyz"}


def vector(name: str, values) -> dict[str, float]:
    """Columns of an impulse (3,) [kg m/s]."""
    return {f"{name}_{a}_kg_m_s": float(value) for a, value in zip("xyz", values)}


def vector_of(row: dict, name: str) -> tuple[float, ...]:
    """The impulse (3,) [kg m/s] in such columns of a row."""
    return tuple(row[f"{name}_{a}_kg_m_s"] for a in "xyz")


class Column(NamedTuple):
    """Column that an effect has in the ledger: sign with which it changes the motion and agitation of the particles,
    and that of the heat of the particles and the enthalpy of the gas; `of_grains`: the temperature of the particles
    takes or gives it, where they have one."""

    name: str
    motion: int = 0
    heat: int = 0
    of_grains: bool = False


class Ledger:
    """Keeps the rows of one run and writes each to `ledger.csv` as it comes.

    `columns` are those that effects have of their own, `told` those whose sums the summary tells, besides those of
    every case.
    """

    # see sdph.engine.kept
    KEPT = ("sums", "heat_mismatch", "impulse_mismatch", "mass_mismatch", "first", "last", "table")
    FORMS = {"first": Maybe(ROW), "last": Maybe(ROW)}

    def __init__(self, path: Path, case, depth: float, columns: tuple[Column, ...], told: tuple[str, ...]):
        self.case, self.depth, self.told = case, depth, told
        self.nothing = NOTHING | {column.name: 0.0 for column in columns}
        self.motion = MOTION | {column.name: column.motion for column in columns if column.motion}
        self.heat = HEAT | {column.name: column.heat for column in columns if column.heat}
        self.in_grains = {*IN_GRAINS, *(column.name for column in columns if column.of_grains)}
        self.sums = dict.fromkeys((*self.nothing, *RELATED, COUNT), 0.0)
        # largest |particles - gas| of a window [J], [kg m/s], [kg]
        self.heat_mismatch = self.impulse_mismatch = self.mass_mismatch = 0.0
        self.first = self.last = None
        self.table = Table(path)

    def admit(self, kept: dict) -> None:
        refuse_rows(kept)

    def open(self, totals: dict, budget) -> None:
        """The row of the start; `totals` are columns of the particles, `budget` is of the gas."""
        self._write({"time_s": 0.0, "window_s": 0.0, "limit": ""} | totals | self._gas(budget) | self.nothing)

    def close_window(self, time: float, dt: float, limit: str, totals: dict, budget, exchanged: dict) -> None:
        """The row of a window; `exchanged` has the keys of `nothing`."""
        before = self.last
        self._write({"time_s": time, "window_s": dt, "limit": limit} | totals | self._gas(budget) | exchanged)
        for key, value in exchanged.items():
            self.sums[key] += value
        self.sums[COUNT] += 1.0
        self.sums["heat_exchanged_J"] += abs(exchanged["heat_to_particles_J"])
        self.sums["work_exchanged_J"] += sum(abs(exchanged[key]) for key in self.motion)
        self.heat_mismatch = max(self.heat_mismatch, abs(exchanged["heat_to_particles_J"] + exchanged["heat_to_gas_J"]))
        lost, got = ("evaporated_kg", "reacted_kg"), ("vapour_to_gas_kg", "carrier_to_gas_kg")
        unequal = sum(exchanged[key] for key in lost) - sum(exchanged[key] for key in got)
        self.mass_mismatch = max(self.mass_mismatch, abs(unequal))
        columns = [key for key in self.last if key.endswith("kg_m_s")]
        unequal = self._hear_impulses(exchanged, {key: self.last[key] - before[key] for key in columns})
        self.impulse_mismatch = max(self.impulse_mismatch, unequal)

    def _hear_impulses(self, exchanged: dict, grown: dict) -> float:
        """Add up the impulses of a window; `grown` is what columns grew by. Returns by how much what both sides gave
        each other, or what the gas says that it got, is unequal [kg m/s]."""
        own, given, brought = (
            vector_of(exchanged, f"impulse_{name}") for name in ("to_particles", "to_gas", "of_vapour")
        )
        moved = [vector_of(grown, f"gas_{name}") for name in IMPULSES_OF_GAS]
        told = moved[IMPULSES_OF_GAS.index("impulse_exchange")]
        self.sums["impulse_exchanged_kg_m_s"] += math.hypot(*own) + math.hypot(*brought)
        self.sums["gas_impulse_moved_kg_m_s"] += sum(math.hypot(*impulse) for impulse in moved)
        unheard = math.hypot(*(a + b - c for a, b, c in zip(given, brought, told)))
        return math.hypot(*(a + b for a, b in zip(own, given))) + unheard

    def summary(self) -> dict[str, float]:
        """Closure of the run: drifts and mismatches, relative to what was exchanged; drifts of energy in joules too."""
        told = ("heat_exchanged_J", "drag_heat_J", "mechanical_heat_J", "numerical_work_J", "bounds_work_J")
        sums, drifts = {key: self.sums[key] for key in told}, self._mass_drifts() | self._motion_drift()
        physical = sum(abs(self.sums[key]) for key in ("friction_J", "mechanical_heat_J", "collision_heat_J"))
        drifts["numerical_work_rel"] = ratio(abs(self.sums["numerical_work_J"]), physical)
        sums |= {key: self.sums[key] for key in self.told}
        if self.sums["heat_to_surroundings_J"]:
            sums["heat_to_surroundings_J"] = self.sums["heat_to_surroundings_J"]
        if self.case.coupling.one_way:  # the gas feels nothing, so there is no balance of energy to close
            return sums | drifts
        if {"evaporated_kg", "reacted_kg"} & set(self.told):
            drifts |= self._species_drift()
        return (
            sums
            | drifts
            | both("exchange_energy_mismatch", "J", self.heat_mismatch, self.sums["heat_exchanged_J"])
            | both("exchange_momentum_mismatch", "kg_m_s", self.impulse_mismatch, self.sums["impulse_exchanged_kg_m_s"])
            | self._energy_drift()
            | self._gas_motion()
            | self._gas_momentum()
        )

    def _mass_drifts(self) -> dict[str, float]:
        """Drifts of both phases together, and of the particles, over all the mass that there was or that came in."""
        came = self.sums["injected_kg"] - self.sums["left_kg"]
        whole = self.first["particle_mass_kg"] + self.sums["injected_kg"]
        particles = (*self._change("particle_mass_kg", 1), -came)
        gas = self._change("gas_mass_kg", 1) + self._change("gas_mass_in_kg", -1)
        away = self.sums["evaporated_kg"] + self.sums["reacted_kg"]
        lost = away if self.case.coupling.one_way else 0.0  # the gas feels nothing of it
        drift, of_particles = (abs(math.fsum(terms)) for terms in ((*particles, *gas, lost), (*particles, away)))
        there = whole + self.first["gas_mass_kg"]
        return both("mass_drift", "kg", drift, there) | both("particle_mass_drift", "kg", of_particles, whole)

    def _species_drift(self) -> dict[str, float]:
        """Growth of the vapour in the gas beyond what came in, and evaporated or was used up."""
        vapour = self._change("gas_vapour_kg", 1) + self._change("gas_vapour_in_kg", -1)
        drift = abs(math.fsum((*vapour, -self.sums["vapour_to_gas_kg"])))
        whole = self.sums["evaporated_kg"] + self.sums["reacted_kg"]
        return both("species_drift", "kg", drift, whole) | both(
            "exchange_mass_mismatch", "kg", self.mass_mismatch, whole
        )

    def _energy_drift(self) -> dict[str, float]:
        """Growth of the heat of both phases beyond what came in and was made; relative to all that was exchanged, came
        in, left or was made, each over the run, where that is more than TOLD of their heat, or else to 1 J; and to no
        less than what round-off of so many windows is 1e-8 of."""
        pairs = {"particle_energy_J": 1, "gas_energy_J": 1, "heat_on_its_way_J": 1}
        pairs |= {"gas_energy_in_J": -1, "gas_pressure_work_J": -1}
        warm = self.last["particle_energy_J"] + self.sums["left_J"] > 0.0  # else no heat of the grains is kept
        kept = {key: sign for key, sign in self.heat.items() if warm or key not in self.in_grains}
        moved = [sign * self.sums[key] for key, sign in kept.items()]
        drift = math.fsum((*(c for key, sign in pairs.items() for c in self._change(key, sign)), *(-m for m in moved)))
        brought = (abs(math.fsum(self._change(key, 1))) for key in ("gas_energy_in_J", "gas_pressure_work_J"))
        scale = math.fsum((self.sums["heat_exchanged_J"], *map(abs, moved), *brought))
        heat = abs(self.last["particle_energy_J"]) + abs(self.last["gas_energy_J"])
        least = LOST * math.sqrt(self.sums[COUNT]) * abs(self.last["gas_energy_J"])
        related = max(scale if scale > TOLD * heat else 1.0, least)
        return {"energy_drift_J": abs(drift), "energy_drift_rel": abs(drift) / related}

    def _gas_motion(self) -> dict[str, float]:
        """Work [J] that is missing in the kinetic energy of the gas: that of its own viscosity, and what is numerical,
        convection upwind, implicit steps, splitting of velocity and pressure."""
        change = {"gas_kinetic_J": 1, "gas_kinetic_in_J": -1, "gas_gravity_work_J": -1, "gas_pressure_work_J": 1}
        change["gas_boundary_work_J"] = -1
        given = {"friction_J": 1, "work_of_drag_J": 1, "damping_heat_J": -1, "vapour_motion_J": -1}
        terms = [c for key, sign in change.items() for c in self._change(key, sign)]
        lost = -math.fsum((*terms, *(sign * self.sums[key] for key, sign in given.items())))
        rubbed = math.fsum(self._change("gas_viscous_work_J", 1))
        physical, least = abs(self.sums["friction_J"]), ROUND_OFF * abs(self.last["gas_energy_J"])
        return {
            "gas_dissipation_J": lost,
            "gas_dissipation_rel": ratio(abs(lost), physical, least),
            "gas_viscous_work_J": rubbed,
            "gas_numerical_work_J": -(lost + rubbed),
            "gas_numerical_work_rel": ratio(abs(lost + rubbed), physical + abs(rubbed), least),
        }

    def _gas_momentum(self) -> dict[str, float]:
        """Momentum of the gas that no impulse gave it: what is numerical."""
        drift = math.hypot(*vector_of(self.last, "gas_numerical_impulse"))
        return both("gas_momentum_drift", "kg_m_s", drift, self.sums["gas_impulse_moved_kg_m_s"])

    def _motion_drift(self) -> dict[str, float]:
        """Growth of the motion and agitation of the particles beyond the work that was done on them, relative to it and
        to SEEN of the motion that there is: what flies along without work keeps its motion to round-off."""
        change = [c for kind in ("kinetic", "fluctuation") for c in self._change(f"particle_{kind}_energy_J", 1)]
        drift = abs(math.fsum((*change, *(-sign * self.sums[key] for key, sign in self.motion.items()))))
        there = math.fsum(self.last[f"particle_{kind}_energy_J"] for kind in ("kinetic", "fluctuation"))
        return both("motion_drift", "J", drift, self.sums["work_exchanged_J"] + SEEN * there)

    def _change(self, key: str, sign: int) -> tuple[float, float]:
        """Change of a column over the run, as terms of an exact sum."""
        return sign * self.last[key], -sign * self.first[key]

    def _gas(self, budget) -> dict[str, float]:
        """Columns of the gas."""
        row = {f"gas_{name}_{unit}": getattr(budget, name) / self.depth for name, unit in OF_GAS.items()}
        for name in ("momentum", *IMPULSES_OF_GAS):
            row |= vector(f"gas_{name}", [p / self.depth for p in getattr(budget, name)])
        return row | self._numerical(row)

    def _numerical(self, row: dict) -> dict[str, float]:
        """Growth of the momentum of the gas since the start that no impulse gave, from its columns in a row."""
        first = self.first or row
        grown = {name: vector_of(row, name) for name in ("gas_momentum", *(f"gas_{name}" for name in IMPULSES_OF_GAS))}
        own, *given = ([a - b for a, b in zip(now, vector_of(first, name))] for name, now in grown.items())
        return vector("gas_numerical_impulse", [math.fsum((p, *(-g for g in of))) for p, *of in zip(own, *given)])

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


def ratio(part: float, whole: float, least: float = 0.0) -> float:
    """The part over the whole; with nothing to relate it to, no more than `least`, the part itself."""
    return part / whole if whole > least else part


def both(name: str, unit: str, part: float, whole: float) -> dict[str, float]:
    """Keys of a drift: itself, and over the whole (`ratio`)."""
    return {f"{name}_{unit}": part, f"{name}_rel": ratio(part, whole)}
