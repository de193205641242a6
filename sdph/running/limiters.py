"""Limiters in a run (docs/limiters.md): shares and numbers of particles that they hold after each window."""

from __future__ import annotations

from sdph.engine.kept import Named
from sdph.running import fast_gas

# told beside limiters, of what a step leaves and how fast gas is; nothing is held
BESIDE = ("gas_splitting_rel", fast_gas.MACH, fast_gas.SPEED)
LARGEST = "largest_"  # how keys of the summary begin


class Limiters:
    """`now` by column of history.csv, and the `largest` of the run."""

    KEPT, FORMS = ("largest",), {"largest": Named(0.0)}  # see sdph.engine.kept

    def __init__(self):
        self.now: dict[str, float] = {}
        self.largest: dict[str, float] = {}

    def hear(self, told: dict[str, float]) -> None:
        """Take what is told after a window."""
        self.now = told
        self.largest = {column: max(value, self.largest.get(column, value)) for column, value in told.items()}

    def summary(self) -> dict[str, float]:
        """Its part of summary.json."""
        return {f"{LARGEST}{column}": value for column, value in self.largest.items()}


def acted(summary: dict) -> dict[str, float]:
    """The largest of the run of each limiter that acted in it, by column of history.csv."""
    told = {key.removeprefix(LARGEST): value for key, value in summary.items() if key.startswith(LARGEST)}
    return {column: value for column, value in told.items() if value and column not in BESIDE}
