"""A liquid on its way, as `sdph.running.driver` runs it: the same calls as `sdph.running.simulation.Simulation` has, without a gas."""

from __future__ import annotations

import math
import time as clock
from pathlib import Path

import numpy as np

from sdph.effects.around import drain, tank
from sdph.engine import state as particles
from sdph.engine.clock import Clock
from sdph.engine.kept import Unfit
from sdph.methods.liquids import history as by_phase
from sdph.methods.liquids.method import LiquidStepper, balance, kinetic_energy, pipe_energy, pipe_loads, wall_loads
from sdph.methods.liquids.outlet import Outlet
from sdph.methods.liquids.totals import IMPULSES, LiquidLedger

SAMPLES = 10  # rows of history.csv for each output of fields, where the case says nothing
STRIDE = 20  # steps in a window at most: a liquid that goes unstable is caught within these (our choice)
SLOW = 0.2  # of the speed of sound: a liquid that is faster is compressed by 4 % (u2/c2); the rule is 0.1, twice that is told of


class LiquidRun:
    """A liquid in its tank; call `window` until `time` is the end."""

    KEPT = ("windows", "wall", "stepper", "outlet", "clock", "ledger", "impulse", "since")  # see sdph.engine.kept

    def __init__(self, case, ledger: Path):
        self.case, self.gas, self.clock = case, None, Clock(case.run, case.liquid.history_interval or case.run.output_interval / SAMPLES)
        self.stepper, self.ledger = LiquidStepper(case, self.clock.shortest), LiquidLedger(ledger)
        self.outlet = Outlet(self.stepper) if "drain" in case.effects else None
        self.fill = drain.command(case.parameters["drain"], self.outlet.fill) if self.outlet else None
        self.windows, self.wall, self.notices = 0, {"particles": 0.0}, []
        self.impulse, self.since = np.zeros(6), 0.0  # force and moment on the tank since the last row, and its time [s]

    @property
    def state(self):
        return self.stepper.state

    @property
    def time(self) -> float:
        return self.stepper.time

    @property
    def at_row(self) -> bool:
        """Whether the history has a row of now."""
        return self.clock.rows_at(self.time)

    def start(self) -> None:
        self.ledger.open(self.stepper)

    def admit(self, kept: dict) -> None:
        """Unfit where time is not that of the ledger, or the outlet's memory does not fit to the particles."""
        time = kept["stepper"]["time"]
        if time != kept["ledger"]["last"]["time_s"] or not 0.0 <= kept["since"] <= time:
            raise Unfit("its time is not that of the ledger")
        if self.outlet:
            self.outlet.admit_at(time, kept["outlet"], kept["stepper"]["state"])

    def take_up(self, checkpoint) -> None:
        """Nothing: a liquid has no gas, and what was kept is put back next."""

    def window(self) -> None:
        """Some steps, to the next row of the history at most."""
        begun, before = clock.perf_counter(), self.time
        self.stepper.guard.begin(self)
        if self.at_row:
            self.impulse, self.since = np.zeros(6), self.time
        end, tally = self.clock.next(self.time), Tally(self)
        for _ in range(STRIDE):
            tally.step(end)
            if self.time == end:
                break
        self.windows += 1
        self.stepper.guard.look(self.stepper)
        self.impulse = self.impulse + tally.load[:6]
        self.clock.limit = self.stepper.limit
        self.ledger.close_window(self.stepper, self.time - before, *tally.amounts())
        self.wall["particles"] += clock.perf_counter() - begun

    def row(self) -> dict[str, float]:
        """What history.csv holds: sums over the liquid, and loads on the tank."""
        stepper, case = self.stepper, self.case
        wet = stepper.active
        mass, pressure = self.state.mass[wet], stepper.pressure[wet]
        places, velocities = particles.positions(self.state)[wet], particles.velocities(self.state)[wet]
        values = {
            "time_s": self.time,
            "mass_kg": float(mass.sum()),
            "kinetic_energy_J": kinetic_energy(self.state),
            "potential_energy_J": -float((mass * (places[:, : case.dimensions] @ np.array(case.domain.gravity))).sum()),
            "fastest_m_s": float(np.sqrt((velocities**2).sum(axis=1)).max(initial=0.0)),
            "pressure_largest_Pa": float(pressure.max(initial=0.0)),
            "centre_pressure_Pa": _in_the_middle(places, pressure, case.resolution.spacing),
        }
        for a, name in enumerate("xyz"[: case.dimensions]):
            values[f"centre_{name}_m"] = float((mass * places[:, a]).sum() / mass.sum()) if len(mass) else math.nan
            values[f"momentum_{name}_kg_m_s"] = float((mass * velocities[:, a]).sum())
            values[f"largest_{name}_m"] = float(places[:, a].max()) if len(mass) else math.nan
        return values | by_phase.columns(stepper) | self._drained() | self._loads()

    def _drained(self) -> dict[str, float]:
        if not self.outlet:
            return {}
        commanded = (self.outlet.fill - self.fill(self.time)) * self.stepper.capacity
        return {"drained_kg": float(self.outlet.gone[0]), "commanded_kg": commanded, "pipe_kinetic_energy_J": pipe_energy(self.stepper)}

    def _loads(self) -> dict[str, float]:
        """On the tank: the mean since the last row by the momentum theorem, and what the walls feel now."""
        if "tank" not in self.case.effects:
            return {}
        mean = self.impulse / (self.time - self.since) if self.time > self.since else balance(self.stepper)[:6]
        names = ("force_x_N", "force_y_N", "force_z_N", "moment_x_Nm", "moment_y_Nm", "moment_z_Nm")
        loads = {"mean": mean, "wall": wall_loads(self.stepper)}
        if self.case.parameters["tank"].outlet_radius:
            loads["pipe"] = pipe_loads(self.stepper)  # the part of "wall" that the outlet pipe feels
        return {f"{kind}_{name}": float(value) for kind, load in loads.items() for name, value in zip(names, load)}

    def meshes(self) -> dict:
        """Liquid particles as pyvista points."""
        import pyvista

        wet = self.stepper.active
        cloud = pyvista.PolyData(particles.positions(self.state)[wet])
        if len(wet):  # pyvista knows no empty arrays
            cloud["velocity"] = particles.velocities(self.state)[wet]
            cloud["pressure"] = self.stepper.pressure[wet]
            for name in ("ident", "kind", "mass", "density"):
                cloud[name] = getattr(self.state, name)[wet]
        return {"particles": cloud}

    def walls(self):
        """Those of the tank as a pyvista surface; None where there are none."""
        return tank.shape_of(self.case).surface() if "tank" in self.case.effects else None

    def summary(self, out) -> dict[str, float]:
        """summary.json, its own part."""
        return {"liquid_particles": len(self.stepper.active), "sub_steps": self.stepper.steps, "kinetic_energy_J": kinetic_energy(self.state)}

    def warnings(self) -> list[str]:
        """What the run has to say of itself in the end."""
        mach, c = self.ledger.mach, self.case.liquid.sound_speed
        reached = f"particles reached {mach:.2g} of their speed of sound and were compressed by about {100.0 * mach**2:.0f} %"
        return [f"{reached}: raise liquid.sound_speed_m_s from {c:g} to {10.0 * mach * c:.3g}"] if mach > SLOW else []


