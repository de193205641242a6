"""Processes that share the particles of a run: which of them this is, and what all of them know together.

One process alone is a world too, without MPI: sums are what they are, and nothing is sent. Every call is made by all
processes, in the same order.
"""

from __future__ import annotations

import functools
import math
import os

import numpy as np

from sdph.engine import arrays
from sdph.laws.constants import TINY

MARK = "SDPH_RANKS"  # variable of the environment of a process that is one of several
BITS, PARTS = 34, 3  # of a summand in each of so many whole numbers: 2^29 summands stay below 2^63; our choice


class World:
    """`number` processes, this one of `rank`; `chief` is the one that writes."""

    def __init__(self, comm=None):
        self.comm = comm
        self.rank, self.number = (comm.rank, comm.size) if comm else (0, 1)
        self.chief = self.rank == 0

    def sum(self, values):
        """Sum over the processes of a number or of an array."""
        return self._reduced(values, "SUM")

    def most(self, values):
        """Largest of a number, or of each place of an array."""
        return self._reduced(values, "MAX")

    def least(self, values):
        """Least of a number, or of each place of an array."""
        return self._reduced(values, "MIN")

    def any(self, flag: bool) -> bool:
        """True where one process says so."""
        return bool(flag) if self.number == 1 else self._reduced(float(flag), "MAX") > 0.0

    def mean(self, values) -> float:
        """Mean of the values (n,) of all processes; 0 where there are none."""
        if self.number == 1:
            return float(np.mean(values)) if len(values) else 0.0
        whole, many = self.sum(np.array([float(np.sum(values)), float(len(values))]))
        return float(whole / many) if many else 0.0

    def known(self, row: dict[str, float]) -> dict[str, float]:
        """A row with each number from a process that knows it: one that does not has nan."""
        if self.number == 1 or not row:
            return row
        rows = self.everywhere(row)
        return {name: next((own[name] for own in rows if own[name] == own[name]), math.nan) for name in row}

    def average(self, values, weights) -> float:
        """Mean by `weights` (n,) of the values (n,) of all processes."""
        if self.number == 1:
            return float(np.average(values, weights=weights))
        whole, weight = self.sum(np.array([float(np.sum(weights * values)), float(np.sum(weights))]))
        return float(whole / weight)

    def sums(self, row: dict[str, float]) -> dict[str, float]:
        """Sum of each of the numbers of a row, by their names, which all processes have in this order."""
        return dict(zip(row, self.sum(np.array([*row.values()])).tolist())) if self.number > 1 and row else row

    def leasts(self, row: dict[str, float]) -> dict[str, float]:
        """Least of each of them."""
        return dict(zip(row, self.least(np.array([*row.values()])).tolist())) if self.number > 1 and row else row

    def exact(self, values) -> float:
        """Sum of the values (n,) of all processes, each of them counted to its last digit."""
        return arrays.exact(values) if self.number == 1 else float(self.total(values))

    def total(self, values):
        """Sum (k,) of all rows (n, k), or of all values (n,), of all processes; with several of them it depends neither
        on who has which row nor on their order (Demmel & Nguyen 2015, IEEE Trans. Comput. 64, 2060: a row is cut into
        whole numbers of fixed places, which add up exactly)."""
        if self.number == 1:
            return arrays.total(values)
        unit = np.exp2(np.ceil(np.log2(self.most(np.abs(values).max(axis=0, initial=TINY)))) - BITS)
        left, told = values / unit, 0.0
        for part in range(PARTS):
            whole = np.rint(left)
            told = told + self._reduced(whole.astype(np.int64).sum(axis=0), "SUM") * unit * 2.0 ** (-BITS * part)
            left = (left - whole) * 2.0**BITS
        return told

    def ends(self, count: int) -> tuple[int, int]:
        """The first of `count` rows that is this process's, and the first after its own, where they are shared out
        evenly in the order of the ranks."""
        return count * self.rank // self.number, count * (self.rank + 1) // self.number

    def before(self, count: int) -> int:
        """Sum of the counts of the processes before this one."""
        return sum(self.everywhere(count)[: self.rank])

    def told(self, value):
        """The value that the chief has."""
        return self.comm.bcast(value) if self.comm else value

    def gather(self, value) -> list | None:
        """Values of all processes, at the chief; None elsewhere."""
        return self.comm.gather(value) if self.comm else [value]

    def everywhere(self, value) -> list:
        """Values of all processes."""
        return self.comm.allgather(value) if self.comm else [value]

    def exchange(self, parts: list) -> list:
        """Give each process its part; what each of them had for this one."""
        return self.comm.alltoall(parts) if self.comm else parts

    def _reduced(self, values, how: str):
        if self.number == 1:
            return values
        from mpi4py import MPI

        given = np.asarray(values)
        out = np.empty_like(given)
        self.comm.Allreduce(given, out, getattr(MPI, how))
        return out if given.ndim else out.item()


ALONE = World()


@functools.cache
def here() -> World:
    """The world of this process."""
    if MARK not in os.environ:
        return ALONE
    from mpi4py import MPI

    return World(MPI.COMM_WORLD)
