"""A strip of liquid pulls itself together: half of it gains 2 sigma a second of momentum, and its rim goes back at the
speed of Taylor and Culick.

Both are told from 1/2 to 2 times the time h/u in which a rim as thick as the film forms, and the pull at first too, up
to h/(10 u).
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from sdph.laws.sheets import taylor_culick
from sdph.study.compare import check

from . import free

LAYERS, LONG, REACHES = 12, 60, (3.1, 4.1)  # l0, l0, l0
FIRST, BEGIN, END = 0.1, 0.5, 2.0  # h/u; our choice
PULL, LEAST, MOST = 0.05, 0.8, 1.05  # issue 21


def checks(folder: Path, *_, layers: int = LAYERS, long: int = LONG, reaches=REACHES) -> list[dict]:
    found = []
    for reach in reaches:
        first, pull, rim = strip(layers, long, reach)
        name = f"film of {layers} layers, r_t = {reach:g}"
        found.append(check(f"{name}: pull over 2 sigma, at first", first, 1.0, PULL))
        found.append(check(f"{name}: pull over 2 sigma, as it goes", pull, 1.0, PULL))
        found.append(check(f"{name}: speed of the rim over Culick's", rim, 0.5 * (LEAST + MOST), 0.5 * (MOST - LEAST)))
    return found


def strip(layers: int, long: int, reach: float) -> tuple[float, float, float]:
    """Pull on half a strip over 2 sigma, at first and as it goes; speed of its ends over Taylor and Culick's."""
    unit = free.SPACING
    size = np.array([long, layers]) * unit
    speed = taylor_culick(free.SIGMA, free.DENSITY, size[1])
    lower = 10.0 * unit * np.ones(2)
    pool = {"shape": "box", "lower_m": lower.tolist(), "upper_m": (lower + size).tolist()}
    stepper = free.body(pool, size + 20.0 * unit, reach)
    middle = lower[0] + 0.5 * size[0]
    right = set(stepper.state.ident[stepper.state.x > middle].tolist())

    def see(stepper):
        s = stepper.state
        mine = np.array([ident in right for ident in s.ident])
        return -float(s.mass[mine] @ s.u[mine]), float(s.x.max() - s.x.min())

    time, momentum, length = free.go(stepper, END * size[1] / speed, see).T
    on, early = time >= BEGIN * size[1] / speed, time <= FIRST * size[1] / speed
    first, pull = (np.polyfit(time[part], momentum[part], 1)[0] / (2.0 * free.SIGMA) for part in (early, on))
    return first, pull, -0.5 * np.polyfit(time[on], length[on], 1)[0] / speed
