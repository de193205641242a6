"""Finished runs that nobody has run: history, fields and tables as a test tells them."""

from dataclasses import dataclass, field
from pathlib import Path
from types import SimpleNamespace

import numpy as np

from sdph import scenes
from sdph.case import read as cases
from sdph.study import compare


class Cloud(dict):
    """As pyvista points: places (N, 3) [m], and arrays by name."""

    def __init__(self, points, **arrays):
        super().__init__({name: np.asarray(values) for name, values in arrays.items()})
        self.points = np.asarray(points, float)


@dataclass(frozen=True)
class Told(compare.Finished):
    """`clouds` by time [s]; `tables`, name -> columns, in place of files."""

    clouds: dict = field(default_factory=dict)
    tables: dict = field(default_factory=dict)

    @property
    def ledger(self):
        return self.tables["ledger"]

    @property
    def metrics(self):
        return self.tables["metrics"]

    def fields(self, time):
        return time, self.clouds[time], None


def told(scene: str, end: float, overrides=(), summary=None, history=None, clouds=None, **tables) -> Told:
    """A run of a scene to `end` [s]."""
    case = cases.load(scenes.find(scene)[1], tuple(overrides))
    summary = {"time_s": end} | (summary or {})
    return Told(Path("run"), case, summary, history or {}, clouds=clouds or {}, tables=tables)


def with_outputs(monkeypatch, times) -> None:
    """Runs have outputs at `times` [s]."""
    monkeypatch.setattr(compare.timeline, "read", lambda folder: SimpleNamespace(time_values=sorted(times)))
