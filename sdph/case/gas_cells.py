"""Edges of the gas cells of a box, equal or stretched: one grid for every gas solver; cells of any mesh by height."""

from __future__ import annotations

import math

import numpy as np

from sdph.case.sections import Case
from sdph.schema import CaseError

# of the size of a mesh: centres nearer to each other along an axis lie in one layer of cells (OpenFOAM writes ten
# digits)
SAME = 1e-8
THIN = 0.25  # of the size of a cell: layers nearer to each other on average are none, as of tetrahedra; our choice
# from one layer of cells to the next the vessel is at most so many times as wide: more are cells that lean, whose
# centres lie a little higher than those beside them (or a vessel with a step, for which slabs do as well); our choice
STEP = 4.0
SNAP = 1e-6  # of a cell: how far from a cell edge a span may end; our choice


def cell_edges(case) -> tuple[np.ndarray, ...]:
    """Edges [m] of the gas cells along each axis, from 0; on a stretched axis each cell is wider than the one before by
    one factor."""
    return tuple(map(graded_edges, case.domain.size, cells(case), case.resolution.stretch or (1.0,) * case.dimensions))


def graded_edges(length: float, count: int, stretch: float) -> np.ndarray:
    """(count + 1,) edges from 0 to `length`; `stretch` is the last width over the first, as blockMesh's simpleGrading
    means it."""
    widths = stretch ** (np.arange(count) / max(count - 1, 1))
    edges = np.concatenate(([0.0], np.cumsum(widths)))
    return edges * (length / edges[-1])


def nearest_edge(edges: np.ndarray, place: float, key: str) -> int:
    """Number of the cell edge at `place` [m], which `key` gives; between two edges it is a CaseError."""
    nearest = int(np.argmin(np.abs(edges - place)))
    if abs(edges[nearest] - place) > SNAP * np.diff(edges).min():
        raise CaseError(f"{key} ends at {place:g}, which is no edge of a gas cell; the nearest is {edges[nearest]:g}")
    return nearest


def layers(along: np.ndarray, apart: float) -> np.ndarray:
    """(C,) number of the layer of cells that each centre lies in; `along` (C,) [m] are the centres along an axis, which
    part layers where none lies for `apart` [m]."""
    order = np.argsort(along, kind="stable")
    number = np.empty(len(along), dtype=np.int64)
    number[order] = np.concatenate(([0], np.cumsum(np.diff(along[order]) > apart)))
    return number


def round_off(centres) -> float:
    """Distance [m] up to which centres (C, d) [m] of a mesh are at one place along an axis: by its largest extent."""
    return SAME * float(np.ptp(centres, axis=0).max())


def by_axis(centres) -> list[np.ndarray]:
    """d arrays (C,): the layer of cells that each centre (C, d) [m] lies in along each axis."""
    return [layers(along, round_off(centres)) for along in centres.T]


def upwards(case, metric: str) -> np.ndarray:
    """(3,) unit vector against gravity, for a metric that asks what is up."""
    gravity = np.array([*case.domain.gravity, 0.0][:3])
    if not gravity.any():
        given = f"domain.gravity_m_s2 = {list(case.domain.gravity)}"
        raise CaseError(
            f"run.metrics holds {metric}, but {given} tells of no way up; give gravity, or leave {metric} out"
        )
    return -gravity / np.linalg.norm(gravity)


class CellRows:
    """Cells of any mesh sorted by height along `up` (3,): `own` (C,) is the row of each cell, `above` (C,) [m] its
    height over the floor; place over the floor and height (R,) [m] of each row, which may differ, and its area [m2], of
    a plane mesh times its depth; `floor` and `top` [m], the place of the floor along `up` and the height of the vessel.
    Two rows that touch are taken to be equally wide."""

    def __init__(self, mesh, up):
        along = mesh.centres @ np.asarray(up)
        self.own, self.volumes = _rows(along, mesh), mesh.volumes
        whole = np.bincount(self.own, self.volumes)
        if len(whole) < 2:
            what = "run.metrics asks for what changes with height"
            raise CaseError(f"{what}, but the gas has one row of cells; make them smaller, or leave it out")
        place = self.mean(along)
        apart = 2.0 * np.diff(place) / (whole[1:] + whole[:-1])  # height over volume of the two rows
        self.height = whole * np.concatenate((apart[:1], 0.5 * (apart[1:] + apart[:-1]), apart[-1:]))
        self.floor = float(place[0] - 0.5 * self.height[0])
        self.top = float(place[-1] + 0.5 * self.height[-1]) - self.floor
        self.place, self.above = place - self.floor, along - self.floor
        self.area = whole / self.height

    def at_ends(self, values) -> tuple[float, float]:
        """Values extrapolated linearly to the floor and to the top, each from the two rows next to it."""
        slopes = np.diff(values)[[0, -1]] / np.diff(self.place)[[0, -1]]
        return float(values[0] - slopes[0] * self.place[0]), float(values[-1] + slopes[1] * (self.top - self.place[-1]))

    def mean(self, values) -> np.ndarray:
        """Means of the rows, from the floor up."""
        return np.bincount(self.own, self.volumes * values) / np.bincount(self.own, self.volumes)


def _rows(along, mesh) -> np.ndarray:
    """(C,) row of each cell: its layer, where cells lean that with those little higher or lower, or where they lie in
    none, a slab as thick as a cell is wide."""
    extent = np.ptp(along)
    size = (mesh.volumes.mean() / mesh.depth) ** (1.0 / mesh.dimensions)
    for apart, fewest in ((round_off(mesh.centres), 0.0), (THIN * size, THIN * extent / size)):
        own = layers(along, apart)
        if own.max() >= fewest and own.max() * THIN * size <= extent and _even(own, along, mesh.volumes):
            return own
    slabs = np.floor((along - along.min()) / (extent * (1.0 + SAME)) * max(2, round(extent / size)))
    return np.unique(slabs, return_inverse=True)[1]


def _even(own: np.ndarray, along: np.ndarray, volumes: np.ndarray) -> bool:
    """True where layers `own` (C,) of cells are about as wide as those beside them: volume over height."""
    whole = np.bincount(own, volumes)
    place = np.bincount(own, volumes * along) / whole
    across = 0.5 * (whole[1:] + whole[:-1]) / np.diff(place)
    return bool((np.abs(np.diff(np.log(across))) <= math.log(STEP)).all())


def cells(case: Case) -> tuple[int, ...]:
    """Number of gas cells along each axis: the lengths over the cell size, rounded."""
    return tuple(max(1, math.floor(length / case.resolution.cell + 0.5)) for length in case.domain.size)
