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
from sdph.methods.liquids import aboard, sparse


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
    with aboard.ashore(stepper):
        by_shifting, by_correction = _by_shifting(stepper), _by_correction(stepper)
    return _by_walls(stepper) | by_shifting | by_correction | sparse.held(stepper) | _by_damping(stepper)


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
    p, own, mean = stepper.p["shifting"], stepper.active, stepper.world.mean
    if not p:
        return {}
    moved = own if p.liquid > 0.0 else own[stepper.state.kind[own] == GAS]
    speed, least = p.strength * np.sqrt((stepper.shift[moved] ** 2).sum(axis=1)), stepper.state.enclosure[own]
    found = {"shift_held_share": mean(speed > p.largest)}
    if p.tension > 0.0:
        found["tension_controlled_share"] = mean((stepper.pressure[own] < 0.0) & (least > shifting.INTERIOR))
    if not stepper.phases:
        found["shift_at_surface_share"] = mean(least <= shifting.INTERIOR)
    return found


def _by_correction(stepper) -> dict[str, float]:
    if not stepper.excess:
        return {}
    left = ~np.any([part[stepper.active] != 0.0 for part in stepper.excess], axis=0)
    return {"uncorrected_share": stepper.world.mean(left)}


def _by_damping(stepper) -> dict[str, float]:
    p = stepper.p["liquid_damping"]
    if not isinstance(p, liquid_damping.LinearP):
        return {}
    return softening.held(stepper, stepper.case.liquid.kernel, stepper.active, arrays.positive(stepper.volume))
