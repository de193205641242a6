"""Cartesian staggered grid in two or three dimensions from one source.

Every field is one flat float64 array over the padded box, x fastest, with three ghost layers on each side of
each axis that exists (three, so that a far-upwind read beyond an opening stays in the array). With `s` the stride
of axis a, index c names cell c, and for a face field of axis a the face between cells c - s and c. Volume and area
are zero in ghosts, so half a control volume at the boundary needs no special case.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from sdph.laws.by_reference import by_reference

PAD = 3


@by_reference
class Geometry(NamedTuple):
    """volume (S,) [m3]; width, area, gap, reach (d, S): cell width [m], face area [m2], distance [m] between the
    two values on either side of a face (a ghost's lies on the boundary), and that from the lower one to the face."""

    volume: np.ndarray
    width: np.ndarray
    area: np.ndarray
    gap: np.ndarray
    reach: np.ndarray


@dataclass(frozen=True)
class Grid:
    """counts, strides (d,); cells (C,): index of every cell, x fastest. For kernels, `inner` and `wide` are rows,
    run, steps: the first index of every run of so many cells along x, and the strides; wide has two indices more
    on each axis, for face fields. They are unsigned: numba then needs no check for negative indices, and loops
    become vector code (3.5 to 7 times faster here). A kernel must not mix them with signed integers.
    """

    edges: tuple[np.ndarray, ...]
    counts: tuple[int, ...]
    strides: tuple[int, ...]
    size: int
    cells: np.ndarray
    inner: tuple
    wide: tuple
    geometry: Geometry
    centres: np.ndarray

    @property
    def dimensions(self) -> int:
        return len(self.counts)

    def zeros(self, *leading: int) -> np.ndarray:
        return np.zeros((*leading, self.size))

    def padded(self, values: np.ndarray) -> np.ndarray:
        """(C,) values of the cells as a padded field, zero in ghosts."""
        field = self.zeros()
        field[self.cells] = values
        return field

    def extended(self, field: np.ndarray) -> np.ndarray:
        """The padded field (S,), in place, with the first ghosts as their neighbours, corners too."""
        box = field.reshape([n + 2 * PAD for n in reversed(self.counts)])
        for axis in range(box.ndim):
            along = np.moveaxis(box, axis, 0)
            along[PAD - 1], along[-PAD] = along[PAD], along[-PAD - 1]
        return field

    def per_volume(self, content: np.ndarray) -> np.ndarray:
        """(S,) content of the cells over their volume, ghosts as their neighbours."""
        volume = self.geometry.volume
        return self.extended(content / np.where(volume > 0.0, volume, 1.0))


def strides_of(counts: tuple[int, ...]) -> tuple[tuple[int, ...], int]:
    """Strides of the padded box and its size."""
    lengths = [n + 2 * PAD for n in counts]
    return tuple(int(np.prod(lengths[:a])) for a in range(len(counts))), int(np.prod(lengths))


def indices(counts: tuple[int, ...], lower: tuple[int, ...], upper: tuple[int, ...]) -> np.ndarray:
    """Padded indices, x fastest, of the cells lower <= i < upper (i = 0 is the first cell)."""
    strides, _ = strides_of(counts)
    index = np.zeros(1, dtype=np.int64)
    for stride, low, high in zip(strides, lower, upper):
        along = stride * (np.arange(low, high, dtype=np.int64) + PAD)
        index = (along[:, None] + index[None, :]).ravel()
    return index


def _rows(counts: tuple[int, ...], more: int) -> tuple:
    """rows, run, steps of `Grid.inner` (more = 0) and `Grid.wide`."""
    rows = indices(counts, (0,) * len(counts), (1, *(n + more for n in counts[1:])))
    return rows.astype(np.uint64), np.uint64(counts[0] + more), tuple(np.uint64(s) for s in strides_of(counts)[0])


def _spread(values: np.ndarray, axis: int, dimensions: int) -> np.ndarray:
    """One value per padded index along `axis`, over the whole padded box (z, y, x order)."""
    shape = [1] * dimensions
    shape[dimensions - 1 - axis] = len(values)
    return values.reshape(shape)


def build_grid(edges: tuple[np.ndarray, ...]) -> Grid:
    """The grid between `edges` of each axis [m]; a 2-D grid is 1 m deep."""
    d = len(edges)
    counts = tuple(len(e) - 1 for e in edges)
    strides, size = strides_of(counts)
    box = np.ones(tuple(n + 2 * PAD for n in reversed(counts)))
    flat = lambda axis, values: (_spread(values, axis, d) * box).ravel()  # noqa: E731
    inner = [np.pad(np.diff(e), PAD) for e in edges]  # widths, zero in ghosts
    faces = [(np.arange(n + 2 * PAD) >= PAD) * (np.arange(n + 2 * PAD) <= n + PAD) * 1.0 for n in counts]
    width = np.stack([flat(a, np.where(w > 0, w, 1.0)) for a, w in enumerate(inner)])
    reach = [0.5 * np.roll(w, 1) for w in inner]
    gap = [r + 0.5 * w for r, w in zip(reach, inner)]
    area = [np.prod([flat(b, inner[b] if b != a else faces[a]) for b in range(d)], axis=0) for a in range(d)]
    start, stop = (0,) * d, counts
    middle = [0.5 * (e[1:] + e[:-1]) for e in edges]
    centres = np.stack(np.meshgrid(*reversed(middle), indexing="ij")[::-1], axis=-1).reshape(-1, d)
    return Grid(
        edges=edges, counts=counts, strides=strides, size=size,
        cells=indices(counts, start, stop),
        inner=_rows(counts, 0), wide=_rows(counts, 2),
        geometry=Geometry(
            volume=np.prod([flat(a, inner[a]) for a in range(d)], axis=0), width=width, area=np.stack(area),
            gap=np.stack([flat(a, np.where(g > 0, g, 1.0)) for a, g in enumerate(gap)]),
            reach=np.stack([flat(a, r) for a, r in enumerate(reach)]),
        ),
        centres=centres,
    )  # fmt: skip


def component_spacing(grid: Grid, axis: int) -> tuple[np.ndarray, np.ndarray]:
    """gap and reach (d, S) between the velocities of `axis`, which live on its faces."""
    gap, reach = grid.geometry.gap.copy(), grid.geometry.reach.copy()
    gap[axis] = np.roll(grid.geometry.width[axis], grid.strides[axis])
    reach[axis] = 0.5 * gap[axis]
    return gap, reach
