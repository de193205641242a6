"""Rows measured of a scene, one a rung: observed orders, the change between two, and the cheapest that holds an
error. `sdph.study.cost.errors` judges them."""

from __future__ import annotations

import itertools
import json
import math
from pathlib import Path

from sdph.running import output
from sdph.schema import CaseError
from sdph.study.cost.converged import order
from sdph.study.cost.ladder import ALL, Ladder

OWN = "sdph"  # in the column `solver`
FLOOR = 1e-12  # of a metric's scale: changes below it are round-off
COLUMNS = {"solver", "without", "metrics", "wall_s", "measured"}  # that a table must have


def read(file: Path) -> list[dict]:
    """Rows measured so far; `CaseError` where another version of sdph wrote the table."""
    if not file.is_file():
        return []
    table = output.read_table(file, mend="remove it and measure again")
    if lacks := COLUMNS - table.keys():
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
    """True where a row has a wall time, and metrics as `found` takes them."""
    try:
        float(row["wall_s"])
        return all(len(value) == 3 for value in found(row).values())
    except (ValueError, TypeError, AttributeError):
        return False


def has(row: dict, settings: dict) -> bool:
    """True where a row was measured with these settings."""
    return all(str(row.get(key)) == str(value) for key, value in settings.items())


def found(row: dict) -> dict:
    """Metrics of a row: name -> (value, reference or None, scale or None)."""
    return json.loads(row["metrics"])


def of_metric(rows: list[dict], name: str) -> list[dict]:
    """The rows with one of their metrics alone."""
    return [row | {"metrics": json.dumps({key: own for key, own in found(row).items() if key == name})} for row in rows]


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


def distance(a: dict, b: dict) -> float:
    """Largest difference of two rows' metrics over their scale, or without one over the first's; a run that was stopped
    shares nothing with one that was not."""
    one, other = found(a), found(b)
    pairs = ((one[name], other[name][0]) for name in one.keys() & other.keys())
    return max(
        (share(abs(value - changed), scale or value or changed) for (value, _, scale), changed in pairs), default=1.0
    )


def share(change: float, scale: float) -> float:
    """A change over its scale; of what is 0 itself it is a whole one without bound."""
    return change / abs(scale) if scale else math.copysign(math.inf, change) if change else 0.0


def whole(rows: list[dict], solver: str = OWN) -> list[dict]:
    """A solver's rows with all effects."""
    return [row for row in rows if row["solver"] == solver and row["without"] == ALL]


def cheapest(rows: list[dict], accuracy: float, solver: str = OWN) -> dict | None:
    """The row that takes least time among those with all effects that err by `accuracy` at most, as do all finer."""
    held = (row for row in whole(rows, solver) if row["bound"] <= accuracy)
    return min(held, key=lambda row: row["wall_s"], default=None)


def front(rows: list[dict]) -> list[dict]:
    """Rows that nothing beats in both bound of the error and time, by time."""
    kept, least = [], math.inf
    for row in sorted(whole(rows), key=lambda row: (row["wall_s"], row["bound"])):
        if row["bound"] < least:
            kept.append(row)
            least = row["bound"]
    return kept
