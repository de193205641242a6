"""Runs of the reduced model, and the table of the other one.

The other model (course.csv, ring.csv and the numbers in `changes`) is that of issue 20's specification: a shell in one
dimension of 24 layers, a saturated bubble, conduction; made apart from ours, own error below 0.1 %.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from sdph.study.gel_droplet import sections
from sdph.study.gel_droplet.course import Course

EVEN = "shell.flaw=0"
HERE = Path(__file__).parent


def course(*overrides: str) -> Course:
    """Course of the base case with overrides."""
    return Course(sections.load(None, overrides))


def table(name: str) -> np.ndarray:
    """Rows of a CSV beside this file, columns by name."""
    return np.genfromtxt(HERE / f"{name}.csv", delimiter=",", names=True)


def time_at(found: Course, ratio: float) -> float:
    """Time [s] at which D/D_0 is reached, nan where it is not."""
    grown = slice(0, None if found.tear is None else found.tear + 1)
    h = found.history
    return float(np.interp(ratio, h["diameter_ratio"][grown], h["time_s"][grown], right=np.nan))
