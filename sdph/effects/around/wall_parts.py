"""Force on each dummy by the grains in front of it, where `run.forces` names walls: the forces of
sdph.effects.around.walls once more, summed by dummy instead of by grain."""

from __future__ import annotations

import numpy as np
from numba import prange

from sdph.effects.around.walls import pair, solid
from sdph.engine.rows import entry
from sdph.engine.state import INFLOW
from sdph.laws.compiled import in_turn, parallel


@in_turn
def tell(felt, p, kernel, box, wall, facing, s, stress, friction_p, dt):
    """Add to felt[0] (W, 6) what pushes each dummy and what rubs it in `dt` [s], [kg m/s]; nothing where felt is
    empty."""
    if len(felt):
        feel(p, kernel, box, wall, facing, s, stress, friction_p, dt, felt[0])


@parallel
def feel(p, kernel, box, wall, facing, s, stress, friction_p, dt, felt):
    """Add to felt (W, 6) [kg m/s]; `facing` are the rows of the dummies. A particle upstream of a nozzle feels no wall
    and presses none; what a copy presses is told where it is no copy."""
    for w in prange(len(wall.x)):
        ax = ay = az = tx = ty = tz = 0.0
        for k in range(facing.number[w]):
            i = entry(facing, w, k)
            if s.kind[i] == INFLOW or (len(s.copy) > 0 and s.copy[i]):
                continue
            rho, theta = solid(p, kernel, s, i), s.theta[i] if len(s.theta) else np.nan
            px, py, pz, fx, fy, fz, _ = pair(p, kernel, box, wall, w, s, i, rho, theta, stress, friction_p)
            ax += s.mass[i] * px
            ay += s.mass[i] * py
            az += s.mass[i] * pz
            tx += s.mass[i] * fx
            ty += s.mass[i] * fy
            tz += s.mass[i] * fz
        felt[w, 0] -= dt * ax
        felt[w, 1] -= dt * ay
        felt[w, 2] -= dt * az
        felt[w, 3] -= dt * tx
        felt[w, 4] -= dt * ty
        felt[w, 5] -= dt * tz
