"""What a bubble in a bed is like, from cell fields on a box mesh: the same function for SDPH and two-fluid fields.

The bubble is the largest connected void, alpha_p < VOID, that does not reach the top of the domain.
"""

from __future__ import annotations

import math

import numpy as np

from sdph.gas_cells import layers

VOID = 0.15  # alpha_p below which a cell belongs to a bubble (issue: state it; Kuipers et al. 1991)
SURFACE = 0.3  # alpha_p, mean over the width, at the top of the bed: half of a packed bed's


def metrics(centres, volumes, alpha_p, gas_temperature, pressure) -> dict[str, float]:
    """Keys of one instant; centres (C, 3) [m], volumes (C,) [m3] and fields (C,) of a plane mesh 1 m deep.

    neck_width_m is the least width of the bubble below its widest row; attached is 1 while it touches the floor.
    """
    order, shape = rows_of(centres)
    alpha, height = alpha_p[order].reshape(shape), centres[order, 1].reshape(shape)[:, 0]
    own = largest_void(alpha)
    area = volumes[order].reshape(shape)
    width = (own * area).sum(axis=1) / np.gradient(height)
    total = float((own * area).sum())
    return {
        "bubble_area_m2": total,
        "bubble_diameter_m": math.sqrt(4.0 * total / math.pi),
        "bubble_centroid_m": float((own * area * height[:, None]).sum() / total) if total else 0.0,
        "neck_width_m": _neck(width),
        "attached": float(own[0].any()),
        "gas_temperature_max_K": float(gas_temperature.max()),
        "bed_height_m": _surface(alpha.mean(axis=1), height),
        "pressure_drop_Pa": float(pressure[order[: shape[1]]].mean() - pressure[order[-shape[1] :]].mean()),
        "alpha_p_cell_max": float(alpha_p.max()),
    }


def through_depth(depth: float, centres, volumes, *fields) -> tuple:
    """Centres, volumes and fields of a plane mesh 1 m deep: those of a slab, `depth` [m] along z, averaged through it."""
    place = layers(centres[:, 1]) * len(centres) + layers(centres[:, 0])
    _, first, column = np.unique(place, return_index=True, return_inverse=True)
    whole = np.bincount(column, volumes)
    return centres[first], whole / depth, *(np.bincount(column, volumes * field) / whole for field in fields)


def detachment(times, rows: list[dict]) -> float:
    """First time [s] at which a bubble that touched the floor does so no more; nan if it never let go."""
    touched = np.array([row["attached"] for row in rows], bool)
    free = [t for t, before, now in zip(times[1:], touched[:-1], touched[1:]) if before and not now]
    return float(free[0]) if free else math.nan


def rows_of(centres) -> tuple[np.ndarray, tuple[int, int]]:
    """Order of the cells row by row from the floor, and (rows, columns)."""
    x, y = layers(centres[:, 0]), layers(centres[:, 1])
    return np.lexsort((x, y)), (int(y.max()) + 1, int(x.max()) + 1)


def largest_void(alpha) -> np.ndarray:
    """Mask of the largest connected region alpha_p < VOID that does not reach the last row; alpha (rows, columns)."""
    from scipy.ndimage import label

    labels, count = label(alpha < VOID)
    top = set(np.unique(labels[-1]))
    sizes = {n: int((labels == n).sum()) for n in range(1, count + 1) if n not in top}
    return labels == max(sizes, key=sizes.get) if sizes else np.zeros(alpha.shape, bool)


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
