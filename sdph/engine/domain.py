"""Particles of one process among several: its own, and copies of those of others within reach of them.

Whenever rows are made anew, particles go to the process in whose part of space they are, and copies are made; between,
`refresh` brings values of the copies up to date. Loops go over own particles, their rows hold copies too.
"""

from __future__ import annotations

import functools

import numpy as np

from sdph.engine import arrays, cuts
from sdph.engine import state as particles
from sdph.engine.state import WALL
from sdph.engine.world import ALONE
from sdph.schema import CaseError

UNEVEN = 1.1  # pairs of the busiest process over their mean, from which on space is cut anew; our choice
OF_ROW = 40  # bits that the number of a row takes
OF_WALL = 0.02  # weight of a wall particle over one of liquid's before rows are known: most have none; our choice


class Domain:
    """Own particles and copies within `reach` [m] of them, in a box with `period` (d,) [m], 0 where open; with one
    process all are its own, and nothing is done."""

    def __init__(self, world, reach: float, period):
        self.world, self.reach, self.period = world, reach, period
        self.alone = world.number == 1
        self.tree, self.pairs = None, np.zeros(0)  # cuts; neighbours of each particle (N,)
        self.parted = False  # True where at first each process has a part of the particles, and not all
        self.sends, self.gets = {}, {}  # rows by rank: own ones that it has copies of, copies of its
        self.imbalance, self.halo = 1.0, 0.0  # pairs of the busiest over their mean; copies over own particles
        self.sent = np.zeros(2)  # messages of `refresh`, and bytes in them

    def _refuse_crowd(self, state) -> None:
        """CaseError where there are more processes than particles to share."""
        count = int((state.kind != WALL).sum())
        count = self.world.sum(count) if self.parted else count
        if self.world.number > count:
            raise CaseError(f"--ranks {self.world.number}: there are {count} particles; give no more ranks than these")

    def axes(self, state) -> tuple[np.ndarray, ...]:
        """Positions by axis, of all that there are where this process has no particles, too."""
        return particles.axes(state) if self.alone else state[: len(self.period)]

    def mine(self, state, mask: np.ndarray) -> np.ndarray:
        """Rows of the own particles among those of a mask (N,)."""
        return arrays.chosen(mask if self.alone else mask & (state.copy == 0))

    def share(self, state):
        """Own particles and fresh copies; at first each process has all particles, or some part of them."""
        if self.alone:
            return state
        if self.tree is None:
            own = self._begun(state)
        else:
            own = _own(state)
            if self.imbalance > UNEVEN and not self.world.any(len(self.pairs) != len(state.x)):
                self.tree = cuts.cut(self.world, self._places(own), 1.0 + self.pairs[state.copy == 0])
            own = self._moved(own)
        return self._with_copies(own)

    def _begun(self, state):
        """Cut space, for the first time; the particles that are in this part of it, in the order they were made in."""
        self._refuse_crowd(state)
        self.tree = cuts.cut(self.world, self._places(state), np.where(state.kind == WALL, OF_WALL, 1.0))
        if not self.parted:
            return particles.take(state, self._here(state))
        own = self._moved(state)
        return particles.take(own, np.argsort(own.ident, kind="stable"))

    def admitted(self, state):
        """The state without those of its last rows, new ones that every process has, that are others' own."""
        old = len(state.copy)
        if self.alone or self.tree is None or old == len(state.x):
            return state
        here = self._here(state)
        here[:old] = True
        known = np.concatenate((state.copy, np.zeros(len(state.x) - old, state.copy.dtype)))
        return particles.take(state._replace(copy=known), here)

    def own_first(self, state, order: np.ndarray) -> np.ndarray:
        """An order of rows with those of own particles before those of copies."""
        return order if self.alone else order[np.argsort(state.copy[order], kind="stable")]

    def own(self, state):
        """The own particles of a state that stands so: what is written there, is written in the state."""
        return state if not len(state.copy) else particles.first(state, int(np.count_nonzero(state.copy == 0)))

    def mine_of(self, array: np.ndarray) -> np.ndarray:
        """The rows of own particles among those of an array (N, ...), a view."""
        return array if self.alone else array[: len(array) - sum(map(len, self.gets.values()))]

    def sort(self, order: np.ndarray) -> None:
        """Take note that row n is now what was row order[n]."""
        if self.alone:
            return
        place = np.empty(len(order), np.int64)
        place[order] = np.arange(len(order))
        self.sends = {rank: place[rows] for rank, rows in self.sends.items()}
        self.gets = {rank: place[rows] for rank, rows in self.gets.items()}

    def weigh(self, state, pairs: np.ndarray) -> None:
        """Take note of how many neighbours each particle (N,) has."""
        if self.alone:
            return
        self.pairs, own = pairs.copy(), state.copy == 0
        work, copies, mine = float(len(own) + pairs[own].sum()), float((~own).sum()), float(own.sum())
        whole, copies, mine = self.world.sum(np.array([work, copies, mine]))
        self.imbalance, self.halo = float(self.world.most(work) * self.world.number / whole), float(copies / mine)

    def with_room(self, values: np.ndarray, state) -> np.ndarray:
        """Values (n,) or (n, k) of the own particles of a state, with 0 for its copies behind them."""
        if self.alone:
            return values
        return np.concatenate((values, np.zeros((len(state.x) - len(values), *values.shape[1:]))))

    def marked(self, state):
        """The state with this process in the number `row` of each particle, for `home`."""
        if not self.alone:
            state.row[:] += self.world.rank << OF_ROW
        return state

    def home(self, number: np.ndarray, values: np.ndarray) -> list:
        """(rows (n,), values (n, k)) of the particles that were in these rows here when they were `marked`, from where
        they are now; number (N,) and values (N, k) are of own ones."""
        if self.alone:
            return [(number, values)]
        row = number & ((1 << OF_ROW) - 1)
        return self.world.exchange([(row[rows], values[rows]) for rows in self._by_rank(number >> OF_ROW)])

    def refresh(self, *arrays: np.ndarray) -> None:
        """Bring the copies in arrays (N,) or (N, k) up to date; those without length are passed over."""
        if self.alone or not (self.sends or self.gets):
            return
        arrays = [array for array in arrays if len(array)]
        comm, sent, inbox = self.world.comm, [], {}
        for rank, rows in self.gets.items():
            inbox[rank] = np.empty(sum(len(rows) * (array.size // len(array)) for array in arrays))
            sent.append(comm.Irecv(inbox[rank], rank))
        for rank, rows in self.sends.items():
            values = np.concatenate([array[rows].ravel() for array in arrays], dtype=np.float64)  # whole numbers too
            sent.append(comm.Isend(values, rank))
            self.sent += 1, values.nbytes
        type(sent[0]).Waitall(sent)
        self._put(arrays, inbox)

    def _put(self, arrays, inbox: dict) -> None:
        """Put the values that ranks have sent in the rows of their copies."""
        for rank, rows in self.gets.items():
            begin = 0
            for array in arrays:
                shape = (len(rows), *array.shape[1:])
                end = begin + int(np.prod(shape))
                array[rows] = inbox[rank][begin:end].reshape(shape)
                begin = end

    def gather(self, state, arrays: list) -> tuple | None:
        """State and arrays (N, ...) of all particles, at the chief; None elsewhere."""
        mine = state.copy == 0
        parts = self.world.gather((_own(state), [array[mine] if len(array) else array for array in arrays]))
        if parts is None:
            return None
        states, others = zip(*parts)
        return _joined(states), [np.concatenate(same) for same in zip(*others)]

    def summary(self, steps: int) -> dict[str, float]:
        """Keys of summary.json; messages and bytes are means by process and step of the `steps` taken."""
        sent = self.world.sum(self.sent) / self.world.number / (steps or 1)
        found = {"ranks": self.world.number, "imbalance": self.imbalance, "halo_share": self.halo}
        return found | {"messages_per_step": float(sent[0]), "halo_bytes_per_step": float(sent[1])}

    def _places(self, state) -> np.ndarray:
        return np.stack(self.axes(state), axis=1)

    def _here(self, state) -> np.ndarray:
        """Mask (N,) of what is in this part of space."""
        return cuts.owner(self.tree, self._places(state)) == self.world.rank

    def _moved(self, own):
        """The particles that are in this part of space now."""
        to = cuts.owner(self.tree, self._places(own))
        if not self.world.any(bool((to != self.world.rank).any())):
            return own
        parts = [particles.take(own, rows) if len(rows) else None for rows in self._by_rank(to)]
        return _joined([particles.first(own, 0), *_some(self.world.exchange(parts))])

    def _by_rank(self, rank: np.ndarray) -> list[np.ndarray]:
        """Rows of each rank among ranks (N,); what each of thousands looks through once is looked through once here."""
        order = np.argsort(rank, kind="stable")
        return np.split(order, np.searchsorted(rank[order], np.arange(1, self.world.number)))

    def _with_copies(self, own):
        places = self._places(own)
        own_ends = places.min(axis=0, initial=np.inf), places.max(axis=0, initial=-np.inf)
        ends, found = np.array(self.world.everywhere(own_ends)), [np.zeros(0, int)] * self.world.number
        for rank in np.flatnonzero(cuts.beside(ends, self.world.rank, self.reach, self.period)):
            found[rank] = np.flatnonzero(cuts.near(places, *ends[rank], self.reach, self.period))
        copies = self.world.exchange([particles.take(own, rows) if len(rows) else None for rows in found])
        self.sends = {rank: rows for rank, rows in enumerate(found) if len(rows)}
        self.gets, count = {}, len(own.x)
        for rank, part in enumerate(copies):
            if part is not None:
                self.gets[rank] = np.arange(count, count + len(part.x))
                count += len(part.x)
        mark = (np.arange(count) >= len(own.x)).astype(np.int8)
        return _joined([own, *_some(copies)])._replace(copy=mark)


WHOLE = Domain(ALONE, 0.0, ())  # of one process


def _own(state):
    """The particles that are no copies, without the mark."""
    return particles.take(state, state.copy == 0)._replace(copy=state.copy[:0])


def _some(parts: list) -> list:
    """Parts that hold something."""
    return [part for part in parts if part is not None]


def _joined(states):
    return functools.reduce(particles.join, states)
