"""Moving particles at the start of a case, one spacing apart: its pools."""

from __future__ import annotations

import numpy as np

from sdph.effects.around import tank
from sdph.engine import lattice, regions
from sdph.engine import state as particles
from sdph.engine.state import LIQUID
from sdph.laws.liquids import quadrupole, taylor_green
from sdph.methods.mps import tanks
from sdph.schema import CaseError

FLOWS = ("uniform", "rotation", "taylor_green", "quadrupole")


def fill(case) -> particles.State:
    """All particles of the pools, numbered from 0; none where nozzles alone give liquid."""
    refuse(case)
    names = tanks.arrays(case)
    state = particles.empty(0, names, case.dimensions)
    for number, (name, pool) in enumerate(case.pools.items()):
        earlier = list(case.pools.values())[:number]
        state = particles.join(state, _pool(case, name, pool, earlier, names))
    tanks.check(case)
    if "tank" in case.effects:
        state = particles.join(state, tanks.stand(case))
    state.ident[:] = np.arange(len(state.x))
    return state


def refuse(case) -> None:
    """CaseError where there is no liquid, or a pool is none that moving particles can be."""
    if not case.pools and not case.nozzles:
        raise CaseError("no liquid: give it in a section such as [pools.drop], or let it in by [nozzles.mouth]")
    for name, pool in case.pools.items():
        if pool.shape in ("tank", "ring") or pool.flow not in FLOWS or pool.phase != "liquid":
            given = f"pools.{name} has shape = {pool.shape!r}, flow = {pool.flow!r}, phase = {pool.phase!r}"
            raise CaseError(
                f"{given}; mps takes a box, disc or sphere of one liquid, with a flow of {', '.join(FLOWS)}"
            )


def _pool(case, name: str, pool, earlier: list, names) -> particles.State:
    """The particles of a pool, less those that lie in the pools before it."""
    d, spacing = case.dimensions, case.resolution.spacing
    points = lattice.lattice(pool, spacing, d)
    for other in earlier:
        points = points[~regions.holds(other, points)]
    if not len(points):
        raise CaseError(f"pools.{name} holds no particle; enlarge it, or put it before the pools that take its place")
    tank.refuse_outside(case, name, points)
    state = particles.empty(len(points), names, d)
    for axis, column in zip(particles.axes(state), points.T):
        axis[:] = column
    for array, value in zip((state.u, state.v, state.w), _velocity(pool, points).T):
        array[:] = value
    state.kind[:], state.density[:] = LIQUID, case.liquid.density
    state.mass[:] = case.liquid.density * spacing**d
    return state


def _velocity(pool, points) -> np.ndarray:
    """(N, d) velocities [m/s]."""
    velocity = np.zeros_like(points)
    if pool.velocity is not None:
        velocity += np.array(pool.velocity)
    if pool.flow == "rotation":
        lower, upper = np.array(pool.lower), np.array(pool.upper)
        from_middle = (points - 0.5 * (lower + upper)) * 2.0 * pool.speed / (upper[0] - lower[0])
        velocity[:, 0] += from_middle[:, 1]
        velocity[:, 1] -= from_middle[:, 0]
    if pool.flow == "taylor_green":
        velocity += taylor_green(points, pool.upper[0] - pool.lower[0], pool.speed, 1.0)[0]
    if pool.flow == "quadrupole":
        velocity += quadrupole(points - np.array(pool.centre), pool.radius, pool.speed)
    return velocity
