"""A liquid in its tank, as a run needs it (sdph.methods.method.Method): stepper, drain, ledger, loads on the tank."""

from __future__ import annotations

import contextlib
from pathlib import Path

import numpy as np

from sdph.effects.around import drain, tank
from sdph.engine import arrays, ashore, gathered
from sdph.engine import state as particles
from sdph.engine.kept import Unfit
from sdph.engine.stepped import Stepped
from sdph.engine.walls.parts import Pushed
from sdph.methods.liquids import aboard, account, history, limiters
from sdph.methods.liquids.bodies import Carrier
from sdph.methods.liquids.loads import kinetic_energy
from sdph.methods.liquids.method import LiquidStepper
from sdph.methods.liquids.outlet import Outlet
from sdph.methods.liquids.totals import LiquidLedger
from sdph.methods.liquids.window import Tally

# of the speed of sound: a liquid that is faster is compressed by 4 % (u2/c2); the rule is 0.1, twice that is told of
SLOW = 0.2


class Liquid(Stepped):
    """A liquid and what it does in a window."""

    matter = "liquid"
    # see sdph.engine.kept
    KEPT = (
        "windows", "stepper", "outlet", "ledger", "rates", "impulse", "since", "pace", "scaled", "pushed",
    )  # fmt: skip

    def __init__(self, case, ledger: Path | None, shortest: float, carrier: Carrier | None = None):
        self.case, self.windows = case, 0
        self.stepper, self.ledger = LiquidStepper(case, shortest, carrier), LiquidLedger(ledger)
        self.outlet = Outlet(self.stepper) if "drain" in case.effects else None
        self.fill = drain.command(case.parameters["drain"], self.outlet.fill) if self.outlet else None
        self.rates = account.rates(self.stepper, 0.0, None)  # what acts now
        self.scaled = np.zeros(4)  # impulse [N s] and energy [J] by `hasten` since the last window
        self.pace = 1.0  # seconds that pass for heat in one of the motion: sdph.effects.liquids.time_scaling
        named = self.stepper.parts.names if self.stepper.parts else ()
        self.pushed = Pushed("liquid", "viscous", named, case.dimensions, case.run.average_from)
        self.impulse, self.since = np.zeros(6), 0.0  # force and moment on the tank since the last row, and its time [s]

    def admit(self, kept: dict) -> None:
        """Unfit where time is not that of the ledger, or the outlet's memory does not fit to the particles."""
        time = kept["stepper"]["time"]
        if time != kept["ledger"]["last"]["time_s"] or not 0.0 <= kept["since"] <= time:
            raise Unfit("its time is not that of the ledger")
        if self.outlet:
            self.outlet.admit_at(time, kept["outlet"], kept["stepper"])

    def push(self, acceleration) -> None:
        """Take an acceleration (N, 3) [m/s2] from outside, that holds over the next window."""
        nothing = np.zeros(0)
        self.stepper.state = particles.forced(self.state, nothing, acceleration, nothing)

    def advance(self, end: float, most: float = np.inf) -> None:
        """Go to `end` [s], or as far as `most` steps get."""
        if self.case.run.device != "cpu" and arrays.here(self.state.x):
            aboard.board(self.stepper)
        if self.stepper.void:
            self.stepper.void.open(self.stepper)
        self.tally, done = Tally(self), 0
        while self.time != end and done < most:
            self.tally.step(end)
            done += 1
        if self.stepper.heat:
            self.stepper.heat.advance(self.pace * (self.time - self.begun))
        if self.stepper.void:
            self.stepper.void.vent(self.pace * (self.time - self.begun))
        self.windows += 1

    def close(self) -> None:
        self.impulse = self.impulse + self.tally.sums[account.LOADS]
        self.pushed.add(self.tally.sums[account.SIZE :].reshape(-1, 3, 3), self.begun, self.time)
        self.stepper.guard.look(self.stepper)
        self.ledger.close_window(self.stepper, self.time - self.begun, *self.tally.amounts())
        self.scaled = np.zeros(4)
        if len(self.state.push_x):
            self.stepper.state = particles.released(self.state)

    def hasten(self, pace: float, kick: float) -> None:
        """Let `pace` seconds pass for heat in each second of motion from now on; velocities become `kick` times as
        large."""
        s, own = self.state, self.stepper.active
        before, energy = s.mass[own] @ particles.velocities(s)[own], kinetic_energy(s)
        for axis in (s.u, s.v, s.w):
            axis *= kick
        gain = s.mass[own] @ particles.velocities(s)[own] - before
        self.scaled, self.pace = np.append(gain, kinetic_energy(s) - energy), pace

    def new_row(self) -> None:
        """Begin the mean of the loads anew: the history has a row of now."""
        self.impulse, self.since = np.zeros(6), self.time
        self.pushed.new_row()

    @contextlib.contextmanager
    def whole(self):
        stepper = self.stepper
        before = stepper.active
        with ashore.ashore(stepper), gathered.whole(stepper) as chief:
            if not stepper.domain.alone:
                stepper.active = np.flatnonzero(particles.wet(stepper.state)).astype(before.dtype)
            try:
                yield chief
            finally:
                stepper.active = before

    def news(self) -> list[str]:
        told = list(self.stepper.void.news) if self.stepper.void else []
        if told:
            self.stepper.void.news.clear()
        return told

    def row(self) -> dict[str, float]:
        loads = history.loads(self)
        with ashore.ashore(self.stepper):
            return history.row(self) | loads

    def held(self) -> dict[str, float]:
        """Shares that limiters hold now, by column of history.csv."""
        return limiters.held(self.stepper)

    def points(self):
        with ashore.ashore(self.stepper):
            return self._points()

    def _points(self):
        import pyvista

        wet = self.stepper.active
        cloud = pyvista.PolyData(particles.positions(self.state)[wet])
        if len(wet):  # pyvista knows no empty arrays
            cloud["velocity"] = particles.velocities(self.state)[wet]
            cloud["pressure"] = self.stepper.pressure[wet]
            for name in ("ident", "kind", "mass", "density"):
                cloud[name] = getattr(self.state, name)[wet]
        return cloud

    def walls(self):
        return tank.shape_of(self.case).surface() if "tank" in self.case.effects else None

    def summary(self) -> dict[str, float]:
        with self.whole():
            own = {"liquid_particles": len(self.stepper.active), "kinetic_energy_J": kinetic_energy(self.state)}
        own |= self.stepper.domain.summary(self.steps - self.stepper.steps_before) | ashore.told(self.stepper)
        parts = [part.summary() for part in (self.stepper.void, self.stepper.heat) if part]
        return own | {name: value for part in parts for name, value in part.items()}

    def warnings(self) -> list[str]:
        mach, c = self.ledger.mach, self.case.liquid.sound_speed
        reached = f"particles reached {mach:.2g} of their speed of sound"
        compressed = f"{reached} and were compressed by about {100.0 * mach**2:.0f} %"
        wanted = f"raise liquid.sound_speed_m_s from {c:g} to {10.0 * mach * c:.3g}"
        found = [f"{compressed}: {wanted}"] if mach > SLOW else []
        found += self.outlet.warnings() if self.outlet else []
        return found + (self.stepper.openings.warnings() if self.stepper.openings else [])
