"""A hole in a film at rest, periodic on two axes: its rim goes at the speed of Taylor and Culick, or does not.

Once as the effect `perforation` opens and carries it, once cut out and left to the tension of pairs. The rim is where
the nearest particle is, the median over SECTORS about the middle.
"""

from __future__ import annotations

import itertools
import math
from pathlib import Path

import numpy as np

from sdph.engine import state as particles
from sdph.laws.sheets import taylor_culick
from sdph.methods.mps.holes import drawn
from sdph.study.compare import check

from . import free

LAYERS, WIDE, REACH = 2, 40, 3.1  # l0
FROM, TO, SECTORS = 4.0, 12.0, 12  # l0: radii between which the speed is told; our choice
LEAST, MOST = 0.8, 1.05  # issue 21


def checks(folder: Path, *_, layers: int = LAYERS, wide: int = WIDE, to: float = TO) -> list[dict]:
    carried, stepper, u = opened(layers, wide, to)
    left = cut(layers, wide)
    area = math.pi * (stepper.holes.opened.radius[0] + u * stepper.time) ** 2
    work = float(stepper.works[-1])
    name = f"hole in a film of {layers} layers"
    return [
        check(f"{name}: speed of the rim over Culick's", carried, 0.5 * (LEAST + MOST), 0.5 * (MOST - LEAST)),
        check(f"{name}, left to tension: speed of the rim over Culick's, reported", left, 1.0, math.inf),
        check(f"{name}: work on the rim over the tension of the surface that went, reported",
              work / (2.0 * free.SIGMA * area), 0.5, math.inf),
    ]  # fmt: skip


def film(layers: int, wide: int, effects=(), sections=None):
    """A stepper of a film across the middle of a box."""
    unit = free.SPACING
    size = [wide * unit, wide * unit, (layers + 20) * unit]
    pool = {"shape": "box", "lower_m": [0.0, 0.0, 10.0 * unit], "upper_m": [*size[:2], (layers + 10) * unit]}
    return free.body(pool, size, REACH, periodic=(True, True, False), effects=effects, sections=sections)


def rim(stepper, middle) -> float:
    """Distance [m] of the nearest particle from a middle (3,), the median over sectors."""
    off = particles.positions(stepper.state)[:, :2] - middle[:2]
    box = np.array(stepper.case.domain.size[:2])
    off -= box * np.round(off / box)
    sector = (SECTORS * (np.arctan2(off[:, 1], off[:, 0]) / math.tau + 0.5)).astype(int) % SECTORS
    return float(np.median([np.hypot(*off[sector == k].T).min() for k in range(SECTORS)]))


def opened(layers: int, wide: int, to: float):
    """Speed of a rim over Taylor and Culick's, as the effect opens the one hole of a film; stepper; that speed."""
    unit = free.SPACING
    thick = (layers + 0.5) * unit
    own = {"thickness_um": 1e6 * thick, "spacing_mm": 1e3 * wide * unit}
    ident, share = np.arange(layers * wide**2), unit**3 / (thick * (wide * unit) ** 2)
    seed = next(n for n in itertools.count() if (drawn(ident, n) < share).sum() == 1)
    stepper = film(layers, wide, ("perforation",), {"perforation": own | {"seed": seed}})
    u = taylor_culick(free.SIGMA, free.DENSITY, layers * unit)

    def see(stepper):
        return (rim(stepper, stepper.holes.opened.middle[0]) if len(stepper.holes.opened.site) else 0.0,)

    time, radius = free.go(stepper, to * unit / u, see).T
    on = (radius > FROM * unit) & (radius < to * unit)
    return float(np.polyfit(time[on], radius[on], 1)[0]) / u, stepper, u


def cut(layers: int, wide: int) -> float:
    """The same of a hole of FROM spacings that was cut out, over the time in which it would grow by as much again."""
    unit = free.SPACING
    stepper, middle = film(layers, wide), 0.5 * wide * unit * np.ones(3)
    s, u = stepper.state, taylor_culick(free.SIGMA, free.DENSITY, layers * unit)
    stepper.take((s.x - middle[0]) ** 2 + (s.y - middle[1]) ** 2 > (FROM * unit) ** 2)
    stepper._rebuild()
    time, radius = free.go(stepper, FROM * unit / u, lambda stepper: (rim(stepper, middle),)).T
    return float(np.polyfit(time, radius, 1)[0]) / u
