"""Forces and moments on what `run.forces` names: of the gas on boundaries, integrated over their faces; of grains and
of a liquid on walls, as their methods keep them."""

from __future__ import annotations

import numpy as np

from coupling.gas import Budget
from sdph.case import forces as names
from sdph.engine.walls.parts import told


def mean(case, depth: float, first: Budget | None, now: Budget, time: float) -> dict[str, float]:
    """Mean over `time` [s] between two budgets (first None: since the start) by column: force [N] of pressure and of
    viscous stress on each boundary, and the moment of both about the origin [N m], per metre of depth in two
    dimensions; nan of no time."""
    found = {}
    for name in (name for name in case.run.forces if name in case.boundaries):
        given = np.array(now.patches[name]) - (np.array(first.patches[name]) if first else 0.0)
        force = -given / (time * depth) if time else np.full((3, 3), np.nan)
        found |= told(name, "gas", "viscous", force, case.dimensions)
    return found


def row(methods) -> dict[str, float]:
    """Columns of history.csv of all walls of these methods that have names."""
    return {key: value for own in _pushed(methods) for key, value in own.row().items()}


def summary(methods) -> dict[str, float]:
    """Means of the run."""
    return {key: value for own in _pushed(methods) for key, value in own.summary().items()}


def refuse_nowhere(case, methods) -> None:
    """CaseError where a name is of walls that none of these methods has, or a temperature of such."""
    names.refuse_nowhere(case, {name for own in _pushed(methods) for name in own.names})
    names.refuse_cold(case, {name for own in methods for name in getattr(own, "heated", ())})


def _pushed(methods) -> list:
    return [method.pushed for method in methods if method.pushed]
