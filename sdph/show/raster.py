"""Flat pictures pixel by pixel: particles to their size, without gaps, or as a continuous field; cells of the gas."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from sdph.show import sampled
from sdph.show.shot import Shot, numbers

ROUND = 0.55  # radius over edge of what a particle alone is drawn as: a disc of its area, nearly
CLOSED = 0.45  # of an edge: gaps between particles that are narrower than twice this and a disc are closed; our choice
BLEND = 0.55  # share of the paper in the colour of a gas beside a liquid; our choice


class Pixels(NamedTuple):
    """Centres (rows, columns, 3) [m] of the pixels of a flat picture, from below, and its edges (4,) [m]."""

    places: np.ndarray
    edges: tuple[float, float, float, float]

    @property
    def shape(self) -> tuple[int, int]:
        return self.places.shape[:2]

    @property
    def step(self) -> tuple[float, float]:
        """Distances [m] of rows and of columns."""
        x0, x1, y0, y1 = self.edges
        return (y1 - y0) / self.shape[0], (x1 - x0) / self.shape[1]

    @property
    def flat(self) -> np.ndarray:
        return self.places.reshape(-1, 3)


def pixels(shot: Shot, width: int) -> Pixels:
    """Pixels of a shot, `width` along its longer side."""
    right, up = shot.axes
    low, high = shot.box[::2], shot.box[1::2]
    step = max(high[right] - low[right], high[up] - low[up], 1e-30) / width
    count = [max(1, round((high[a] - low[a]) / step)) for a in (right, up)]
    ticks = [low[a] + (np.arange(n) + 0.5) * (high[a] - low[a]) / n for a, n in zip((right, up), count)]
    places = np.full((count[1], count[0], 3), shot.level)
    places[..., right], places[..., up] = np.meshgrid(*ticks)
    return Pixels(places, (low[right], high[right], low[up], high[up]))


def gas(shot: Shot, grid: Pixels, field: str, smooth: bool) -> np.ndarray:
    """(rows, columns) of a field of the gas, by cells or interpolated between them; nan where it has none."""
    if shot.gas is None or field not in shot.gas.cell_data:
        return np.full(grid.shape, np.nan)
    found = sampled.between_cells if smooth else sampled.of_cells
    return numbers(found(shot.gas, grid.flat, field)).reshape(grid.shape)


def particles(shot: Shot, grid: Pixels, field: str, smooth: bool) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(values, covered, light), each (rows, columns): of the particles, where they are, and which of them are a gas
    beside a liquid."""
    near, numbered = _nearest(shot, grid)
    light = (shot.light() if len(shot.light()) else np.zeros(1, bool))[np.maximum(numbered, 0)] & near
    if field not in shot.particles.point_data:
        return np.full(grid.shape, np.nan), near, light
    values = numbers(shot.particles.point_data[field])
    found = np.where(near, (values if len(values) else np.zeros(1))[np.maximum(numbered, 0)], np.nan)
    if smooth:
        found, near = _smooth(shot, grid, values, found, near)
        near &= ~_behind(shot, grid, numbered)
        found = np.where(near, found, np.nan)
    return found, near, light


def _nearest(shot: Shot, grid: Pixels) -> tuple[np.ndarray, np.ndarray]:
    """(covered, number): whether the nearest particle covers a pixel, and which that is. Discs that are too large by
    `CLOSED` leave no gaps; what they are too large by is then taken off from outside."""
    from scipy.ndimage import distance_transform_edt
    from scipy.spatial import cKDTree

    places, sizes = np.asarray(shot.particles.points), shot.drawn()
    seen = np.flatnonzero(np.abs(places[:, shot.across] - shot.level) <= 0.5 * shot.spacing) if len(places) else []
    if not len(seen):
        return np.zeros(grid.shape, bool), np.zeros(grid.shape, int)
    tree = cKDTree(places[seen][:, shot.axes])
    reach = (ROUND + CLOSED) * float(sizes[seen].max())
    distance, number = tree.query(grid.flat[:, shot.axes], distance_upper_bound=reach, workers=-1)
    number = seen[np.minimum(number, len(seen) - 1)].reshape(grid.shape)
    covered = distance.reshape(grid.shape) <= (ROUND + CLOSED) * sizes[number]
    if not covered.all():
        covered = distance_transform_edt(covered, grid.step) > CLOSED * sizes[number]
    return covered & ~_behind(shot, grid, number), number


def _behind(shot: Shot, grid: Pixels, number) -> np.ndarray:
    """Mask of the pixels that lie outside the gas while particle `number` of each (rows, columns) stands in it: behind
    a wall."""
    if shot.gas is None or shot.walls is None:
        return np.zeros(grid.shape, bool)
    inside = sampled.cells_at(shot.gas, np.asarray(shot.particles.points)) >= 0
    return inside[number] & (sampled.cells_at(shot.gas, grid.flat) < 0).reshape(grid.shape)


def bulk(covered: np.ndarray, least: float) -> np.ndarray:
    """A mask (rows, columns) without its islands, and then without its gaps, of fewer than `least` pixels."""
    from scipy.ndimage import label

    for part in (True, False):
        numbered, _ = label(covered == part)
        small = np.bincount(numbered.ravel()) < least
        small[0] = False  # of the other part
        covered = covered ^ small[numbered]
    return covered


def _smooth(shot: Shot, grid: Pixels, values, found, near) -> tuple[np.ndarray, np.ndarray]:
    """The continuous field, up to the surface; a lone particle, which has none, stays as it is drawn."""
    import pyvista

    places, sizes = np.asarray(shot.particles.points), shot.sizes()
    known = np.isfinite(values)
    own, share = sampled.of_particles(
        pyvista.PolyData(grid.flat), places[known], sizes[known] ** shot.dimensions, {"value": values[known]},
        sampled.REACH * shot.spacing, shot.dimensions,
    )  # fmt: skip
    field, share = own["value"].reshape(grid.shape), share.reshape(grid.shape)
    inside = (share >= sampled.INSIDE) | (near & _beside(shot, grid))
    lone = near & ~inside & (share < 0.5 * sampled.INSIDE) & (share > 0.0)
    return np.where(inside, field, np.where(lone, found, np.nan)), inside | lone


def _beside(shot: Shot, grid: Pixels) -> np.ndarray:
    """Mask of the pixels within a spacing of a side of the box, behind which the sum lacks neighbours."""
    x0, x1, y0, y1 = grid.edges
    x, y = grid.places[..., shot.axes[0]], grid.places[..., shot.axes[1]]
    return np.minimum.reduce((x - x0, x1 - x, y - y0, y1 - y)) < shot.spacing


def surface(shot: Shot, grid: Pixels) -> np.ndarray:
    """(rows, columns) sum of volume and kernel of the heavy particles, over that of all where there is a gas of
    particles: 0.5 is where the liquid ends; nan where nothing is."""
    heavy = ~shot.light()
    share = _share(shot, grid, heavy)
    if heavy.all():
        return share
    whole = share + _share(shot, grid, ~heavy)
    return np.divide(share, whole, out=np.full(grid.shape, np.nan), where=whole > 0.0)


def _share(shot: Shot, grid: Pixels, chosen) -> np.ndarray:
    import pyvista

    places, sizes = np.asarray(shot.particles.points)[chosen], shot.sizes()[chosen]
    points, h = pyvista.PolyData(grid.flat), sampled.REACH * shot.spacing
    return sampled.of_particles(points, places, sizes**shot.dimensions, {}, h, shot.dimensions)[1].reshape(grid.shape)
