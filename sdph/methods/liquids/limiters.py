"""Limiters of a liquid: what they hold now, by column of history.csv (docs/limiters.md)."""

from __future__ import annotations

import math

import numpy as np
from numba import prange

from sdph.effects.liquids import liquid_damping, shifting
from sdph.engine import arrays, softening
from sdph.engine.geometry import apart
from sdph.engine.rows import entry
from sdph.engine.state import GAS
from sdph.laws.compiled import parallel
from sdph.methods.liquids import sparse


@parallel
def in_front(s, rows, box, walls, near, support, volume, pressure, wets, holds, bare):
    """Mark the wall particles (W,) that have liquid within the kernel's `support` [m], those that hold some off,
    nearer than 1/near [m], and those without pressure."""
    for n in prange(len(walls)):
        i = walls[n]
        wets[n] = holds[n] = False
        bare[n] = pressure[i] == 0.0
        for k in range(rows.number[i]):
            j = entry(rows, i, k)
            dx, dy, dz = apart(s, box, i, j)
            r, wet = math.sqrt(dx * dx + dy * dy + dz * dz), volume[j] > 0.0
            wets[n] |= wet and r < support
            holds[n] |= wet and r * near < 1.0


def held(stepper) -> dict[str, float]:
    """Shares of the particles of liquid, or of the wall particles that have liquid in front, that are held now."""
    by_motion = _by_shifting(stepper) | _by_correction(stepper)
    return _by_walls(stepper) | by_motion | sparse.held(stepper) | _by_damping(stepper)


@parallel
def shifted(p, s, active, shift, pressure):
    """Numbers of particles that are shifted, that go no faster than they may, whose tension is controlled, and that lie
    at a surface."""
    moved = slowed = pulled = outer = 0.0
    for n in prange(len(active)):
        i = active[n]
        if p.liquid > 0.0 or s.kind[i] == GAS:
            moved += 1.0
            size = math.sqrt(shift[i, 0] ** 2 + shift[i, 1] ** 2 + shift[i, 2] ** 2)
            slowed += 1.0 if p.strength * size > p.largest else 0.0
        inside = s.enclosure[i] > shifting.INTERIOR
        pulled += 1.0 if pressure[i] < 0.0 and inside else 0.0
        outer += 0.0 if inside else 1.0
    return moved, slowed, pulled, outer


@parallel
def uncorrected(active, excess):
    """Number of particles whose gradient is left as it is: all of `excess` (6 of N) is 0."""
    found = 0.0
    for n in prange(len(active)):
        i = active[n]
        own = abs(excess[0][i]) + abs(excess[1][i]) + abs(excess[2][i])
        found += 1.0 if own + abs(excess[3][i]) + abs(excess[4][i]) + abs(excess[5][i]) == 0.0 else 0.0
    return found


def _by_walls(stepper) -> dict[str, float]:
    if not (stepper.p["tank"] or stepper.bodies):
        return {}
    masks = [arrays.empty(len(stepper.walls), stepper.walls, np.bool_) for _ in range(3)]
    in_front(
        stepper.state, stepper.rows, stepper.neighbours.box, stepper.walls, stepper.wall.near, 2.0 * stepper.kernel.h,
        stepper.volume, stepper.pressure, *masks,
    )  # fmt: skip
    wets, holds, bare = map(arrays.brought, masks)
    found = {"wall_holds_off_share": stepper.world.mean(holds[wets])}
    if stepper.wall.least == 0.0:
        found["walls_held_share"] = stepper.world.mean(bare[wets])
    return found


def _by_shifting(stepper) -> dict[str, float]:
    p, own = stepper.p["shifting"], stepper.active
    if not p:
        return {}
    found = np.array([*shifted(p, stepper.state, own, stepper.shift, stepper.pressure), len(own)])
    moved, slowed, pulled, outer, number = stepper.world.sum(found).tolist()
    shares = {"shift_held_share": slowed / moved if moved else 0.0}
    if p.tension > 0.0:
        shares["tension_controlled_share"] = pulled / number if number else 0.0
    if not stepper.phases:
        shares["shift_at_surface_share"] = outer / number if number else 0.0
    return shares


def _by_correction(stepper) -> dict[str, float]:
    if not stepper.excess:
        return {}
    left, number = stepper.world.sum(np.array([uncorrected(stepper.active, stepper.excess), len(stepper.active)]))
    return {"uncorrected_share": float(left / number) if number else 0.0}


def _by_damping(stepper) -> dict[str, float]:
    p = stepper.p["liquid_damping"]
    if not isinstance(p, liquid_damping.LinearP):
        return {}
    return softening.held(stepper, stepper.case.liquid.kernel, stepper.active, arrays.positive(stepper.volume))
