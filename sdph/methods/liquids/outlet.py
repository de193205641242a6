"""The outlet of a tank as it works: which particles lose mass, and what leaves with them."""

from __future__ import annotations

import math

import numpy as np

from sdph.effects.around import drain, tank
from sdph.engine import state as particles
from sdph.engine.kept import GROWING, Unfit
from sdph.engine.state import WALL
from sdph.methods.liquids.totals import specific_energies

ROUND_OFF = 1e-12  # of a particle's mass: less than that is nothing


class Outlet:
    """Takes from a stepper's liquid what is commanded; sums up what has gone: mass, momentum, angular momentum,
    energy."""

    KEPT, FORMS = ("place", "gone", "leaving", "pushed"), {"leaving": GROWING}  # see sdph.engine.kept

    def __init__(self, stepper):
        case = stepper.case
        self.stepper, own = stepper, case.parameters.get("drain")
        self.form, self.interval = (own.form, own.interval) if own else (drain.FORMS[0], 0.0)
        self.particle = float(stepper.state.mass[stepper.active].max())
        self.fill = next((pool.fill for pool in case.pools.values() if pool.fill), 1.0)
        lowest = particles.axes(stepper.state)[-1].min()
        self.end = lowest + (tank.layers(case) - 0.5) * case.resolution.spacing  # height of the outlet's end [m]
        self.place = np.zeros(3)  # where the last of it went [m]
        # mass [kg], momentum (3) [kg m/s], angular momentum (3) [kg m2/s], energy [J], in the frame
        self.gone = np.zeros(8)
        # particles on their way out: number; way to go [m], time [s], mass [kg] when chosen
        self.leaving = np.zeros((0, 4))
        self.pushed = np.zeros(3)  # force [N] on what was taken, which the next kick does not give

    def admit_at(self, time: float, kept: dict, state: dict) -> None:
        """Unfit where more has gone at `time` [s] than there was, or who leaves is not among the pieces of wall."""
        number, _, begun, mass = kept["leaving"].T
        walls = state["ident"][state["kind"] == WALL]
        on_the_way = np.isin(number, walls) & (begun >= 0.0) & (begun <= time) & (mass > 0.0) & (mass <= self.particle)
        if not on_the_way.all() or not 0.0 <= kept["gone"][0] <= self.stepper.state.mass.sum():
            raise Unfit("what has left through the outlet, or is about to, was never there")

    def command(self, fill: float) -> None:
        """Takes out what is left of the command that the tank be filled to `fill`."""
        self.pushed = np.zeros(3)
        self._fade()
        owed = (self.fill - fill) * self.stepper.capacity - self.gone[0]
        if self.form == "paper":
            owed = self.particle * np.floor(owed / self.particle + 0.5)
        # a tank of whole particles may hold half a one less
        while owed > ROUND_OFF * self.particle and len(self.stepper.active):
            owed -= self._take(owed)

    def _take(self, owed: float) -> float:
        """Mass [kg] taken out of the lowest particle, `owed` at most."""
        st = self.stepper
        s = st.state
        i = st.active[np.argmin(particles.axes(s)[-1][st.active])]
        taken = min(owed, float(s.mass[i]))
        velocity, place = particles.velocities(s)[i], particles.positions(s)[i]
        self.place = place
        energy = sum(specific_energies(st, [i]))
        self.gone += taken * np.concatenate(([1.0], velocity, np.cross(place, velocity), energy))
        if s.mass[i] - taken > ROUND_OFF * self.particle:
            s.mass[i] -= taken
            self.pushed = self.pushed + taken * st.acceleration[i]
        elif self.form == "paper":
            self._release(i)
            self.pushed = np.zeros(3)
        else:
            st.remove(i)
            self.pushed = np.zeros(3)
        return taken

    def _release(self, i: int) -> None:
        """Particle i goes out as a piece of wall, whose push fades."""
        st, s = self.stepper, self.stepper.state
        way = float(particles.axes(s)[-1][i]) - self.end
        self.leaving = np.vstack((self.leaving, (s.ident[i], way, st.time, s.mass[i])))
        st.set_aside(i)

    def _fade(self) -> None:
        """Moves what leaves to the outlet's end at an even speed; its volume goes with xi of what is left of the
        way."""
        st = self.stepper
        for row in self.leaving:
            number, way, begun, mass = row
            i, left = int(np.flatnonzero(st.state.ident == int(number))[0]), 1.0 - (st.time - begun) / self.interval
            if left <= 0.0 or way <= 0.0:
                st.remove(i)
                self.leaving = self.leaving[self.leaving[:, 0] != number]
                continue
            st.move_wall(i, self.end + left * way, mass * fading(left))


def fading(left: float) -> float:
    """xi = (exp(s/s_0) - 1)/(e - 1): paper T, Eq. 14; left = s/s_0, 1 at the start and 0 at the outlet's end."""
    return math.expm1(left) / math.expm1(1.0)
