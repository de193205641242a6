"""Foresight of how often gas crosses the cells of a mesh of its own: its flow without eddies through the bed."""

from __future__ import annotations

import numpy as np
import scipy.sparse
from scipy.sparse.linalg import cg

from coupling.openfoam import cell_sizes
from coupling.openfoam.poly_mesh import PolyMesh
from sdph.exchange.window import packed

# Gas goes through a bubble so many times as fast as among the grains far from it: Davidson & Harrison, Fluidised
# Particles (1963), of a round void by the number of dimensions
THROUGH = {2: 2.0, 3: 3.0}
CLOSE = 1e-3  # residual of the potential, relative: our choice, far within what an estimate is


def among_grains(case, mesh: PolyMesh, held: np.ndarray) -> float:
    """Courant number [1/s] of a second, the largest of the cells `held` (C,) where grains are, once bubbles rise there;
    0 of a mesh that no gas is blown through."""
    own = rates(case, mesh)[held]
    return THROUGH[case.dimensions] / (1.0 - packed(case)) * float(own.max(initial=0.0))


def rates(case, mesh: PolyMesh) -> np.ndarray:
    """(C,) [1/s] half of what goes through the faces of each cell in a second over its volume, of gas that alone and
    without eddies goes from inlets, at their strongest, to outlets; zeros without both."""
    volumes, inner, inward = mesh.volumes, len(mesh.neighbour), np.zeros(len(mesh.owner))
    cells = len(volumes)
    open_to = np.zeros(len(mesh.owner), bool)
    for name, boundary in case.boundaries.items():
        if name in mesh.patches:
            own = mesh.patches[name].faces
            open_to[own] = boundary.kind == "pressure_outlet"
            inward[own] = -(mesh.areas[own] @ _vector(boundary.strongest)) if boundary.lets_in else 0.0
    if not (open_to.any() and inward.any()):
        return np.zeros(cells)
    middles, conducts = cell_sizes.middles(mesh), open_to.copy()
    conducts[:inner] = True
    beyond = mesh.centres.copy()
    beyond[:inner] = middles[mesh.neighbour]
    across = np.abs((mesh.areas * (beyond - middles[mesh.owner])).sum(axis=1))
    conductance = np.zeros(len(across))
    np.divide((mesh.areas**2).sum(axis=1), across, out=conductance, where=conducts & (across > 0.0))
    between, (own, other) = conductance[:inner], (mesh.owner[:inner], mesh.neighbour)
    diagonal = np.bincount(mesh.owner, conductance, cells) + np.bincount(other, between, cells)
    off = scipy.sparse.coo_array((-between, (own, other)), shape=(cells, cells))
    matrix = (scipy.sparse.diags_array(diagonal) + off + off.T).tocsr()
    given = np.bincount(mesh.owner, inward, cells)
    potential, _ = cg(matrix, given, rtol=CLOSE, M=scipy.sparse.diags_array(1.0 / diagonal))
    flow = np.abs(inward) + conductance * np.abs(potential[mesh.owner])
    flow[:inner] = between * np.abs(potential[own] - potential[other])
    return 0.5 * (np.bincount(mesh.owner, flow, cells) + np.bincount(other, flow[:inner], cells)) / volumes


def _vector(velocity) -> np.ndarray:
    """(3,) of a velocity in two or three dimensions."""
    return np.pad(np.asarray(velocity, float), (0, 3 - len(velocity)))
