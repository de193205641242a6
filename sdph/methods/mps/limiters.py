"""Limiters of moving particles: what they hold now, by column of history.csv (docs/limiters.md)."""

from __future__ import annotations

import math

import numpy as np
from numba import prange

from sdph.engine.geometry import apart
from sdph.engine.rows import entry
from sdph.engine.state import LIQUID
from sdph.laws import moving_particles
from sdph.laws.compiled import parallel
from sdph.methods.mps import alone


@parallel
def crowded(cloud, walls, s, rows, box):
    """Number of particles of liquid that have a neighbour nearer than CLOSE l0."""
    found, close = 0.0, moving_particles.CLOSE * cloud.spacing
    for i in prange(len(s.x)):
        near = False
        for k in range(rows.number[i]):
            dx, dy, dz = apart(s, box, entry(rows, i, k), i)
            near |= math.sqrt(dx * dx + dy * dy + dz * dz) < close
        found += 1.0 if near and s.kind[i] == LIQUID else 0.0
    return found


def held(stepper) -> dict[str, float]:
    """Share of the particles whose pressure would be below 0, where none is, and of those too close for their weight;
    besides what is held in a pool and at its walls."""
    seen = alone.shares(stepper.domain.own(stepper.state), stepper.freed)  # copies are never freed, and have no rows
    counts = np.array([*seen, crowded(*stepper.within), *stepper.at_walls])
    many, bare, freed, close, *at_walls = map(float, stepper.world.sum(counts))
    share = 1.0 / many if many else 0.0
    found = {"pressure_at_least_share": bare * share if stepper.own.holds(stepper.case) else 0.0}
    pool = {"surface_freed_share": freed * share, "kept_apart_rel": stepper.moved} if stepper.pool else {}
    return found | {"close_share": close * share} | pool | _by_walls(stepper.walls, *at_walls)


def _by_walls(walls, pairs, spared) -> dict[str, float]:
    """Share of the pairs of liquid and wall whose wall would pull and may not."""
    may_not = walls and walls.least == 0.0
    return {"walls_held_share": spared / pairs if pairs else 0.0} if may_not else {}
