"""The table of all measured scenes, what an accuracy costs, or what doubt forbids to promise it; and what was measured
of one scene. `python validation/cost_table.py` writes them into docs/cost.md and validation/<scene>/README.md."""

from __future__ import annotations

import math
from pathlib import Path

from sdph.study.cost import errors
from sdph.study.cost import rows as measured_rows
from sdph.study.cost.ladder import ALL, Ladder, declared, with_ladder
from sdph.study.cost.report import LIMITS
from sdph.study.cost.rows import OWN

COLUMNS = "rung", "with", "off the reference", "off the limit", "at most, with all finer", "time", "load"
LIMITED = "metric", "limit", "off the reference", "doubt about the limit", "order"
HEAD = ("scene (figure)", "reference", *(f"{100 * limit:g} %" for limit in LIMITS),
        "doubt about the limit", "limit off the reference", "measured", "other solvers, same machine")  # fmt: skip


def table(folder: Path) -> list[str]:
    """Lines of the table in Markdown, a scene of `folder`/<scene>/cost.csv each."""
    return _markdown(HEAD, [_cells(scene, *known) for scene in with_ladder() if (known := _known(folder, scene))])


def section(folder: Path, scene: str) -> list[str]:
    """Lines of what was measured of a scene: limits of its metrics, then its rungs."""
    own, rows = _known(folder, scene)
    limits = _markdown(LIMITED, [_limited(name, metric) for name, metric in errors.converged(own, rows).items()])
    return [*limits, "", *_markdown(COLUMNS, [_rung(own, row) for row in rows])]


def _known(folder: Path, scene: str) -> tuple[Ladder, list[dict]] | None:
    own, file = declared(scene), folder / scene / "cost.csv"
    return (own, errors.judged(own, measured_rows.read(file))) if file.is_file() else None


def _markdown(head: tuple[str, ...], rows: list[list[str]]) -> list[str]:
    return ["| " + " | ".join(head) + " |", "|" + "--|" * len(head), *(f"| {' | '.join(row)} |" for row in rows)]


def _limited(name: str, metric: errors.Converged) -> list[str]:
    value, doubt, order = metric.limit
    own = "" if metric.referred else f"{value * metric.scale:.4g}"
    off = percent(value) if metric.referred else ""
    return [name, own, off, percent(doubt), "-" if math.isnan(order) else f"{order:.1f}"]


def _rung(own: Ladder, row: dict) -> list[str]:
    """A level by its first knob, others by what they differ in from the middle."""
    level = str(row["label"]).startswith("all ")
    keys = own.keys[:1] if level else [key for key in own.keys if str(row[key]) != str(own.middle[key])]
    settings = "" if row["solver"] != OWN else " ".join(f"{key} = {row[key]}" for key in keys)
    who = row["label"] if level or row["without"] != ALL else "alone"
    numbers = (percent(row[name]) for name in ("off reference", "error", "bound"))
    where = who if row["solver"] == OWN else f"{row['solver']}, {who}"
    return [where, settings, *numbers, f"{row['wall_s']:.2g} s", f"{row['load']:g}"]


def _cells(scene: str, own: Ladder, rows: list[dict]) -> list[str]:
    best = [measured_rows.cheapest(rows, limit) for limit in LIMITS]
    known = errors.converged(own, rows)
    name, worst = max(known.items(), key=lambda item: item[1].limit.doubt)
    return [
        f"[`{scene}`](../validation/{scene}/cost.png)",
        own.reference,
        *(f"{row['wall_s']:.2g} s" if row else "-" for row in best),
        f"{percent(worst.limit.doubt)} ({name})",
        _off(known),
        min(str(row["measured"]) for row in rows),
        _others(rows),
    ]


def _off(known: dict[str, errors.Converged]) -> str:
    """The metric that is furthest off beyond the doubt."""
    name = max(known, key=lambda name: known[name].off)
    if known[name].off:
        return f"{percent(known[name].off)} ({name})"
    return "within the doubt" if any(metric.referred for metric in known.values()) else ""


def _others(rows: list[dict]) -> str:
    """Solver, its cells, its errors by the same rule, and its times."""
    parts = []
    for solver in sorted({row["solver"] for row in rows} - {OWN}):
        line = [row for row in rows if row["solver"] == solver]
        shown = [f"{row['label'].partition(', ')[2]}: {percent(row['bound'])} in {row['wall_s']:.2g} s" for row in line]
        parts.append(f"{solver} {'; '.join(shown)}")
    return "; ".join(parts)


def percent(share: float) -> str:
    """Two digits; - for what is not told."""
    return f"{100 * share:.2g} %" if math.isfinite(share) else "-"
