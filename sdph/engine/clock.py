"""The moments of a run: when it writes, when it ends, and into which parts the time to the next of these is cut."""

from __future__ import annotations

import math

import numpy as np

from sdph.laws.constants import ROUND_OFF

# of a multiple of an interval: 12 x 0.05 is 0.6 then, as whoever wrote the end time meant it; a float holds as many
DIGITS = 15
SAMPLES = 10  # rows of history.csv for each output of fields, where a liquid or solid says nothing; our choice
WHOLE = 1.0 - 1e-9  # of a limit: a part that is longer than it by round-off is allowed


class Stalled(RuntimeError):
    """A run whose windows or steps have become so short that it gets nowhere."""


class Clock:
    """Landmarks of a run [s]: outputs of fields, rows of the history every `rows` [s], `run.report_at`, the time from
    which means are taken, times at which something else `turns`, the end.

    A landmark within round-off of now is now. `shortest` [s] is the least that a window or step may be long; `limit`
    names what ruled the last one.
    """

    KEPT = ("limit",)  # see sdph.engine.restart

    def __init__(self, run, rows: float | None = None, turns=()):
        self.limit, self.end = "", run.end_time
        self.outputs = every(run.output_interval, run.end_time)
        self.shortest = ROUND_OFF * float(np.diff(self.outputs, prepend=0.0).max())
        regular = every(rows, run.end_time) if rows else ()
        others = *regular, *run.report_at, *(time for time in (run.average_from, *turns) if time > self.shortest)
        self.landmarks = with_others(self.outputs, others, self.shortest)

    def next(self, time: float) -> float:
        """The next landmark [s]."""
        return float(self.landmarks[np.searchsorted(self.landmarks, time + self.shortest, side="right")])

    def part(self, time: float, longest: float, cause: str) -> float:
        """End [s] of the first of equal parts, no longer than `longest` [s], of the way to the next landmark."""
        landmark = self.next(time)
        parts = count_of_parts(landmark - time, longest, self.shortest, cause)
        return landmark if parts == 1 else time + (landmark - time) / parts

    def parts(self, longest: float, end: float) -> int:
        """Number of all parts, no longer than `longest` [s], from the start to an `end` [s]."""
        gaps = np.diff([0.0, *self.landmarks[self.landmarks < end - self.shortest], end])
        return sum(count_of_parts(gap, longest, 0.0, "the step") for gap in gaps)

    def over(self, time: float) -> bool:
        """Tell whether the end is reached."""
        return time > self.end - self.shortest

    def writes(self, time: float) -> bool:
        """Tell whether fields are written now."""
        return self._among(self.outputs, time)

    def rows_at(self, time: float) -> bool:
        """Tell whether the history has a row of now."""
        return self._among(self.landmarks, time)

    def _among(self, moments: np.ndarray, time: float) -> bool:
        return bool(np.abs(moments - time).min() <= self.shortest)


def alone(case) -> Clock:
    """The clock of a case without a gas, which stops at each row of its history."""
    rows = getattr(case, case.matters[0]).history_interval
    return Clock(case.run, rows or case.run.output_interval / SAMPLES)


def count_of_parts(length: float, longest: float, shortest: float, cause: str) -> int:
    """Number of equal parts, each no longer than `longest`, of a `length` [s]; `Stalled` where `longest` is below
    `shortest`."""
    if not longest >= shortest:
        raise Stalled(
            f"the run gets nowhere: {cause} asks for {longest:.2g} s at a time, and less than {shortest:.2g} s (1e-9 "
            "of the longest time "
            "between two outputs) is not taken; raise that limit, or look for what has become so fast"
        )
    return max(1, math.ceil(length / longest * WHOLE))


def every(interval: float, end: float) -> np.ndarray:
    """Multiples of the interval [s] up to the end, and the end."""
    count = math.ceil(end / interval * WHOLE)
    return np.array([*(float(f"{n * interval:.{DIGITS}g}") for n in range(1, count)), end])


def with_others(times: np.ndarray, others, same: float) -> np.ndarray:
    """The times [s], and those of the others before their end that are further than `same` [s] from each of them."""
    apart = [t for t in others if t < times[-1] and np.abs(times - t).min() > same]
    return np.union1d(times, apart)
