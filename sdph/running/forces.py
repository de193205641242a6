"""Forces and moments of the gas on boundaries that `run.forces` names, integrated over their faces."""

from __future__ import annotations

import numpy as np

from coupling.gas import Budget


def mean(case, depth: float, first: Budget | None, now: Budget, time: float) -> dict[str, float]:
    """Mean over `time` [s] between two budgets (first None: since the start) by column: force [N] of pressure and of
    viscous stress on each boundary, and the moment of both about the origin [N m], per metre of depth in two
    dimensions; nan of no time."""
    found, axes = {}, "xyz"[: case.dimensions]
    for name in case.run.forces:
        given = np.array(now.patches[name]) - (np.array(first.patches[name]) if first else 0.0)
        pressed, rubbed, turned = -given / (time * depth) if time else np.full((3, 3), np.nan)
        found |= {f"{name}_gas_pressure_force_{a}_N": float(value) for a, value in zip(axes, pressed)}
        found |= {f"{name}_gas_viscous_force_{a}_N": float(value) for a, value in zip(axes, rubbed)}
        about = zip("xyz", turned) if case.dimensions == 3 else [("z", turned[2])]
        found |= {f"{name}_gas_moment_{a}_Nm": float(value) for a, value in about}
    return found
