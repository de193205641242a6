"""A run without a gas: a method alone goes from row to row of its history."""

from __future__ import annotations

from pathlib import Path

from sdph.engine import clock
from sdph.engine.kept import Unfit
from sdph.engine.world import here
from sdph.methods.liquids.liquid import Liquid
from sdph.methods.mps.mps import Mps
from sdph.methods.solids.solid import Solids
from sdph.running import compiling, forces, history
from sdph.running.limiters import Limiters

STRIDE = 20  # steps in a window at most: one that goes unstable is caught within these (our choice)


METHODS = {"liquid": Liquid, "mps": Mps, "solid": Solids}  # as `Case.moved_by` names them


class Alone:
    """A liquid or solids without a gas; call `window` until `time` is the end."""

    gas = None
    KEPT = ("windows", "wall", "clock", "method", "limiters")  # see sdph.engine.kept

    def __init__(self, case, ledger: Path | None):
        self.case = case
        self.matter = case.matters[0]
        self.clock = clock.alone(case)
        self.method = self._make(ledger)
        self.limiters = Limiters()
        self.limiters.hear(self.method.held())
        self.windows, self.wall, self.notices = 0, {"particles": 0.0, "compiling": 0.0}, []

    def _make(self, ledger: Path | None):
        """The method of the case."""
        return METHODS[self.case.moved_by(self.matter)](self.case, ledger, self.clock.shortest)

    @property
    def state(self):
        return self.method.state

    @property
    def stepper(self):
        return self.method.stepper

    @property
    def methods(self) -> list:
        """The one."""
        return [self.method]

    @property
    def ledger(self):
        return self.method.ledger

    @property
    def time(self) -> float:
        return self.method.time

    def whole(self):
        """Context in which the first process holds all particles; True there."""
        return self.method.whole()

    @property
    def at_row(self) -> bool:
        """True where the history has a row of now."""
        return self.clock.rows_at(self.time)

    @staticmethod
    def time_of(kept: dict) -> float:
        """Time [s] of what was kept."""
        return kept["method"]["stepper"]["time"]

    @staticmethod
    def windows_of(kept: dict) -> int:
        """Windows of what was kept."""
        return kept["windows"]

    def tables(self) -> list:
        """Ledgers that are open."""
        return self.method.tables()

    def start(self) -> None:
        self.method.start()

    def admit(self, kept: dict) -> None:
        """Unfit where the method has gone through other windows."""
        if kept["windows"] != kept["method"]["windows"]:
            raise Unfit("its windows are not those of its method")

    def take_up(self, checkpoint) -> None:
        """Nothing: there is no gas, and what was kept is put back next."""

    def window(self) -> None:
        """Some steps, to the next row of the history at most."""
        if self.at_row:
            self.method.new_row()
        compiling.timed(self.wall, "particles", self._advance)
        self.notices += [f"t = {self.time:.4g} s: {line}" for line in self.method.news()]
        self.limiters.hear(self.method.held())
        self.windows += 1
        self.clock.limit = self.method.limit

    def _advance(self) -> None:
        self.method.begin()
        self.method.advance(self.clock.next(self.time), STRIDE)
        self.method.close()

    def row(self) -> dict[str, float]:
        """Columns of history.csv."""
        return {"time_s": self.time} | self.method.row() | forces.row(self.methods) | self._probes() | self.limiters.now

    def _probes(self) -> dict[str, float]:
        if not self.case.probes:
            return {}
        if self.matter == "solid":
            return history.of_solid(self.case, self.stepper)
        return history.of_liquid(self.case, self.method.points(), here())

    def meshes(self) -> dict:
        """Particles of this process for the timeline."""
        return {"particles": self.method.points()}

    def walls(self):
        """Walls as a pyvista surface; None where there are none."""
        return self.method.walls()

    def summary(self, out) -> dict[str, float]:
        """summary.json, its own part."""
        own = self.method.summary() | forces.summary(self.methods)
        return {"sub_steps": self.method.steps} | own | self.limiters.summary()

    def warnings(self) -> list[str]:
        """Notes for the user on how the run went."""
        return self.method.warnings()
