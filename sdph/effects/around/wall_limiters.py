"""Counts of what the limiters of walls for grains hold: pressure that would pull, grains nearer than contact."""

from __future__ import annotations

import numpy as np
from numba import prange

from sdph.effects import limiter
from sdph.engine import arrays
from sdph.engine.rows import entry
from sdph.engine.walls.dummies import offset
from sdph.laws.compiled import parallel


@parallel
def nearer(p, wall, box, s, found):
    """Mark (N,) the particles that are nearer than contact to a wall that grips; see `grip` of the walls."""
    for i in prange(len(found)):
        found[i] = False
        for k in range(wall.before[i], wall.number[i]):
            w = entry(wall, i, k)
            dx, dy, dz = offset(box, wall, w, s, i)
            y = dx * wall.normal_x[w] + dy * wall.normal_y[w] + dz * wall.normal_z[w] - wall.depth[w]
            found[i] |= wall.stick[w] > 0.0 and y < p.contact


def pressures(method) -> tuple[np.ndarray, np.ndarray]:
    """Pressure (W,) [Pa] of the dummies before it is held, nan without grains near, and after; of several processes
    from one whose own particles see the dummy, which has all that press it."""
    found = method.unheld, method.wall.pressure
    if method.domain.alone:
        return found
    facing, first = method.facing, np.full(len(method.unheld), len(method.state.x), np.int64)
    some = facing.number > 0
    first[some] = facing.entries[facing.start[:-1][some]]  # rows begin with own particles
    mine = (first < len(method.own.x)) & ~np.isnan(method.unheld)
    told = method.world.most(np.where(mine, found, -np.inf))
    return np.where(np.isinf(told[0]), np.nan, told[0]), told[1]


def held(p, method) -> dict[str, float]:
    """Share of the dummies with grains in front whose pressure is held, and the largest suction [Pa] that is taken
    away; with a specularity the share of the grains whose distance is held, and of those past the cap of g0."""
    if p.paper == 1:
        return {}
    unheld, own = pressures(method)
    told = ~np.isnan(unheld)
    pressure = unheld[told]
    found = {
        "walls_held_share": float((pressure != own[told]).mean()) if len(pressure) else 0.0,
        "wall_suction_Pa": float((-pressure).max(initial=0.0)),
    }
    if p.specularity < 0.0:
        return found
    near = arrays.empty(len(method.state.x), method.state.x, np.bool_)
    nearer(p, method.wall, method.neighbours.box, method.state, near)
    return found | {"grip_held_share": limiter.share(method.state, near)} | limiter.capped(p, method.state)
