"""The outlet of a tank as it works: which particles lose mass, and what leaves with them."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from sdph.effects.around import drain, tank
from sdph.engine import state as particles
from sdph.engine.kept import GROWING, Unfit
from sdph.engine.ledger import IN
from sdph.engine.state import WALL
from sdph.methods.liquids.totals import specific_energies

CRUMB = 1e-12  # of a particle's mass: less than that is nothing
# spacings above its outlet's end, from which on what a drain takes shows that nothing stood lower, and the share of all
# that it took from which on that is told; the lowest row stands half a spacing over the end. Our choice
ABOVE, TOLD = 3.0, 0.02


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
        self.above, self.first = 0.0, math.nan  # mass [kg] that stood far above the end; time of the first of it [s]

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
        while owed > CRUMB * self.particle and (lowest := self._lowest(owed)):
            left = owed - np.cumsum([one.mass for one in lowest])
            whole = lowest[: np.count_nonzero(left >= -CRUMB * self.particle)]
            if not whole:
                self._take_from(lowest[0], owed)
                break
            self._take(whole)
            owed = left[len(whole) - 1]

    def _lowest(self, owed: float) -> list[Lowest]:
        """The lowest particles, from the bottom up, until they hold a mass `owed` [kg], wherever they are."""
        st, s = self.stepper, self.stepper.state
        heights = particles.axes(s)[-1][st.active]
        order = np.argsort(heights, kind="stable")
        own = st.active[order[: 1 + np.searchsorted(np.cumsum(s.mass[st.active][order]), owed)]]
        rows = zip(
            particles.axes(s)[-1][own].tolist(), s.ident[own].tolist(), s.mass[own].tolist(),
            sum(specific_energies(st, own)).tolist(), particles.positions(s)[own], particles.velocities(s)[own],
            st.acceleration[own].copy(),
        )  # fmt: skip
        found = sorted(
            (one for part in st.world.everywhere([Lowest(*row) for row in rows]) for one in part),
            key=lambda one: one[:2],
        )
        return found[: 1 + int(np.searchsorted(np.cumsum([one.mass for one in found]), owed))]

    def _take(self, whole: list[Lowest]) -> None:
        """Takes particles out, all that they are; neighbours and forces are made anew once for all of them."""
        for one in whole:
            self._count(one, one.mass)
        if self.form == "paper":
            self._release(whole)
        else:
            self._remove(self._rows([one.ident for one in whole]))

    def _take_from(self, lowest: Lowest, owed: float) -> None:
        """Takes a mass [kg] out of a particle that has more."""
        self._count(lowest, owed)
        self.stepper.state.mass[self._rows([lowest.ident])] -= owed
        self.pushed = self.pushed + owed * lowest.acceleration

    def _count(self, lowest: Lowest, taken: float) -> None:
        self.place, moment = lowest.place, np.cross(lowest.place, lowest.velocity)
        self.gone += taken * np.concatenate(([1.0], lowest.velocity, moment, [lowest.energy]))
        if lowest.height > self.end + ABOVE * self.stepper.case.resolution.spacing:
            self.first = self.stepper.time if not self.above else self.first
            self.above += taken

    def warnings(self) -> list[str]:
        """A line where the drain takes liquid from above an outlet that has run empty, since the run began or went
        on."""
        if self.above <= TOLD * self.gone[0]:
            return []
        return [
            f"from {self.first:.4g} s on the drain took liquid that stood more than {ABOVE:g} spacings above the end "
            f"of its outlet, {self.above / self.gone[0]:.2g} of all that it took: the outlet had run empty, as liquid "
            "does not come there as fast as it is commanded; let drain.end_s be later, or the outlet wider"
        ]

    def _rows(self, idents) -> np.ndarray:
        """Rows of particles, or of their copies; none in processes that have neither."""
        return np.flatnonzero(np.isin(self.stepper.state.ident, idents))

    def _release(self, whole: list[Lowest]) -> None:
        """Particles go out as pieces of wall, whose push fades."""
        gone = [(one.ident, one.height - self.end, self.stepper.time, one.mass) for one in whole]
        self.leaving = np.vstack((self.leaving, gone))
        kind = self.stepper.state.kind.copy()
        kind[self._rows([one.ident for one in whole])] = WALL
        self.stepper.replace(self.stepper.state._replace(kind=kind))
        self.stepper.forces()

    def _fade(self) -> None:
        """Moves what leaves to the outlet's end at an even speed; its volume goes with xi of what is left of the
        way."""
        st = self.stepper
        left = 1.0 - (st.time - self.leaving[:, 2]) / self.interval if len(self.leaving) else np.zeros(0)
        done = (left <= 0.0) | (self.leaving[:, 1] <= 0.0)
        if done.any():
            self._remove(self._rows(self.leaving[done, 0]))
            self.leaving, left = self.leaving[~done], left[~done]
        for (number, way, _, mass), share in zip(self.leaving, left):
            rows = self._rows([number])
            particles.axes(st.state)[-1][rows], st.state.mass[rows] = self.end + share * way, mass * fading(share)
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
