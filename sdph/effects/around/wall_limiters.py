"""Counts of what the limiters of walls for grains hold: pressure that would pull, grains nearer than contact."""

from __future__ import annotations

import numpy as np

from sdph.effects import limiter
from sdph.engine.rows import entry
from sdph.engine.walls.dummies import offset
from sdph.laws.compiled import serial


@serial
def nearer(p, wall, box, s, found):
    """Mark (N,) the particles that are nearer than contact to a wall that grips; see `grip` of the walls."""
    for i in range(len(found)):
        found[i] = False
        for k in range(wall.number[i]):
            w = entry(wall, i, k)
            dx, dy, dz = offset(box, wall, w, s, i)
            y = dx * wall.normal_x[w] + dy * wall.normal_y[w] + dz * wall.normal_z[w] - wall.depth[w]
            found[i] |= wall.stick[w] > 0.0 and y < p.contact


def held(p, method) -> dict[str, float]:
    """Share of the dummies with grains in front whose pressure is held, and the largest suction [Pa] that is taken
    away; with a specularity the share of the grains whose distance is held, and of those past the cap of g0."""
    if p.paper == 1:
        return {}
    told = ~np.isnan(method.unheld)
    pressure = method.unheld[told]
    found = {
        "walls_held_share": float((pressure != method.wall.pressure[told]).mean()) if len(pressure) else 0.0,
        "wall_suction_Pa": float((-pressure).max(initial=0.0)),
    }
    if p.specularity < 0.0:
        return found
    near = np.zeros(len(method.state.x), bool)
    nearer(p, method.wall, method.neighbours.box, method.state, near)
    return found | {"grip_held_share": limiter.share(method.state, near)} | limiter.capped(p, method.state)
