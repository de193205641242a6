"""Walls of a tank for moving particles: where their particles stand, and how they stop what comes towards them.

A wall is a boundary condition of the pressure and no unknown: from a particle i to a particle j of the wall it rises by
(rho/dt) u*.P r_ij, which is what stops u* into the wall. P projects on the normal of the wall there. Water at rest on a
lattice then has the gradient rho g.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from sdph import effects
from sdph.effects.around import tank
from sdph.engine import state as particles
from sdph.engine.state import WALL
from sdph.engine.walls import layers, shapes
from sdph.laws.compiled import inlined
from sdph.schema import CaseError

NUDGE = 1e-3  # of a spacing: of the differences that the normal is made of; our choice
# length of a normal by such differences below which two faces lie back to back there, each as near: 1 before one face,
# 0.7 behind an edge of 90 degrees, 0.5 where two faces look away from each other by 120; our choice
BACK_TO_BACK = 0.5


class WallsP(NamedTuple):
    """block (W, 3, 3): P of each wall particle, by its number less `first`; least pressure of a wall [Pa]; 1 where
    liquid sticks to it."""

    block: np.ndarray
    first: int
    least: float
    stick: float


@inlined
def solid(walls, s, j):
    """True of a particle of a wall."""
    if len(walls) == 0:
        return False
    return s.kind[j] == WALL


@inlined
def across(walls, s, j, dx, dy, dz):
    """P r_ij of a wall particle j (3 components) [m]."""
    if len(walls) == 0:
        return 0.0, 0.0, 0.0
    b, k = walls.block, s.ident[j] - walls.first
    return (
        b[k, 0, 0] * dx + b[k, 0, 1] * dy + b[k, 0, 2] * dz,
        b[k, 1, 0] * dx + b[k, 1, 1] * dy + b[k, 1, 2] * dz,
        b[k, 2, 0] * dx + b[k, 2, 1] * dy + b[k, 2, 2] * dz,
    )


@inlined
def rise(s, scale, i, nx, ny, nz):
    """Pressure of a wall particle over that of i [Pa], scale u*.P r_ij; scale: rho/dt."""
    return scale * (s.u[i] * nx + s.v[i] * ny + (s.w[i] * nz if len(s.w) else 0.0))


@inlined
def least(walls, pressure):
    """Pressure of a wall [Pa], which does not pull unless it may."""
    if len(walls) == 0:
        return pressure
    return max(pressure, walls.least)


@inlined
def grip(walls):
    """Velocity of a particle less that of the wall, times this, is what friction takes to be between them: a wall that
    liquid sticks to has its velocity with the sign turned."""
    if len(walls) == 0:
        return 0.0
    return 2.0 * walls.stick


def arrays(case) -> set[str]:
    """Arrays of the state that the method and the effects of a case need."""
    return effects.arrays(case) | {"pressure"}


def stand(case) -> particles.State:
    """Wall particles of the tank."""
    parts = _points(case)
    points = parts[0]
    state = particles.empty(len(points), arrays(case), case.dimensions)
    for axis, column in zip(particles.axes(state), points.T):
        axis[:] = column
    state.kind[:], state.density[:] = WALL, case.liquid.density
    state.mass[:] = case.liquid.density * layers.volumes(tank.shape_of(case), parts, case.resolution.spacing)
    return state


def _points(case) -> tuple[np.ndarray, np.ndarray]:
    """Places of the wall particles as `layers.wall_points` has them; there is no outlet (`check`)."""
    return layers.wall_points(tank.shape_of(case), case.resolution.spacing, math.ceil(case.method.reach))


def walls_of(case, state):
    """WallsP of a case whose walls stand last in its state, in the order of `stand`; () without a tank."""
    if "tank" not in case.effects:
        return ()
    own, places = case.parameters["tank"], _points(case)[0]
    least_pressure = -math.inf if own.suction == "full" else 0.0
    return WallsP(blocks(case, places), len(state.x) - len(places), least_pressure, float(own.slip == "no_slip"))


def blocks(case, places) -> np.ndarray:
    """(W, 3, 3) P: n n^T of the normal n, of either face amid a plate, as both have the same; 0 in the edges of a box.

    Along a wall pressures above and below i cancel; in an edge the one of them that is left would be too much.
    """
    shape, d, found = tank.shape_of(case), case.dimensions, np.zeros((len(places), 3, 3))
    if isinstance(shape, shapes.Box):
        behind = (places < shape.lower) | (places > shape.upper)
        found[:, range(d), range(d)] = behind & (behind.sum(axis=1) == 1)[:, None]
        return found
    normal = normals(shape, places, NUDGE * case.resolution.spacing)
    found[:, :d, :d] = normal[:, :, None] * normal[:, None, :]
    return found


def normals(shape, places, step: float) -> np.ndarray:
    """(W, d) of length 1, at right angles to the nearest face of a shape, by differences over `step` [m].

    Amid a plate, as far from one face as from the other, differences cancel: there the normal is that of a place two
    steps aside, along the axis that leads best to one of the faces.
    """
    slopes = _slopes(shape, places, step)
    amid = np.linalg.norm(slopes, axis=1) < BACK_TO_BACK
    if amid.any():
        beside = np.stack([_slopes(shape, places[amid] + 2.0 * step * e, step) for e in np.eye(places.shape[1])])
        best = np.linalg.norm(beside, axis=2).argmax(axis=0)
        slopes[amid] = beside[best, np.arange(len(best))]
    return slopes / np.linalg.norm(slopes, axis=1, keepdims=True)


def _slopes(shape, places, step: float) -> np.ndarray:
    """(W, d) slopes of the distance from a shape, by differences over two steps [m]."""
    ends = [(shape.distance(places + step * e), shape.distance(places - step * e)) for e in np.eye(places.shape[1])]
    return np.stack([upper - lower for upper, lower in ends], axis=1) / (2.0 * step)


def check(case) -> None:
    """Refuse what the walls of moving particles cannot be."""
    if "tank" not in case.effects:
        return
    if case.nozzles or "outflow" in case.effects:
        raise CaseError('method.name = "mps" takes a tank or nozzles and open sides, not both: leave one of them out')
    if not case.method.of_pools(case):
        why = "free_energy_tension" if case.method.gradient is None else 'method.gradient = "pairs"'
        raise CaseError(
            f"{why} lets the pressure act by forces of pairs, and by these a wall of a tank pushes with half: give "
            'method.gradient = "corrected", by which liquid wets all walls, or leave the tension or the tank out'
        )
    if case.parameters["tank"].outlet_radius:
        raise CaseError('tank.outlet_radius_m is given; with method.name = "mps" a tank has no outlet: leave it out')
