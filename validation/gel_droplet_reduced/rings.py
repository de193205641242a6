"""Rings that are inflated at 5 1/s of D/D_0: pressure against the other model, and the plastic limit."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from sdph.effects.gas import gel
from sdph.laws import shells
from sdph.study.compare import check

from . import runs

BAR = 0.02  # issue 20's specification, points 4 and 5
INNER, OUTER, RATE, STEP, LAYERS = 4.5e-4, 5e-4, 5.0, 2.5e-4, 8  # m, 1/s; step of D/D_0 and layers by convergence


def pressures(shell: gel.Shell, ratios, dims: int = 2, layers: int = LAYERS) -> np.ndarray:
    """Pressures [Pa] inside a shell at D/D_0 of `ratios`, driven at RATE."""
    edges, rows = shells.layers(INNER, OUTER, layers)
    after, found, reached = rows.copy(), [0.0], np.arange(1.0, max(ratios) + 2 * STEP, STEP)
    constants = gel.plastic(shell), gel.damage(shell), *gel.moduli(shell)
    for ratio in reached[1:]:
        beyond = (ratio**dims - 1.0) * OUTER**dims
        growth = beyond - shells.outer_growth(dims, edges, 0.0, rows)
        found.append(shells.loaded(dims, edges, growth, *constants, STEP / RATE, rows, after))
        rows, after = after, rows
    return np.interp(ratios, reached, found)


def checks(folder: Path, overrides=(), reporter=None) -> list[dict]:
    """Johnson & Cook's ring and the perfectly plastic one."""
    rows, plain = runs.table("ring"), gel.Shell(hardening=0.0, rate_factor=0.0)
    compared = []
    for name, column, shell in (
        ("Johnson-Cook", "johnson_cook_Pa", gel.Shell()),
        ("plastic", "perfectly_plastic_Pa", plain),
    ):
        known = rows[np.isfinite(rows[column])]
        values = pressures(shell, known["diameter_ratio"])
        compared += [
            check(f"{name} ring at D/D_0 = {row['diameter_ratio']:g} [Pa]", value, row[column], BAR, True)
            for row, value in zip(known, values)
        ]
    return compared
