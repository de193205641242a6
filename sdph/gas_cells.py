"""Edges of the gas cells of a box, equal or stretched: one grid for every gas solver."""

from __future__ import annotations

import numpy as np

from sdph.case import cells
from sdph.schema import CaseError

SAME = 1e-8  # of the size of a mesh: centres nearer to each other along an axis lie in one layer of cells (OpenFOAM writes ten digits)
SNAP = 1e-6  # of a cell: how far from a cell edge a span may end; our choice


def cell_edges(case) -> tuple[np.ndarray, ...]:
    """Edges [m] of the gas cells along each axis, from 0; on a stretched axis each cell is wider than the one before by one factor."""
    return tuple(map(graded_edges, case.domain.size, cells(case), case.resolution.stretch or (1.0,) * case.dimensions))


def graded_edges(length: float, count: int, stretch: float) -> np.ndarray:
    """(count + 1,) edges from 0 to `length`; `stretch` is the last width over the first, as blockMesh's simpleGrading means it."""
    widths = stretch ** (np.arange(count) / max(count - 1, 1))
    edges = np.concatenate(([0.0], np.cumsum(widths)))
    return edges * (length / edges[-1])


def nearest_edge(edges: np.ndarray, place: float, key: str) -> int:
    """Number of the cell edge at `place` [m], which `key` gives; between two edges it is a CaseError."""
    nearest = int(np.argmin(np.abs(edges - place)))
    if abs(edges[nearest] - place) > SNAP * np.diff(edges).min():
        raise CaseError(f"{key} ends at {place:g}, which is no edge of a gas cell; the nearest is {edges[nearest]:g}")
    return nearest


def layers(along: np.ndarray) -> np.ndarray:
    """(C,) number of the layer of cells that each centre lies in; `along` (C,) [m] are the centres along an axis."""
    order = np.argsort(along, kind="stable")
    number = np.empty(len(along), dtype=np.int64)
    number[order] = np.concatenate(([0], np.cumsum(np.diff(along[order]) > SAME * np.ptp(along))))
    return number
