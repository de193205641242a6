"""A liquid on its way, as `sdph.running.driver` runs it: the same calls as `sdph.running.simulation.Simulation` has,
without a gas."""

from __future__ import annotations

import time as clock
from pathlib import Path

import numpy as np

from sdph.effects.around import drain, tank
from sdph.engine import state as particles
from sdph.engine.clock import Clock
from sdph.engine.kept import Unfit
from sdph.methods.liquids import history
from sdph.methods.liquids.loads import kinetic_energy
from sdph.methods.liquids.method import LiquidStepper
from sdph.methods.liquids.outlet import Outlet
from sdph.methods.liquids.totals import LiquidLedger
from sdph.methods.liquids.window import Tally

SAMPLES = 10  # rows of history.csv for each output of fields, where the case says nothing
STRIDE = 20  # steps in a window at most: a liquid that goes unstable is caught within these (our choice)
# of the speed of sound: a liquid that is faster is compressed by 4 % (u2/c2); the rule is 0.1, twice that is told of
SLOW = 0.2


class LiquidRun:
    """A liquid in its tank; call `window` until `time` is the end."""

    KEPT = ("windows", "wall", "stepper", "outlet", "clock", "ledger", "impulse", "since")  # see sdph.engine.kept

    def __init__(self, case, ledger: Path):
        self.case, self.gas, self.clock = (
            case,
            None,
            Clock(case.run, case.liquid.history_interval or case.run.output_interval / SAMPLES),
        )
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
        return history.row(self)

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
        return {
            "liquid_particles": len(self.stepper.active),
            "sub_steps": self.stepper.steps,
            "kinetic_energy_J": kinetic_energy(self.state),
        }

    def warnings(self) -> list[str]:
        """What the run has to say of itself in the end."""
        mach, c = self.ledger.mach, self.case.liquid.sound_speed
        reached = (
            f"particles reached {mach:.2g} of their speed of sound and were compressed by about {100.0 * mach**2:.0f} %"
        )
        return [f"{reached}: raise liquid.sound_speed_m_s from {c:g} to {10.0 * mach * c:.3g}"] if mach > SLOW else []
