"""The ledger of a liquid: mass, momentum and energy, and who gave and took them, one row a window.

Momentum comes from body forces, walls, surface tension, contact, shifting and nozzles, and goes through the drain and
open sides; control of tension makes some, as its pairs push both particles the same way. Walls are summed over their
particles and control over its own, so that what else pairs do not give back to each other is a drift. Energy
is kinetic and elastic (of compression), beside bodies also that of the springs of their polyline. Gravity, the frame,
the pressure of walls and of nozzles, surface tension and contact work on it; what comes in brings some, the drain and
open sides take their share. Dissipation is the sum of its causes (LOSSES), each taken where its force acts; what
explicit steps and the continuity equation make of both is `numerical_work_J`. A scheme that makes energy shows in
`energy_made_J`, which counts what shifting lifts (`shifting_lift_J`). Potential energy is that in gravity, which is the
same everywhere; the work of gravity is beside it.

What surface tension gives, the surface loses: its energy is `surface_energy_J` (sdph.methods.liquids.surface), and work
that no surface was lost for is `numerical_tension_J`. Motion, compression and surface together grow by all other works
and by that, less what is dissipated.
Two-dimensional amounts are per metre of depth.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from numba import prange

from sdph.effects.around import gravity
from sdph.engine import arrays
from sdph.engine import state as particles
from sdph.engine.ledger import both, ratio, vector
from sdph.engine.sums import Sums
from sdph.laws.compiled import parallel, parallel_largest, serial
from sdph.methods.liquids import surface
from sdph.methods.liquids.losses import CAUSES

IMPULSES = (
    "body_forces", "walls", "surface_tension", "shifting", "drain", "contact", "inflow", "outflow", "bubble", "scaling",
    "tension_control",
)  # fmt: skip
WORKS = (
    "work_of_gravity_J", "work_of_frame_J", "work_of_walls_J", "work_of_surface_tension_J", "work_of_contact_J",
    "work_of_inflow_J", "work_of_bubble_J", "work_of_scaling_J",
)  # fmt: skip
LOSSES = (*CAUSES, "tension_control_J", "held_off_J", "shifting_J")
PASSED = ("drained_kg", "drained_J", "injected_kg", "injected_J", "left_kg", "left_J", "boiled_kg", "boiled_J")
AMOUNTS = (*PASSED, *WORKS, *LOSSES, "shifting_lift_J", "dissipated_J", "numerical_work_J", "numerical_tension_J")

AT_HAND = "energy_at_hand_J"  # what the liquid would set free if it fell to its lowest place, and work to and fro


class LiquidLedger(Sums):
    """Keeps the sums of a liquid: what is there, and what came and went."""

    KEPT = (*Sums.KEPT, "impulses", "scale", "most", "moved", "made", "mach")  # see sdph.engine.kept
    AMOUNTS = AMOUNTS

    def __init__(self, path: Path | None):
        super().__init__(path)
        self.impulses = np.zeros((len(IMPULSES), 3))  # since the start [kg m/s]
        # impulses; energy that could fall and work that was done; work of surface tension to and fro
        self.scale = {"kg_m_s": 0.0, "J": 0.0, "tension_J": 0.0}
        # most energy [J] that there was, of motion, and beyond what came in
        self.most = self.moved = self.made = 0.0
        self.mach = 0.0  # largest speed over the speed of sound

    def open(self, stepper) -> None:
        """The row of the start."""
        nothing = dict.fromkeys(IMPULSES, np.zeros(3))
        self.scale["J"] = _falling(stepper)
        self._write(stepper, 0.0, self._totals(stepper), nothing, dict.fromkeys(AMOUNTS, 0.0))

    def close_window(self, stepper, dt: float, impulses: dict, amounts: dict) -> None:
        """The row of a window of `dt` [s]: impulses (3,) by the names of IMPULSES, amounts by the keys of `sums`."""
        now = self._totals(stepper)
        amounts = amounts | {"dissipated_J": math.fsum(amounts[name] for name in LOSSES)}
        given = self._given(amounts) - amounts["dissipated_J"]
        amounts["numerical_work_J"] = _energy(now) - _energy(self.last) - given
        lost = self.last.get("surface_energy_J", 0.0) - now.get("surface_energy_J", 0.0)
        amounts["numerical_tension_J"] = amounts["work_of_surface_tension_J"] - lost
        self.add(amounts)
        self.impulses += np.array([impulses[name] for name in IMPULSES])
        self.scale["kg_m_s"] += sum(float(np.linalg.norm(value)) for value in impulses.values())
        self.scale["J"] += sum(abs(amounts[name]) for name in WORKS)
        self.scale["tension_J"] += abs(amounts["work_of_surface_tension_J"])
        self._write(stepper, dt, now, impulses, amounts)
        risen = _energy(now) - _energy(self.first) + self.sums["shifting_lift_J"]
        self.made = max(self.made, risen - self._given(self.sums))

    def _given(self, amounts: dict) -> float:
        """Energy [J] that came from outside."""
        gone = amounts["drained_J"] + amounts["left_J"] + amounts["boiled_J"]
        return sum(amounts[name] for name in WORKS) + amounts["injected_J"] - gone

    def summary(self) -> dict[str, float]:
        """Closure of the run: mass and momentum relative to what there was, and so is the momentum that control of
        tension made; energy to the largest of motion; the largest Mach number."""
        there = self.first["mass_kg"] + self.sums["injected_kg"]
        inertia = math.sqrt(2.0 * there * (self.scale["J"] + self.most))  # of all with all that energy
        gone = self.sums["drained_kg"] + self.sums["left_kg"] + self.sums["boiled_kg"]
        came = self.sums["injected_kg"] - gone
        mass = self.last["mass_kg"] - self.first["mass_kg"] - came
        drift = float(np.linalg.norm(self.gained() - self.impulses.sum(axis=0)))
        made = float(np.linalg.norm(self.impulses[IMPULSES.index("tension_control")]))
        return (
            self.sums
            | {
                **both("mass_drift", "kg", abs(mass), there),
                **both("momentum_drift", "kg_m_s", drift, self.scale["kg_m_s"] + inertia),
                "momentum_made_rel": ratio(made, self.scale["kg_m_s"] + inertia),
                "energy_made_J": self.made,
                AT_HAND: self.scale["J"],
                "energy_made_rel": ratio(self.made, self.moved),
                "numerical_work_rel": ratio(abs(self.sums["numerical_work_J"]), abs(self.sums["dissipated_J"])),
                "fastest_over_sound": self.mach,
            }
            | self._of_surface()
        )

    def _of_surface(self) -> dict[str, float]:
        """Numerical part of the work of surface tension, over that work to and fro; nothing without a surface."""
        if "surface_energy_J" not in self.last:
            return {}
        made = abs(self.sums["numerical_tension_J"])
        return {"numerical_tension_rel": ratio(made, self.scale["tension_J"])}

    def _totals(self, stepper) -> dict[str, float]:
        s, own, world = stepper.state, stepper.active, stepper.world
        held = arrays.empty((len(own), 6), own)
        hold(s, own, stepper.fluids, stepper.p["gravity"], held)
        *momentum, potential, kinetic, elastic = world.total(held).tolist()
        speed, mach = np.sqrt(world.most(np.array(fastest(s, own, stepper.fluids)))).tolist()
        self.mach = max(self.mach, mach)
        row = {"particles": world.sum(len(own)), "mass_kg": world.exact(arrays.taken(s.mass, own))}
        row |= vector("momentum", momentum)
        row |= {"kinetic_energy_J": kinetic, "elastic_energy_J": elastic, "potential_energy_J": potential}
        springs = {"contact_energy_J": stepper.bodies.springs} if stepper.bodies else {}
        tense = {"surface_energy_J": surface.energy(stepper)} if stepper.p["surface_tension"] else {}
        return row | tense | {"fastest_m_s": speed} | springs

    def _write(self, stepper, dt: float, totals: dict, impulses: dict, amounts: dict) -> None:
        row = {"time_s": stepper.time, "window_s": dt, "limit": stepper.limit} | totals
        for name, impulse in impulses.items():
            row |= vector(f"impulse_of_{name}", impulse)
        self.most, self.moved = max(self.most, _energy(totals)), max(self.moved, totals["kinetic_energy_J"])
        self.put(row, amounts)


def _falling(stepper) -> float:
    """Energy [J] that the liquid would set free if it fell to its lowest place."""
    gravity = np.array(stepper.p["gravity"] or (0.0, 0.0, 0.0))
    depth = -(particles.positions(stepper.state)[stepper.active] @ gravity)
    least = stepper.world.least(float(depth.min(initial=math.inf)))
    return float(stepper.world.total(stepper.state.mass[stepper.active] * (depth - least)))


def _energy(row: dict) -> float:
    return row["kinetic_energy_J"] + row["elastic_energy_J"] + row.get("contact_energy_J", 0.0)


@serial
def elastic_energy(fluids, kind, rho):
    """Energy [J/kg] of compression: integral of p/rho^2 of Tait's law from rho_0 on, background and cohesion included.
    `fluids` as in sdph.methods.liquids.equations."""
    rho_0, gamma = fluids[0, kind], fluids[2, kind]
    x = rho / rho_0
    power = math.log(x) if gamma == 1.0 else (x ** (gamma - 1.0) - 1.0) / (gamma - 1.0)
    held_in = fluids[1, kind] / rho_0 * (power + 1.0 / x - 1.0) + fluids[3, kind] / rho_0 * (1.0 - 1.0 / x)
    return held_in - fluids[4, kind] * rho_0 * (x - 1.0)


@serial
def squared_speed(s, i):
    """Squared speed [m2/s2] of particle i."""
    w = s.w[i] if len(s.w) else 0.0
    return s.u[i] * s.u[i] + s.v[i] * s.v[i] + w * w


@parallel
def hold(s, active, fluids, gravity_p, held):
    """held (A, 6) by each particle: momentum (3 columns) [kg m/s], energy in gravity, of motion and of compression
    [J]."""
    gx, gy, gz = gravity.acceleration(gravity_p)
    for n in prange(len(active)):
        i = active[n]
        mass = s.mass[i]
        held[n, 0], held[n, 1] = mass * s.u[i], mass * s.v[i]
        held[n, 2] = mass * s.w[i] if len(s.w) else 0.0
        held[n, 3] = -mass * (s.x[i] * gx + s.y[i] * gy + (s.z[i] * gz if len(s.z) else 0.0))
        held[n, 4] = mass * (0.5 * squared_speed(s, i))
        held[n, 5] = mass * elastic_energy(fluids, s.kind[i], s.density[i])


@parallel_largest
def fastest(s, active, fluids):
    """Largest v^2 [m2/s2], and that over the squared speed of sound of the particle's phase, gamma stiffness/rho_0."""
    speed = mach = 0.0
    for n in prange(len(active)):
        i = active[n]
        own, kind = squared_speed(s, i), s.kind[i]
        speed = max(speed, own)
        mach = max(mach, own * fluids[0, kind] / (fluids[2, kind] * fluids[1, kind]))
    return speed, mach


@parallel
def _specific(s, own, fluids, found):
    for n in prange(len(own)):
        i = own[n]
        found[0, n], found[1, n] = 0.5 * squared_speed(s, i), elastic_energy(fluids, s.kind[i], s.density[i])


def specific_energies(stepper, own) -> np.ndarray:
    """Kinetic and elastic energy (2, P) [J/kg] of the particles `own`."""
    found = np.empty((2, len(own)))
    _specific(stepper.state, np.asarray(own), stepper.fluids, found)
    return found
