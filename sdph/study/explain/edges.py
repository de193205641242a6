"""Numbers beside the edges that they are judged by: with so many digits that a reader sees on which side they are."""

from __future__ import annotations

import math

SHOWN, ALL = 3, 17  # digits of a number in tables, and of a double
EDGES = ("least", "most", "threshold")  # columns of tables that hold edges


def digits(value: float, *edges: float) -> int:
    """Digits by which a value reads otherwise than each edge that is another number; SHOWN at least."""
    others = [edge for edge in edges if edge != value]
    apart = (n for n in range(SHOWN, ALL) if all(f"{value:.{n}g}" != f"{edge:.{n}g}" for edge in others))
    return next(apart, ALL)


def outside(row: dict) -> str:
    """Words on a row of ratios that is not safe."""
    value, least, most = (row[name] for name in ("value", "least", "most"))
    n = digits(value, least, most)
    upto = f"to {most:.{n}g}" if most < math.inf else "on"
    return f"{row['ratio']} = {value:.{n}g}, safe from {least:.{n}g} {upto}: {row['why']}"


def unsafe(rows: list[dict]) -> list[str]:
    """`outside` of all rows that say NO."""
    return [outside(row) for row in rows if row["safe"] == "NO"]


def shown(row: dict) -> dict:
    """A row of a table with its value and edges as texts, where they would read alike and are not."""
    value, edges = row.get("value"), {name: row[name] for name in EDGES if name in row}
    if not edges or not isinstance(value, float) or (n := digits(value, *edges.values())) == SHOWN:
        return row
    return row | {name: f"{number:.{n}g}" for name, number in ({"value": value} | edges).items()}
