"""Highest and lowest in the rows of the history of what a case asks for by name, probes and forces, from
`run.average_from` on."""

from __future__ import annotations

import math

from sdph.engine.kept import Named
from sdph.running.metrics import SAME_TIME


class Extremes:
    """The `highest` and `lowest` so far by column of history.csv, for the summary."""

    KEPT, FORMS = ("highest", "lowest"), {"highest": Named(0.0), "lowest": Named(0.0)}  # see sdph.engine.kept

    def __init__(self, case):
        self.named = tuple(f"{name}_" for name in (*case.probes, *case.run.forces))
        self.since = case.run.average_from * (1.0 - SAME_TIME)  # s
        self.highest: dict[str, float] = {}
        self.lowest: dict[str, float] = {}

    def hear(self, row: dict[str, float]) -> None:
        """Take a row of the history; nan counts for nothing, nor does what is before the means of a run begin."""
        if row["time_s"] < self.since:
            return
        for column, value in row.items():
            if column.startswith(self.named) and not math.isnan(value):
                self.highest[column] = max(value, self.highest.get(column, value))
                self.lowest[column] = min(value, self.lowest.get(column, value))

    def summary(self) -> dict[str, float]:
        """Its part of summary.json."""
        ends = {"highest": self.highest, "lowest": self.lowest}
        return {f"{end}_{column}": value for end, own in ends.items() for column, value in own.items()}
