"""Particles whose neighbours are too few for what the loops make of them, and what is held where an interface meets a
wall; limiters 30, 32 and 51 of docs/limiters.md."""

from __future__ import annotations

import math

import numpy as np
from numba import prange

from sdph.effects.liquids import shear_thinning
from sdph.engine import arrays
from sdph.engine import kernels as smoothing
from sdph.engine.geometry import apart
from sdph.engine.gradients import NO_MATRIX, NO_SUMS, added, in_plane
from sdph.engine.rows import entry, length
from sdph.laws.compiled import fast_parallel, serial
from sdph.laws.matrices import SINGULAR, determinant
from sdph.methods.liquids import phases, wetting
from sdph.methods.liquids.interface import on_interface

UNHELD = 1e-9  # round-off of the factor of `wetting.beyond`, which on a lattice is FURTHEST itself


@fast_parallel
def lonely(kernel, s, rows, box, chosen, weight, image, phases_p, lone):
    """lone (C,): True of the `chosen` (C,) whose gradients are 0, as the determinant of their neighbours is below
    SINGULAR; weight (N,) [m^d] of neighbours, which lie at their `image` (N, 3) [m] from where they are."""
    for n in prange(len(chosen)):
        i, matrix = chosen[n], NO_MATRIX
        for k in range(length(rows, i)):
            j = entry(rows, i, k)
            dx, dy, dz = apart(s, box, i, j)
            share = weight[j] * smoothing.slope(kernel, math.sqrt(dx * dx + dy * dy + dz * dz))
            share *= phases.like(phases_p, s.kind[i], s.kind[j])
            dx, dy, dz = dx - image[j, 0], dy - image[j, 1], dz - image[j, 2]
            matrix, _ = added(matrix, NO_SUMS, share, dx, dy, dz, 0.0, 0.0, 0.0)
        lone[n] = determinant(*in_plane(matrix, len(s.z) == 0)) < SINGULAR


@serial
def facing(s, rows, box, active, support, volume, faces):
    """faces (A,): True of the particles that see one of the other phase within the kernel's `support` [m]."""
    for n in range(len(active)):
        i = active[n]
        faces[n] = False
        for k in range(rows.number[i]):
            j = entry(rows, i, k)
            dx, dy, dz = apart(s, box, i, j)
            near = dx * dx + dy * dy + dz * dz < support * support
            faces[n] |= near and volume[j] > 0.0 and s.kind[i] != s.kind[j]


def held(stepper) -> dict[str, float]:
    """Shares of the particles whose gradients of velocity and pressure are 0; of those at the interface, whose
    curvature is; of those that see the other phase, which have no normal, so that surface tension leaves them out."""
    return _gradients(stepper) | _tension(stepper)


def _lonely(stepper, chosen, weight, image=None, phases_p=()) -> float:
    """Share of the `chosen` particles."""
    lone = arrays.zeros(len(chosen), chosen, np.bool_)
    image = arrays.zeros((len(stepper.state.x), 3), chosen) if image is None else image
    lonely(
        stepper.kernel, stepper.state, stepper.rows, stepper.neighbours.box, chosen, weight, image, phases_p, lone
    )  # fmt: skip
    return stepper.world.mean(arrays.brought(lone))


def _gradients(stepper) -> dict[str, float]:
    found, p, wet = {}, stepper.p, arrays.positive(stepper.volume)
    if p["density_diffusion"] or p["shifting"]:
        found["no_gradient_share"] = _lonely(stepper, stepper.active, wet, phases_p=stepper.phases)
    if p["shear_thinning"]:
        image = np.zeros((len(stepper.state.x), 3))
        around = stepper.kernel, stepper.state, stepper.rows, stepper.neighbours.box
        shear_thinning.images(*around, stepper.walls, stepper.volume, image)
        stepper.domain.refresh(image)
        weight = np.where(stepper.volume > 0.0, stepper.volume, -stepper.wall.stick * stepper.volume)
        found["no_shear_rate_share"] = _lonely(stepper, stepper.active, weight, image)
    return found


def _tension(stepper) -> dict[str, float]:
    if not stepper.p["surface_tension"]:
        return {}
    s, own, has = stepper.state, stepper.active, (stepper.normal != 0.0).any(axis=1)
    faces = np.zeros(len(own), bool)
    facing(s, stepper.rows, stepper.neighbours.box, own, 2.0 * stepper.kernel.h, stepper.volume, faces)
    bent = np.where(has, np.maximum(stepper.volume, 0.0), 0.0)
    return _wetting(stepper) | {
        "no_curvature_share": _lonely(stepper, own[has[own]], bent),
        "no_normal_share": stepper.world.mean(~has[own[faces]]),
    }


@serial
def led_on(s, rows, box, active, support, volume, normal, line):
    """Numbers of the pairs of fluid and wall within the kernel's `support` [m] whose difference of
    normals is led on behind the wall, and of those where the factor is held (`wetting.beyond`)."""
    pairs = bounded = 0.0
    for n in range(len(active)):
        i = active[n]
        for k in range(rows.number[i]):
            j = entry(rows, i, k)
            dx, dy, dz = apart(s, box, i, j)
            near = volume[j] < 0.0 and dx * dx + dy * dy + dz * dz < support * support
            if near and on_interface(normal, i) and on_interface(normal, j):
                change = wetting.beyond(line, i, dx, dy, dz) - wetting.behind(line, i, dx, dy, dz)
                pairs += 1.0
                bounded += 1.0 if abs(change) > UNHELD else 0.0
    return pairs, bounded


def _wetting(stepper) -> dict[str, float]:
    """Shares of the particles that see a wall, whose distance from it is held; of the pairs across a wall's surface,
    whose difference of normals is; of the wall particles in sight of an interface that do not meet it."""
    line, own, around = stepper.line, stepper.active, (stepper.state, stepper.rows, stepper.neighbours.box)
    if not line:
        return {}
    near, meeting = line.facing[own].any(axis=1), line.meeting[stepper.walls]
    found = led_on(*around, own, 2.0 * stepper.kernel.h, stepper.volume, stepper.normal, line)
    pairs, bounded = stepper.world.sum(np.array(found))
    return {
        "wetting_height_held_share": stepper.world.mean(line.height[own[near]] == 0.0),
        "wetting_factor_held_share": float(bounded / pairs) if pairs else 0.0,
        "wetting_unmet_share": stepper.world.mean(meeting[meeting > 0] == wetting.UNMET),
    }