class Tally:
    """What a liquid got from where in one window."""

    def __init__(self, run: LiquidRun):
        self.run, self.stepper = run, run.stepper
        self.load = np.zeros(10)  # integral of sdph.methods.liquids.method.balance [N s, N m s, J]
        self.shifted = self.stepper.shifted
        self.gone = run.outlet.gone.copy() if run.outlet else np.zeros(8)
        self.tension = 0.0  # work of surface tension [J]
        self.before = balance(self.stepper)

    def step(self, end: float) -> None:
        """One step, to `end` [s] at most."""
        left, tightening = end - self.stepper.time, self.stepper.tightening
        dt = self.stepper.step(left)
        if dt >= left:
            self.stepper.time = end
        now = balance(self.stepper)
        self.load += 0.5 * dt * (self.before + now)
        self.tension += 0.5 * dt * (tightening + self.stepper.tightening)
        self.before = self._drain(now)

    def _drain(self, now):
        """What the drain is commanded to take; the balance after it."""
        if not self.run.outlet:
            return now
        self.run.outlet.command(self.run.fill(self.stepper.time))
        return balance(self.stepper)

    def amounts(self) -> tuple[dict, dict]:
        """Impulses and amounts for the ledger."""
        gone = (self.run.outlet.gone if self.run.outlet else np.zeros(8)) - self.gone
        given = (self.load[6:9], -self.load[:3], self.stepper.shifted - self.shifted, -gone[1:4])
        works = {"work_of_body_forces_J": float(self.load[9]), "work_of_surface_tension_J": self.tension}
        return dict(zip(IMPULSES, given)), {"drained_kg": float(gone[0]), "drained_J": float(gone[7])} | works


def _in_the_middle(places, pressure, spacing: float) -> float:
    """Mean pressure [Pa] within two spacings of the middle of the liquid; nan where there is none."""
    near = ((places - places.mean(axis=0)) ** 2).sum(axis=1) < (2.0 * spacing) ** 2 if len(places) else np.zeros(0, bool)
    return float(pressure[near].mean()) if near.any() else math.nan
