"""Neighbours by a cell-linked list: counting sort into cells, particles reordered, rows (sdph.engine.rows) with a skin.

`Neighbours.update` reorders the particles so that those of one cell lie together, and lists for each particle all
others within `reach * (1 + skin)`; the rows hold until some particle has moved half the skin. Within a cell walls come
last, and the row of a wall particle holds what is near it and no other wall.
"""

from __future__ import annotations

import numpy as np

from sdph.engine import arrays, motion
from sdph.engine import state as particles
from sdph.engine.cells import Grid, halves, solid_of
from sdph.engine.domain import Domain
from sdph.engine.geometry import OPEN, OPEN_PLANE, box_of
from sdph.engine.kept import Many
from sdph.engine.rows import Rows, count, fill, laid, renumber
from sdph.engine.world import ALONE

SKIN = 0.1  # of the reach; our choice: 0.2 h measured best (about 5-8 steps per list), and the reach is 2 h
CELLS_A_PARTICLE = 16  # memory of the cells stays below that of the rows; our choice
MOST_CELLS = 2**20  # along an axis, so that their product is an int64
NOBODY = np.zeros(0, np.int8)


def reach_of(reach: float, skin: float) -> float:
    """Distance [m] up to which rows list neighbours."""
    return reach * (1.0 + skin)


class Neighbours:
    """Neighbour rows of a state that moves."""

    KEPT, FORMS = ("built",), {"built": Many(np.zeros(0))}  # see sdph.engine.kept

    def __init__(self, reach: float, period=(OPEN, OPEN, OPEN), skin: float = SKIN, world=ALONE, halo: float = 1.0):
        if any(0.0 < length < 2.0 * reach for length in period):
            raise ValueError(
                f"periods {tuple(period)} m: a periodic box must be at least two reaches ({2.0 * reach:g} m) wide, or "
                "images are missed"
            )
        self.reach, self.skin = reach, skin
        self.period = np.array([*period, OPEN][:3])
        self.world, self.domain = world, Domain(world, halo * reach_of(reach, skin), np.array(period))
        self.box = OPEN_PLANE  # of the particles that rows were last made for
        self.built = ()  # positions at the last build
        self.room = np.empty(0, np.uint32)

    def update(self, state, *stale):
        """The state (reordered where the list had to be rebuilt) and its rows; copies of particles of other processes
        are as these are, in the arrays `stale` of the state at least."""
        axes = self.domain.axes
        if not self.world.any(not self._holds(axes(state))):
            self.domain.refresh(*stale)
            return state, self.rows
        for axis, period in zip(axes(state), self.period):
            if period:
                motion.wrap(axis, period)
        state = self.domain.share(state)
        rows = self.domain.own_first(state, self.by_cell(axes(state), solid_of(state.kind)))
        self.domain.sort(rows)
        state = particles.take(state, rows)
        self.built = tuple(map(arrays.copy, axes(state)))
        rows = self.relist(state.kind, state.copy)
        self.domain.weigh(state, rows.number)
        return state, rows

    def by_cell(self, here, solid) -> np.ndarray:
        """Rows of the places `here` cell by cell, in each of them those of `solid` (N,) last."""
        return arrays.order(*self._halves(here, solid)[1:])

    def _halves(self, here, solid) -> tuple:
        """Grid of the places `here`, half of a cell that each is in, and how many there are."""
        grid, number = self._grid(here), arrays.empty(len(solid), solid, np.int64)
        halves(grid, *three(here), solid, number)
        return grid, number, 2 * int(grid.shape.prod())

    def relist(self, kind, copy=NOBODY) -> Rows:
        """Rows of the particles at the last build, of these kinds; those of copies are empty."""
        solid, here = solid_of(kind), self.built
        if not len(copy):
            self.rows = self._rows(here, solid, here, solid, True)
            return self.rows
        cells = self.by_cell(here, solid)  # rows are made of particles cell by cell; of these own ones come first
        here, solid = tuple(axis[cells] for axis in here), solid[cells]
        self.rows = _renumbered(self._rows(here, solid, here, solid, True, copy[cells]), cells)
        return self.rows

    def _holds(self, here) -> bool:
        if len(here) != len(self.built) or len(here[0]) != len(self.built[0]):
            return False
        return bool(motion.travelled(*three(here), *three(self.built)) < (0.5 * self.skin * self.reach) ** 2)

    def _grid(self, here) -> Grid:
        """Cells no smaller than the cutoff; larger ones where a few stray particles make the box mostly empty."""
        cutoff = reach_of(self.reach, self.skin)
        while (grid := self._cells_of(here, cutoff)).shape.prod() > CELLS_A_PARTICLE * max(64, len(here[0])):
            cutoff *= 2.0
        return grid

    def _cells_of(self, here, cutoff: float) -> Grid:
        size, origin, shape = np.ones(3), np.zeros(3), np.ones(3, np.int64)
        for a, axis in enumerate(here):
            low, high = (0.0, self.period[a]) if self.period[a] else arrays.ends(axis)
            cells = max(1, int(min((high - low) / cutoff, MOST_CELLS)))
            origin[a], shape[a] = low, cells
            size[a] = (high - low) / cells if self.period[a] else max(cutoff, (high - low) / cells * (1.0 + 1e-12))
        return Grid(origin, size, shape, self.period)

    def _rows(self, here, solid, at, blind, same: bool, idle=NOBODY) -> Rows:
        """Rows of the points `here`, sorted by cell, `solid` ones last, for the points `at`; `blind` ones see nothing
        solid, `idle` ones nothing. With `same` both are the same points."""
        (grid, *found), self.box = self._halves(here, solid), box_of(self.period, len(here))
        begin = arrays.starts(*found).view(np.uint64)  # see _run
        near = (
            grid,
            begin,
            *three(here),
            *three(at),
            blind,
            idle,
            same,
            self.box,
            reach_of(self.reach, self.skin) ** 2,
        )
        number, taken = arrays.empty(len(blind), blind, np.int32), arrays.empty(len(blind), blind, np.int64)
        count(*near, number, taken)
        kind, start = laid(taken)
        rows = kind(self._room(int(arrays.last(start)), blind), start, number)
        fill(*near, rows, taken, rows.entries)
        return rows

    def _room(self, entries: int, like):
        """Room for that many entries; that of the last time where they fit, which nobody needs any more."""
        if len(self.room) < entries or arrays.here(self.room) != arrays.here(like):
            self.room = np.empty(0, np.uint32)  # given back before more is taken
            self.room = arrays.empty(entries + entries // arrays.SPARE, like, np.uint32)
        return self.room

    def sort(self, here) -> np.ndarray:
        """Order in which fixed points have to stand for `seen_from`."""
        return self.by_cell(here, arrays.zeros(len(here[0]), here[0], np.bool_))

    def seen_from(self, here, at) -> Rows:
        """Rows of fixed points `here`, in the order of `sort`, for the points `at`; they are not filled up."""
        here_, there = (arrays.zeros(len(axes[0]), axes[0], np.bool_) for axes in (here, at))
        return self._rows(here, here_, at, there, False)


def three(here):
    """Positions in three arrays; the last without length in two dimensions."""
    return here if len(here) == 3 else (*here, np.zeros(0))


def _renumbered(rows: Rows, order) -> Rows:
    """Rows of the particles whose n-th is order[n] from now on, and so are their entries."""
    place = np.empty(len(order), np.int64)
    place[order] = np.arange(len(order))
    renumber(rows.entries, int(rows.start[-1]), order)
    return Rows(rows.entries, rows.start[place], rows.number[place])
