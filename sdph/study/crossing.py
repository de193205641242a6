"""Foresight of how fast gas goes through a mesh of its own, and how often it crosses its cells: its flow without eddies
through the bed."""

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


def among_grains(case, mesh: PolyMesh, held: np.ndarray, through=None) -> float:
    """Courant number [1/s] of a second, the largest of the cells `held` (C,) where grains are, once bubbles rise there;
    0 of a mesh that no gas is blown through. `through` is the `flow`, where it is known."""
    own = rates(case, mesh, through)[held]
    return THROUGH[case.dimensions] / (1.0 - packed(case)) * float(own.max(initial=0.0))


def rates(case, mesh: PolyMesh, through=None) -> np.ndarray:
    """(C,) [1/s] half of what goes through the faces of each cell in a second over its volume, of the `flow`, which is
    `through` where it is known."""
    cells, inner = len(mesh.volumes), len(mesh.neighbour)
    size = np.abs(flow(case, mesh) if through is None else through)
    return 0.5 * (_sums(mesh.owner, size, cells) + _sums(mesh.neighbour, size[:inner], cells)) / mesh.volumes


def fastest(mesh: PolyMesh, through: np.ndarray) -> float:
    """Largest speed [m/s] of a flow `through` (F,) the faces of a mesh: of the mean of each cell, the sum over its
    faces of what leaves it times the way to the face, over its volume (Gauss)."""
    cells, inner, middles = len(mesh.volumes), len(mesh.neighbour), cell_sizes.middles(mesh)
    leaves = through[:, None] * (mesh.centres - middles[mesh.owner])
    enters = through[:inner, None] * (middles[mesh.neighbour] - mesh.centres[:inner])
    pairs = zip(leaves.T, enters.T)
    mean = np.array([_sums(mesh.owner, out, cells) + _sums(mesh.neighbour, into, cells) for out, into in pairs])
    return float((np.linalg.norm(mean, axis=0) / mesh.volumes).max())


def flow(case, mesh: PolyMesh) -> np.ndarray:
    """(F,) [m3/s] out of the owner of each face, of gas that alone and without eddies goes from inlets, at their
    strongest, to outlets; zeros without both."""
    cells, inner = len(mesh.volumes), len(mesh.neighbour)
    inward, open_to = _openings(case, mesh)
    if not (open_to.any() and inward.any()):
        return np.zeros(len(mesh.owner))
    conductance = _conductance(mesh, open_to)
    between, (own, other) = conductance[:inner], (mesh.owner[:inner], mesh.neighbour)
    diagonal = _sums(mesh.owner, conductance, cells) + _sums(other, between, cells)
    off = scipy.sparse.coo_array((-between, (own, other)), shape=(cells, cells))
    matrix = (scipy.sparse.diags_array(diagonal) + off + off.T).tocsr()
    given = _sums(mesh.owner, inward, cells)
    potential, _ = cg(matrix, given, rtol=CLOSE, M=scipy.sparse.diags_array(1.0 / diagonal))
    through = conductance * potential[mesh.owner] - inward
    through[:inner] = between * (potential[own] - potential[other])
    return through


def _openings(case, mesh: PolyMesh) -> tuple[np.ndarray, np.ndarray]:
    """Flow that comes in through each face (F,) [m3/s] by a given velocity, and True (F,) where it is an outlet."""
    inward, open_to = np.zeros(len(mesh.owner)), np.zeros(len(mesh.owner), bool)
    for name, boundary in case.boundaries.items():
        if name in mesh.patches:
            own = mesh.patches[name].faces
            open_to[own] = boundary.kind == "pressure_outlet"
            inward[own] = -(mesh.areas[own] @ _vector(boundary.strongest)) if boundary.lets_in else 0.0
    return inward, open_to


def _conductance(mesh: PolyMesh, open_to: np.ndarray) -> np.ndarray:
    """(F,) [m] area over distance of the cells beside each inner face and each that is `open_to` the outside, else
    0."""
    inner, middles, conducts = len(mesh.neighbour), cell_sizes.middles(mesh), open_to.copy()
    conducts[:inner] = True
    beyond = mesh.centres.copy()
    beyond[:inner] = middles[mesh.neighbour]
    across = np.abs((mesh.areas * (beyond - middles[mesh.owner])).sum(axis=1))
    conductance = np.zeros(len(across))
    np.divide((mesh.areas**2).sum(axis=1), across, out=conductance, where=conducts & (across > 0.0))
    return conductance


def _sums(places: np.ndarray, values: np.ndarray, cells: int) -> np.ndarray:
    """(C,) sums of `values` by the cells that are their `places`."""
    return np.bincount(places, values, cells)


def _vector(velocity) -> np.ndarray:
    """(3,) of a velocity in two or three dimensions."""
    return np.pad(np.asarray(velocity, float), (0, 3 - len(velocity)))
