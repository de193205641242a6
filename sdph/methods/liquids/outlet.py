"""The outlet of a tank as it works: which particles lose mass, and what leaves with them."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from sdph.effects.around import drain, tank
from sdph.engine import state as particles
from sdph.engine.kept import GROWING, Unfit
from sdph.engine.state import WALL
from sdph.methods.liquids.openings import IN
from sdph.methods.liquids.totals import specific_energies

ROUND_OFF = 1e-12  # of a particle's mass: less than that is nothing


class Lowest(NamedTuple):
    """The lowest particle of liquid: height [m], number, mass [kg], energy [J/kg], place (3,) [m], velocity (3,) [m/s],
    acceleration (3,) [m/s2]."""

    height: float
    ident: int
    mass: float
    energy: float
    place: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray


class Outlet:
    """Takes from a stepper's liquid what is commanded; sums up what has gone: mass, momentum, angular momentum,
    energy."""

    KEPT, FORMS = ("place", "gone", "leaving", "pushed"), {"leaving": GROWING}  # see sdph.engine.kept

    def __init__(self, stepper):
        case = stepper.case
        self.stepper, own = stepper, case.parameters.get("drain")
        self.form, self.interval = (own.form, own.interval) if own else (drain.FORMS[0], 0.0)
        self.particle = stepper.born.heaviest_liquid
        self.fill = drain.filled(case)
        lowest = stepper.world.least(float(particles.axes(stepper.state)[-1].min(initial=np.inf)))
        self.end = lowest + (tank.layers(case) - 0.5) * case.resolution.spacing  # height of the outlet's end [m]
        self.place = np.zeros(3)  # where the last of it went [m]
        # mass [kg], momentum (3) [kg m/s], angular momentum (3) [kg m2/s], energy [J], in the frame
        self.gone = np.zeros(8)
        # particles on their way out: number; way to go [m], time [s], mass [kg] when chosen
        self.leaving = np.zeros((0, 4))
        self.pushed = np.zeros(3)  # force [N] on what was taken, which the next kick does not give

    def admit_at(self, time: float, kept: dict, stepper: dict) -> None:
        """Unfit where more has gone at `time` [s] than there was and came in, or who leaves is not among the pieces of
        wall; `stepper` as kept."""
        state, there = stepper["state"], self.stepper.born.mass
        if self.stepper.p["inflow"]:
            there += stepper["openings"]["passed"][IN, 0]
        number, _, begun, mass = kept["leaving"].T
        walls = state["ident"][state["kind"] == WALL]
        on_the_way = np.isin(number, walls) & (begun >= 0.0) & (begun <= time) & (mass > 0.0) & (mass <= self.particle)
        if not on_the_way.all() or not 0.0 <= kept["gone"][0] <= there:
            raise Unfit("what has left through the outlet, or is about to, was never there")

    def command(self, fill: float) -> None:
        """Takes out what is left of the command that the tank be filled to `fill`."""
        self.pushed = np.zeros(3)
        self._fade()
        owed = (self.fill - fill) * self.stepper.capacity - self.gone[0]
        if self.form == "paper":
            owed = self.particle * np.floor(owed / self.particle + 0.5)
        # a tank of whole particles may hold half a one less
        while owed > ROUND_OFF * self.particle and (lowest := self._lowest()) is not None:
            owed -= self._take(lowest, owed)

    def _lowest(self) -> Lowest | None:
        """The lowest particle, which one process has; None where there is none."""
        st, s = self.stepper, self.stepper.state
        heights, found = particles.axes(s)[-1][st.active], None
        if len(heights):
            i = st.active[np.argmin(heights)]
            energy = float(sum(specific_energies(st, [i]))[0])
            moves = particles.positions(s)[i], particles.velocities(s)[i], st.acceleration[i].copy()
            found = Lowest(float(heights.min()), int(s.ident[i]), float(s.mass[i]), energy, *moves)
        return min((one for one in st.world.everywhere(found) if one), key=lambda one: one[:2], default=None)

    def _take(self, lowest: Lowest, owed: float) -> float:
        """Mass [kg] taken out of the lowest particle, `owed` at most."""
        taken, st = min(owed, lowest.mass), self.stepper
        self.place, moment = lowest.place, np.cross(lowest.place, lowest.velocity)
        self.gone += taken * np.concatenate(([1.0], lowest.velocity, moment, [lowest.energy]))
        if lowest.mass - taken > ROUND_OFF * self.particle:
            st.state.mass[self._rows(lowest.ident)] -= taken
            self.pushed = self.pushed + taken * lowest.acceleration
            return taken
        if self.form == "paper":
            self._release(lowest)
        else:
            self._remove(self._rows(lowest.ident))
        self.pushed = np.zeros(3)
        return taken

    def _rows(self, ident: int) -> np.ndarray:
        """Row of a particle, or of its copy; none in processes that have neither."""
        return np.flatnonzero(self.stepper.state.ident == ident)

    def _release(self, lowest: Lowest) -> None:
        """The lowest particle goes out as a piece of wall, whose push fades."""
        way = lowest.height - self.end
        self.leaving = np.vstack((self.leaving, (lowest.ident, way, self.stepper.time, lowest.mass)))
        kind = self.stepper.state.kind.copy()
        kind[self._rows(lowest.ident)] = WALL
        self.stepper.replace(self.stepper.state._replace(kind=kind))
        self.stepper.forces()

    def _fade(self) -> None:
        """Moves what leaves to the outlet's end at an even speed; its volume goes with xi of what is left of the
        way."""
        st = self.stepper
        for row in self.leaving:
            number, way, begun, mass = row
            rows, left = self._rows(int(number)), 1.0 - (st.time - begun) / self.interval
            if left <= 0.0 or way <= 0.0:
                self._remove(rows)
                self.leaving = self.leaving[self.leaving[:, 0] != number]
                continue
            particles.axes(st.state)[-1][rows], st.state.mass[rows] = self.end + left * way, mass * fading(left)
            st.volume[rows] = -st.state.mass[rows] / st.state.density[rows]

    def _remove(self, rows) -> None:
        """Take particles out; neighbours and forces are made anew."""
        keep = np.ones(len(self.stepper.state.x), bool)
        keep[rows] = False
        self.stepper.leave(keep)
        self.stepper.forces()


def fading(left: float) -> float:
    """xi = (exp(s/s_0) - 1)/(e - 1): paper T, Eq. 14; left = s/s_0, 1 at the start and 0 at the outlet's end."""
    return math.expm1(left) / math.expm1(1.0)
