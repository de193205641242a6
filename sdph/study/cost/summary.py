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
HEAD = ("scene (figure)", "metric", *(f"{100 * limit:g} %" for limit in LIMITS), "doubt about the limit", "order",
        "limit off the reference", "reference", "measured", "other solvers, same machine")  # fmt: skip


def table(folder: Path) -> list[str]:
    """Lines of the table in Markdown, one for each metric of each scene of `folder`/<scene>/cost.csv."""
    known = {scene: rows for scene in with_ladder() if (rows := _known(folder, scene))}
    return _markdown(HEAD, [line for scene, measured in known.items() for line in _lines(scene, *measured)])


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
    value, doubt, order = metric.limit[:3]
    own = "" if metric.referred else f"{metric.own:.4g}"
    off = errors.percent(value) if metric.referred else ""
    return [name, own, off, errors.percent(doubt), "-" if math.isnan(order) else f"{order:.1f}"]


def _rung(own: Ladder, row: dict) -> list[str]:
    """A level by its first knob, others by what they differ in from the middle."""
    level = str(row["label"]).startswith("all ")
    keys = own.keys[:1] if level else [key for key in own.keys if str(row[key]) != str(own.middle[key])]
    settings = "" if row["solver"] != OWN else " ".join(f"{key} = {row[key]}" for key in keys)
    who = row["label"] if level or row["without"] != ALL else "alone"
    numbers = (errors.percent(row[name]) for name in ("off reference", "error", "bound"))
    where = who if row["solver"] == OWN else f"{row['solver']}, {who}"
    return [where, settings, *numbers, f"{row['wall_s']:.2g} s", f"{row['load']:g}"]


def _lines(scene: str, own: Ladder, rows: list[dict]) -> list[list[str]]:
    """Cells of a scene: what each metric costs; scene, reference and date stand in its first line."""
    about = f"[`{scene}`](../validation/{scene}/cost.png)", own.reference, min(str(row["measured"]) for row in rows)
    found = []
    for name, metric in errors.converged(own, rows).items():
        judged = errors.judged(own, measured_rows.of_metric(rows, name))
        place, reference, measured = ("", "", "") if found else about
        _, doubt, order = metric.limit[:3]
        converges = errors.percent(doubt), "-" if math.isnan(order) else f"{order:.1f}", _off(metric)
        found.append([place, name, *_prices(judged), *converges, reference, measured, _others(judged)])
    return found


def _prices(judged: list[dict], solver: str = OWN) -> list[str]:
    best = (measured_rows.cheapest(judged, limit, solver) for limit in LIMITS)
    return [f"{row['wall_s']:.2g} s" if row else "-" for row in best]


def _off(metric: errors.Converged) -> str:
    if metric.off:
        return errors.percent(metric.off)
    return "within the doubt" if metric.referred else ""


def _others(judged: list[dict]) -> str:
    """Solver, and what the same errors cost by it."""
    solvers = sorted({row["solver"] for row in judged} - {OWN})
    return "; ".join(f"{solver} {', '.join(_prices(judged, solver))}" for solver in solvers)
