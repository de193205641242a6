"""Sums of a method that keeps a ledger of its own, and its rows, one a window."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from sdph.engine.kept import ROW, Maybe
from sdph.engine.ledger import refuse_rows
from sdph.engine.table import Table


class Sums:
    """Keeps the sums of one run and writes each row to `ledger.csv` as it comes; AMOUNTS are columns of what a window
    moved, which the row of the start lacks."""

    KEPT, FORMS = ("sums", "first", "last", "table"), {"first": Maybe(ROW), "last": Maybe(ROW)}  # see sdph.engine.kept
    AMOUNTS: tuple[str, ...] = ()

    def __init__(self, path: Path | None):
        self.sums = dict.fromkeys(self.AMOUNTS, 0.0)
        self.first = self.last = None
        self.table = Table(path)

    def admit(self, kept: dict) -> None:
        refuse_rows(kept, self.AMOUNTS)

    def add(self, amounts: dict) -> None:
        """Add up what a window moved."""
        for key, value in amounts.items():
            self.sums[key] += value

    def put(self, row: dict, amounts: dict) -> None:
        """Write a row and what its window moved."""
        self.first, self.last = self.first or row, row | amounts
        self.table.write(self.last)

    def gained(self) -> np.ndarray:
        """Momentum (3,) [kg m/s] that has come since the start."""
        return np.array([self.last[f"momentum_{a}_kg_m_s"] - self.first[f"momentum_{a}_kg_m_s"] for a in "xyz"])
