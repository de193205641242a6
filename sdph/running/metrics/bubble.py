"""Metrics of a bubble in a bed, from cell fields on a box mesh: the same function for SDPH and two-fluid fields.

The bubble is the largest connected void, alpha_p < VOID, that does not reach the top of the domain.
"""

from __future__ import annotations

import math

import numpy as np

from coupling.gas import Mesh
from sdph.case.gas_cells import SAME, CellRows, by_axis
from sdph.schema import CaseError

VOID = 0.15  # alpha_p below which a cell belongs to a bubble (issue: state it; Kuipers et al. 1991)
UP = (0.0, 1.0, 0.0)  # of a bed whose gravity is not told: along y
SURFACE = 0.3  # alpha_p, mean over the width, at the top of the bed: half of a packed bed's


def metrics(centres, volumes, alpha_p, gas_temperature, pressure, up=UP, walled=0.0) -> dict[str, float]:
    """Keys of one instant; centres (C, 3) [m], volumes (C,) [m3] and fields (C,) of a plane mesh 1 m deep, of any
    cells.

    `walled` (C,) is the share of a cell within walls that the gas goes through: that is no bubble. Heights are over the
    floor, along `up` (3,); neck_width_m is the least width of the bubble below its widest row;
    attached is 1 while it touches the floor.
    """
    rows = CellRows(Mesh(centres, volumes, 2), up)
    own = largest_void(centres, rows, alpha_p + walled)
    width = np.bincount(rows.own, own * volumes) / rows.height
    total, profile = float(volumes[own].sum()), rows.mean(pressure)
    return {
        "bubble_area_m2": total,
        "bubble_diameter_m": math.sqrt(4.0 * total / math.pi),
        "bubble_centroid_m": float(volumes[own] @ rows.above[own] / total) if total else 0.0,
        "neck_width_m": _neck(width),
        "attached": float(own[rows.own == 0].any()),
        "gas_temperature_max_K": float(gas_temperature.max()),
        "bed_height_m": _surface(rows.mean(alpha_p), rows.place),
        "pressure_drop_Pa": float(profile[0] - profile[-1]),
        "alpha_p_cell_max": float(alpha_p.max()),
    }


def through_depth(depth: float, centres, volumes, *fields, up=UP) -> tuple:
    """Centres, volumes and fields of a plane mesh 1 m deep: those of a slab, `depth` [m] along z, averaged through
    it."""
    across, along, through = by_axis(centres)
    place = along * len(centres) + across
    _, first, column, deep = np.unique(place, return_index=True, return_inverse=True, return_counts=True)
    if deep.min() != through.max() + 1 or abs(up[2]) > SAME:
        plane = "in 2-D, or a slab with cells in columns along z and gravity across them"
        raise CaseError(f"run.metrics holds bubble, which is of a plane bed: {plane}; leave it out")
    whole = np.bincount(column, volumes)
    return centres[first], whole / depth, *(np.bincount(column, volumes * field) / whole for field in fields)


def detachment(times, rows: list[dict]) -> float:
    """First time [s] at which a bubble that touched the floor does so no more; nan if it never let go."""
    touched = np.array([row["attached"] for row in rows], bool)
    free = [t for t, before, now in zip(times[1:], touched[:-1], touched[1:]) if before and not now]
    return float(free[0]) if free else math.nan


def rows_of(centres) -> tuple[np.ndarray, tuple[int, int]]:
    """Order of the cells row by row from the floor, and (rows, columns)."""
    x, y = by_axis(centres[:, :2])
    return np.lexsort((x, y)), (int(y.max()) + 1, int(x.max()) + 1)


def largest_void(centres, rows: CellRows, alpha_p) -> np.ndarray:
    """Mask (C,) of the largest connected region alpha_p < VOID that does not reach the last of the rows."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    void = alpha_p < VOID
    one, other = (ends := neighbours(centres))[(void[ends]).all(axis=1)].T
    graph = coo_matrix((np.ones(len(one), bool), (one, other)), (len(void), len(void)))
    _, region = connected_components(graph, directed=False)
    sizes = np.bincount(region, void * rows.volumes)
    sizes[region[void & (rows.own == len(rows.place) - 1)]] = 0.0
    return void & (region == sizes.argmax()) & (sizes.max() > 0.0)


def neighbours(centres) -> np.ndarray:
    """(P, 2) cells of a plane mesh that lie side by side.

    On a grid they share a face. Of other cells only the centres are known: two are neighbours where no third centre
    lies in the circle between them (graph of Gabriel & Sokal, Syst. Zool. 18, 259, 1969), which on a grid is the same.
    """
    order, shape = rows_of(centres)
    if math.prod(shape) == len(centres):
        grid = order.reshape(shape)
        pairs = ((grid[1:], grid[:-1]), (grid[:, 1:], grid[:, :-1]))
        return np.concatenate([np.stack((a.ravel(), b.ravel()), axis=1) for a, b in pairs])
    from scipy.spatial import Delaunay, cKDTree

    plane = centres[:, :2]
    ends = Delaunay(plane).simplices[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    ends = np.unique(np.sort(ends, axis=1), axis=0)
    half = 0.5 * np.linalg.norm(plane[ends[:, 0]] - plane[ends[:, 1]], axis=1)
    third = cKDTree(plane).query(plane[ends].mean(axis=1), k=3)[0][:, 2]
    return ends[third > (1.0 + SAME) * half]


def _neck(width) -> float:
    rows = np.flatnonzero(width)
    if len(rows) == 0:
        return 0.0
    below = width[rows[0] : int(width.argmax()) + 1]
    return float(below.min())


def _surface(profile, height) -> float:
    """Height [m] at which the mean alpha_p falls through SURFACE, from the top down."""
    dense = np.flatnonzero(profile >= SURFACE)
    if len(dense) == 0 or dense[-1] + 1 >= len(profile):
        return float(height[dense[-1]]) if len(dense) else 0.0
    i = dense[-1]
    share = (profile[i] - SURFACE) / (profile[i] - profile[i + 1])
    return float(height[i] + share * (height[i + 1] - height[i]))
