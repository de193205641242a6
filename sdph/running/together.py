"""A run of a liquid and solid bodies that touch: the liquid's steps, and the bodies' within them."""

from __future__ import annotations

from pathlib import Path

from sdph.engine.kept import Unfit
from sdph.methods.liquids.liquid import Liquid
from sdph.running import history
from sdph.running.alone import Alone
from sdph.running.wetted import Wetted


class Together(Alone):
    """A liquid `Alone`, with bodies in it."""

    KEPT = ("windows", "wall", "clock", "bodies", "method", "limiters")  # see sdph.engine.kept

    def _make(self, ledger: Path):
        liquid = self.case.only("liquid")
        self.bodies = Wetted(self.case, ledger.with_name("ledger_solid.csv"), self.clock.shortest)
        return Liquid(liquid, ledger, self.clock.shortest, self.bodies)

    @property
    def solids(self):
        return self.bodies.solids

    def tables(self) -> list:
        return [*super().tables(), self.solids.ledger.table]

    def start(self) -> None:
        super().start()
        self.solids.start()

    def admit(self, kept: dict) -> None:
        """Unfit where liquid and bodies are not at one time and window."""
        super().admit(kept)
        own = kept["bodies"]["solids"]
        if (own["windows"], own["stepper"]["time"]) != (kept["windows"], kept["method"]["stepper"]["time"]):
            raise Unfit("its bodies are at another time than its liquid")

    def _advance(self) -> None:
        self.bodies.begin()
        super()._advance()
        self.bodies.close(self.time, self.method.limit)

    def row(self) -> dict[str, float]:
        return super().row() | _named(self.solids.row())

    def _probes(self) -> dict[str, float]:
        """Columns of the probes in the liquid, and of those that go along with a body."""
        return super()._probes() | (history.of_solid(self.case, self.solids.stepper) if self.case.probes else {})

    def meshes(self) -> dict:
        return super().meshes() | {"solid": self.solids.points()}

    def summary(self, out) -> dict[str, float]:
        return super().summary(out) | _named(self.solids.summary() | self.solids.ledger.summary())

    def warnings(self) -> list[str]:
        return super().warnings() + self.solids.warnings()


def _named(values: dict) -> dict:
    """Values under names that begin with their matter."""
    return {f"solid_{key.removeprefix('solid_')}": value for key, value in values.items() if key != "time_s"}
