"""The grains that a case has at the start."""

from __future__ import annotations

import math

import numpy as np

from sdph.engine.lattice import lattice
from sdph.engine.state import State, axes, born, empty, join


def fill(case, names) -> State:
    """The particles that a case has at the start, numbered from 1 as in the paper; mass = alpha_p rho_p dx^d."""
    parts = [_region(case, region, names) for region in case.particles.values()]
    state = parts[0] if parts else empty(0, names, case.dimensions)
    for part in parts[1:]:
        state = join(state, part)
    state.ident[:] = np.arange(1, len(state.ident) + 1)
    return state


def _region(case, region, names) -> State:
    points = lattice(region, case.resolution.spacing, case.dimensions)
    volume = case.resolution.spacing**case.dimensions
    if region.shape == "box":  # the lattice is fitted to the box, so the volumes are
        volume = math.prod(b - a for a, b in zip(region.lower, region.upper)) / len(points)
    state = empty(len(points), names, case.dimensions)
    for axis, column in zip(axes(state), points.T):
        axis[:] = column
    for array, value in zip((state.u, state.v, state.w), region.velocity or ()):
        array[:] = value
    state.density[:] = region.volume_fraction * case.grains.density
    state.mass[:] = state.density * volume
    for name, value in (
        ("temperature", region.temperature),
        ("diameter", case.grains.diameter),
        ("theta", case.grains.granular_temperature),
    ):
        getattr(state, name)[:] = value
    state.diameter_variance[:] = case.grains.diameter_std**2
    return born(state)
