"""Errors: how far each row is from the converged value of its ladder, and what may be promised of it.

A metric's share is (value - reference)/scale, or without a reference value/limit. The limit of the levels' shares is
`sdph.study.cost.converged.limit`; where the reference is exact and the scheme consistent it is 0, and what is left
beyond the doubt is a difference between model and reference, which no refinement closes.

    error  |share - limit| of a level; of a row beside the levels |share - share of the middle| + error of the middle
    bound  the largest error of the row's level and of all finer ones (+ what moves the row from the middle) + doubt

Thus a level that is near the limit, or near the reference, by a crossing has the errors of what is finer; and a row
in which one key alone is changed cannot make good the errors of the others.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from sdph.study.cost.converged import Limit, limit
from sdph.study.cost.ladder import ALL, Ladder
from sdph.study.cost.rows import OWN, found, has, share

TOLD = (
    1e-3  # of the scale: a difference from the reference below a tenth of the smallest accuracy asked for; our choice
)


class Converged(NamedTuple):
    """A metric's shares at the levels, their limit, and whether they are taken from a reference."""

    shares: list[float]
    limit: Limit
    scale: float
    referred: bool

    def tail(self, level: int) -> float:
        """Largest error of this level and of all finer ones."""
        return max(gap(value, self.limit.value) for value in self.shares[level:])

    def of(self, entry: tuple) -> float:
        """Share of another row's metric (value, reference or None, scale or None)."""
        value, reference, scale = entry
        if not self.referred:
            return share(value, self.scale)
        return share(value - reference, reference if scale is None else scale)

    @property
    def own(self) -> float:
        """The limit in the metric's own unit, with its sign; nan of one that is told as a share of a reference."""
        return math.nan if self.referred else self.limit.value * abs(self.scale)

    @property
    def off(self) -> float:
        """Distance of the limit from the reference, where that is beyond the doubt and worth telling; else 0."""
        apart = abs(self.limit.value)
        return apart if self.referred and apart > max(self.limit.doubt, TOLD) else 0.0


def levels(own: Ladder, rows: list[dict], solver: str = OWN) -> tuple[list[float], list[dict]]:
    """Steps and rows of a solver's levels that were measured to their end, coarse to fine; another solver's steps are
    halved."""
    theirs = [row for row in rows if row["solver"] == solver]
    wanted = [(own.level(n), own.steps[n]) for n in range(own.count)]
    line = [(step, row) for settings, step in wanted for row in theirs if has(row, settings)]
    if solver != OWN:
        line = [(0.5**n, row) for n, row in enumerate(theirs)]
    line = [(step, row) for step, row in line if found(row)]
    return [step for step, _ in line], [row for _, row in line]


def converged(own: Ladder, rows: list[dict], solver: str = OWN) -> dict[str, Converged]:
    """Metric -> its convergence over the levels of a solver."""
    steps, line = levels(own, rows, solver)
    entries = [found(row) for row in line]
    names = set.intersection(*map(set, entries)) if entries else set()
    return {name: _metric(steps, [entry[name] for entry in entries]) for name in sorted(names)}


def _metric(steps: list[float], entries: list[tuple]) -> Converged:
    referred = entries[-1][1] is not None
    scale = math.nan if referred else entries[-1][2] or limit(steps, [value for value, *_ in entries]).value
    blank = Converged([], Limit(math.nan, math.inf, math.nan), scale, referred)
    shares = [blank.of(entry) for entry in entries]
    return blank._replace(shares=shares, limit=limit(steps, shares))


def gap(a: float, b: float) -> float:
    """|a - b|; without end where one of them is."""
    return abs(a - b) if math.isfinite(a) and math.isfinite(b) else math.inf


def judged(own: Ladder, rows: list[dict]) -> list[dict]:
    """The rows with `error`, `bound` and `off reference` (nan without one), each of the worst metric."""
    known = {solver: converged(own, rows, solver) for solver in {row["solver"] for row in rows}}
    lines = {solver: levels(own, rows, solver)[1] for solver in known}
    return [row | _judged(own, row, known[row["solver"]], lines[row["solver"]]) for row in rows]


def _judged(own: Ladder, row: dict, metrics: dict[str, Converged], line: list[dict]) -> dict:
    place = next((n for n, level in enumerate(line) if level is row), None)
    middle = next((n for n, level in enumerate(line) if has(level, own.middle)), None)
    known = [(entry, metrics[name]) for name, entry in found(row).items() if name in metrics]
    pairs = [_errors(entry, metric, row, place, middle) for entry, metric in known]
    apart = [abs(metric.of(entry)) for entry, metric in known if metric.referred]
    return {
        "error": max((error for error, _ in pairs), default=math.inf),
        "bound": max((bound for _, bound in pairs), default=math.inf),
        "off reference": max(apart, default=math.nan),
    }


def _errors(entry: tuple, own: Converged, row: dict, place: int | None, middle: int | None) -> tuple[float, float]:
    """(error, bound) of one metric of a row; nothing is promised where an effect is left out."""
    if row["without"] != ALL and row["solver"] == OWN:
        return gap(own.of(entry), own.limit.value), math.inf
    if place is None and middle is None:
        return math.inf, math.inf
    level = middle if place is None else place
    moved = gap(own.of(entry), own.shares[level])
    return moved + gap(own.shares[level], own.limit.value), moved + own.tail(level) + own.limit.doubt


def refusal(own: Ladder, rows: list[dict], accuracy: float) -> str:
    """Say why nothing measured holds `accuracy`, in a line; `rows` as `judged` gives them."""
    known = converged(own, rows)
    if not known:
        return "no level of its ladder has been measured"
    name, worst = max(known.items(), key=lambda item: item[1].limit.doubt)
    if worst.limit.doubt > accuracy:
        doubt = f"by {percent(worst.limit.doubt)}" if math.isfinite(worst.limit.doubt) else "without bound"
        why = f" ({worst.limit.why})" if worst.limit.why else ""
        return f"not shown to converge to {100 * accuracy:g} %: the limit of {name} is in doubt {doubt}{why}"
    finest = levels(own, rows)[1][-1]
    return f"not shown to converge to {100 * accuracy:g} %: the finest level errs by up to {percent(finest['bound'])}"


def percent(share: float) -> str:
    """A share per cent, to two digits, of more than all to three; - for what is not told."""
    return f"{100 * share:.{3 if abs(share) >= 1.0 else 2}g} %" if math.isfinite(share) else "-"


def model_difference(own: Ladder, rows: list[dict]) -> str:
    """The metric whose limit is furthest off its reference beyond the doubt, in a line; empty where none is."""
    known = converged(own, rows)
    name = max(known, key=lambda name: known[name].off, default=None)
    if name is None or not known[name].off:
        return ""
    value, doubt = known[name].limit[:2]
    return (
        f"{name} converges to {100 * value:+.2g} % off the reference (doubt {100 * doubt:.2g} %): a difference of "
        "model and reference, which no setting closes"
    )
