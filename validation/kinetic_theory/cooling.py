"""Haff's law: grains at rest lose their agitation by collisions, d theta/dt = -K theta^1.5, until 1/16 of it is left.

From the lattice that a case starts from, and from one whose particles lie up to a tenth of a spacing off, so that the
pressure of agitation drives them about as they cool.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from sdph.laws import granular
from sdph.study.compare import check

from . import boxes

ALPHA_P, THETA, SIDE = 0.45, 1e-2, 0.03  # -, m2/s2, m
LEFT = 1.0 / 16.0  # of theta: four half-lives of sqrt(theta); our choice
BAR = 0.01  # issue 18
WINDOWS = 60
OFF = {"lattice": 0.0, "disordered": 0.1}  # spacings


def checks(folder: Path, *_, spacings=boxes.SPACINGS[:1]) -> list[dict]:
    return [
        check(f"Haff, {start}, {1e3 * dx:g} mm: theta over the law's [-]", cooled(off, dx), 1.0, BAR)
        for dx in spacings
        for start, off in OFF.items()
    ]


def cooled(off: float, spacing: float) -> float:
    """Mean theta over Haff's once 1/16 should be left; particles `off` spacings from their lattice at the start.

    K is the mean over the particles' own alpha_p and over time.
    """
    run = boxes.Alone(boxes.case((SIDE, SIDE), ALPHA_P, spacing, THETA, domain={"periodic": ["x", "y"]}))
    s, rng = run.state, np.random.default_rng(1)
    run.begin_with(**{a: getattr(s, a) + off * spacing * rng.uniform(-1.0, 1.0, len(s.x)) for a in "xy"})
    end = 2.0 * (LEFT**-0.5 - 1.0) / (coefficient(run.state) * THETA**0.5)
    passed = 0.0
    for _ in range(WINDOWS):
        before = coefficient(run.state)
        run.window(end / WINDOWS)
        passed += 0.5 * (before + coefficient(run.state)) * end / WINDOWS
    law = (THETA**-0.5 + 0.5 * passed) ** -2
    return float(np.average(run.state.theta, weights=run.state.mass)) / law


def coefficient(state) -> float:
    """K [1/m], the mean of the particles."""
    each = [
        granular.cooling_coefficient(a, boxes.RESTITUTION, boxes.g0(a), boxes.DIAMETER) for a in boxes.alpha_p(state)
    ]
    return float(np.average(each, weights=state.mass))
