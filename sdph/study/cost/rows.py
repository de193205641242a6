"""What was measured of a scene, a row a rung: errors, observed orders, and the cheapest that holds an error."""

from __future__ import annotations

import itertools
import json
import math
from pathlib import Path

from sdph.running import output
from sdph.schema import CaseError
from sdph.study.cost.ladder import ALL, Ladder

OWN = "sdph"  # in the column `solver`
FLOOR = 1e-12  # of a metric's scale: changes below it are round-off


def read(file: Path) -> list[dict]:
    """Rows measured so far; `CaseError` where another version of sdph wrote the table."""
    if not file.is_file():
        return []
    table = output.read_table(file, mend="remove it and measure again")
    if lacks := {"solver", "without", "metrics", "wall_s"} - table.keys():
        raise CaseError(
            f"{file} lacks the columns {', '.join(sorted(lacks))}: another version of sdph wrote it; remove it and "
            "measure again"
        )
    rows = [dict(zip(table, values)) for values in zip(*table.values())]
    for number, row in enumerate(rows, 1):
        if not _measured(row):
            raise CaseError(f"{file} is damaged (row {number} lacks wall time or metrics); remove it and measure again")
    return rows


def _measured(row: dict) -> bool:
    """Whether a row has a wall time, and metrics as `found` takes them."""
    try:
        float(row["wall_s"])
        return all(len(value) == 3 for value in found(row).values())
    except (ValueError, TypeError, AttributeError):
        return False


def has(row: dict, settings: dict) -> bool:
    """Whether a row was measured with these settings."""
    return all(str(row[key]) == str(value) for key, value in settings.items())


def errors(rows: list[dict]) -> list[dict]:
    """The rows with `error`: the largest of |value - reference|/scale. Where a metric has no reference it is the limit
    of the same solver's own ladder, and no error is smaller than the doubt about that limit."""
    levels = {
        solver: [found(row) for row in rows if row["solver"] == solver and _level(row)]
        for solver in {row["solver"] for row in rows}
    }
    limits = {solver: richardson(values) for solver, values in levels.items()}
    return [row | {"error": max(_errors(found(row), limits[row["solver"]]).values(), default=math.inf)} for row in rows]


def found(row: dict) -> dict:
    """Metrics of a row: name -> (value, reference or None, scale or None)."""
    return json.loads(row["metrics"])


def _level(row: dict) -> bool:
    return str(row["label"]).startswith("all ")


def _errors(values: dict, limits: dict) -> dict:
    found = {}
    for name, (value, given, scale) in values.items():
        reference, doubt = limits[name] if given is None else (given, 0.0)
        found[name] = _share(max(abs(value - reference), doubt), reference if scale is None else scale)
    return found


def _share(change: float, scale: float) -> float:
    """A change of what is 0 itself is a whole one without bound."""
    return change / abs(scale) if scale else math.inf if change else 0.0


def richardson(levels: list[dict]) -> dict[str, tuple[float, float]]:
    """Limit of each metric as all knobs are refined together in one ratio, and the doubt about it: by the observed
    order, in doubt by what that adds to the finest; where there is no order the finest itself, in doubt by its last
    change."""
    return {name: _limit([level[name][0] for level in levels[-3:]]) for name in (levels[-1] if levels else ())}


def _limit(values: list[float]) -> tuple[float, float]:
    if len(values) == 3 and (values[1] - values[0]) * (values[2] - values[1]) > 0.0:
        ratio = (values[1] - values[0]) / (values[2] - values[1])
        if ratio > 1.0:
            more = (values[2] - values[1]) / (ratio - 1.0)
            return values[2] + more, abs(more)
    return values[-1], abs(values[-1] - values[max(-2, -len(values))])


def orders(own: Ladder, rows: list[dict]) -> dict[str, float]:
    """Observed order of the metrics' change with each numeric knob alone, the others in the middle. Three values of the
    knob are needed, in one ratio or not: the order is that of a power law through both changes."""
    orders = {}
    for key, values in own.knobs.items():
        line = [next((r for r in rows if has(r, own.middle | {key: value})), None) for value in values[-3:]]
        if len(line) == 3 and all(line) and all(isinstance(v, (int, float)) for v in values):
            changes = [distance(a, b) for a, b in itertools.pairwise(line)]
            if min(changes) > FLOOR:
                orders[key] = order(*values[-3:], *changes)
    return {key: found for key, found in orders.items() if not math.isnan(found)}


def order(coarse: float, middle: float, fine: float, first: float, second: float) -> float:
    """p of changes `first` and `second` between three steps, (coarse^p - middle^p)/(middle^p - fine^p) = first/second;
    by bisection in -10..10, nan where no power fits."""

    def excess(p: float) -> float:
        return (coarse**p - middle**p) / (middle**p - fine**p) - first / second

    low, high = -10.0, 10.0
    if excess(low) * excess(high) > 0.0:
        return math.nan
    for _ in range(60):
        p = 0.5 * (low + high) or 1e-9  # at 0 both changes vanish
        low, high = (p, high) if excess(p) * excess(high) <= 0.0 else (low, p)
    return 0.5 * (low + high)


def distance(a: dict, b: dict) -> float:
    """Largest difference of two rows' metrics over their scale, or without one over the first's; a run that was stopped
    shares nothing with one that was not."""
    one, other = found(a), found(b)
    pairs = ((one[name], other[name][0]) for name in one.keys() & other.keys())
    return max(
        (_share(abs(value - changed), scale or value or changed) for (value, _, scale), changed in pairs), default=1.0
    )


def whole(rows: list[dict]) -> list[dict]:
    """Our own rows with all effects."""
    return [row for row in rows if row["solver"] == OWN and row["without"] == ALL]


def cheapest(rows: list[dict], accuracy: float) -> dict | None:
    """The row that takes least time among those with all effects whose error is at most `accuracy`."""
    return min((row for row in whole(rows) if row["error"] <= accuracy), key=lambda row: row["wall_s"], default=None)


def front(rows: list[dict]) -> list[dict]:
    """Rows that nothing beats in both error and time, by time."""
    kept, least = [], math.inf
    for row in sorted(whole(rows), key=lambda row: (row["wall_s"], row["error"])):
        if row["error"] < least:
            kept.append(row)
            least = row["error"]
    return kept
