"""`sdph explain CASE --ranks N`: how particles would be shared among processes at the start, and what that costs."""

from __future__ import annotations

import numpy as np

from sdph import effects
from sdph.engine import cuts
from sdph.engine import state as particles
from sdph.engine.domain import OF_WALL
from sdph.engine.neighbours import reach_of
from sdph.engine.state import WALL
from sdph.engine.world import ALONE
from sdph.laws.kernels import SUPPORT
from sdph.methods.grains import start
from sdph.methods.liquids.method import reach
from sdph.methods.liquids.start import parts_of
from sdph.methods.mps import start as pools
from sdph.running import ranks
from sdph.study.explain import estimate, mps, prices

# work of a copy over that of a particle, and time [s] of a step for messages: both from two runs on two ranks of one
# machine (benchmarks/README.md)
COPY, TALK = 2.1, 0.5e-3


def _copies(places, owner, number: int, far: float, period) -> np.ndarray:
    """Copies that each rank has, of what is nearer than `far` [m], by the owner (N,) of the places (N, d) [m]."""
    found = np.zeros(number)
    for rank in range(number):
        box = places[owner == rank]
        ends = box.min(axis=0, initial=np.inf), box.max(axis=0, initial=-np.inf)
        found[rank] = (cuts.near(places, *ends, far, period) & (owner != rank)).sum()
    return found


def _of(case) -> tuple:
    """State at the start, distance [m] within which copies are made, period (d,) [m], us of a particle's step."""
    speed, skin = prices.speed(), case.resolution.neighbour_skin
    if case.incompressible:
        far = reach_of(case.method.sees(case) * case.resolution.spacing, skin)
        return pools.fill(case), far, case.liquid_period, mps.ROWS * speed.liquid
    if case.liquid:
        return parts_of(case)[1], reach_of(reach(case), skin), case.liquid_period, speed.liquid
    far = reach_of(SUPPORT * case.smoothing_length, skin) * (1.0 + ("walls" in case.effects))
    moving = speed.moving if effects.moving(case) else speed.resting
    return start.fill(case, effects.arrays(case), []), far, case.domain.period, moving


def rows(case, number: int) -> list[dict]:
    """Rows of a table; `CaseError` where these processes cannot share the case."""
    ranks.refuse(case, number)
    state, far, period, each = _of(case)
    places, solid = np.stack(particles.axes(state), axis=1), state.kind == WALL
    owner = cuts.owner(cuts.cut(ALONE, places, np.where(solid, OF_WALL, 1.0), range(number)), places)
    own, copies = np.bincount(owner, minlength=number), _copies(places, owner, number, far, period)
    wet = np.bincount(owner, ~solid, minlength=number)
    if not wet.any():  # all come in through nozzles later
        return [
            {"what": "ranks", "value": number, "unit": ""},
            {"what": "particles at the start", "value": 0, "unit": ""},
        ]
    uneven, halo = wet.max() * number / wet.sum(), copies.sum() / own.sum()
    step = 1e-6 * each * len(places)  # of one process [s]
    efficiency = 1.0 / (uneven * (1.0 + COPY * halo) + TALK * number / step)
    largest = own.max() + copies.max()
    found = [
        {"what": "ranks", "value": number, "unit": ""},
        {"what": "particles of a rank, walls included, at most", "value": int(own.max()), "unit": ""},
        {"what": "copies of others', over own particles", "value": halo, "unit": ""},
        {"what": "fullest rank over the mean, walls left out", "value": uneven, "unit": ""},
        {"what": "memory of a rank", "value": estimate.memory(case, largest, 0) / 1e6, "unit": "MB"},
    ]
    if not case.incompressible:  # what messages of an equation for the pressure cost was not measured
        found.append({"what": "expected efficiency, one thread a rank", "value": efficiency, "unit": ""})
    return found
