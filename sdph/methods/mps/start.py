"""Moving particles at the start of a case, one spacing apart: its pools."""

from __future__ import annotations

import numpy as np

from sdph import effects
from sdph.engine import lattice
from sdph.engine import state as particles
from sdph.engine.state import LIQUID
from sdph.schema import CaseError


def fill(case) -> particles.State:
    """All particles of the pools, numbered from 0; none where nozzles alone give liquid."""
    names = effects.arrays(case)
    state = particles.empty(0, names, case.dimensions)
    for name, pool in case.pools.items():
        state = particles.join(state, _pool(case, name, pool, names))
    if not len(state.x) and not case.nozzles:
        raise CaseError("no liquid: give it in a section such as [pools.drop], or let it in by [nozzles.mouth]")
    state.ident[:] = np.arange(len(state.x))
    return state


def _pool(case, name: str, pool, names) -> particles.State:
    d, spacing = case.dimensions, case.resolution.spacing
    if pool.shape == "tank" or pool.flow != "uniform" or pool.phase != "liquid":
        given = f"pools.{name} has shape = {pool.shape!r}, flow = {pool.flow!r}, phase = {pool.phase!r}"
        raise CaseError(f"{given}; mps takes a box, disc or sphere of one liquid at one velocity")
    points = lattice.lattice(pool, spacing, d)
    state = particles.empty(len(points), names, d)
    for axis, column in zip(particles.axes(state), points.T):
        axis[:] = column
    for array, value in zip((state.u, state.v, state.w), pool.velocity or ()):
        array[:] = value
    state.kind[:], state.density[:] = LIQUID, case.liquid.density
    state.mass[:] = case.liquid.density * spacing**d
    return state
