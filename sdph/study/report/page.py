"""The page: parts in the order in which they are read. What it shows, curves, references, balances, time, settings."""

from __future__ import annotations

import contextlib
import html
import tempfile
from pathlib import Path

import numpy as np

from sdph.case import read as cases
from sdph.running import openings, output, vessel
from sdph.running.limiters import LARGEST
from sdph.scenes import paths
from sdph.schema import CaseError, flat
from sdph.show import frames
from sdph.study import steadiness
from sdph.study.report import bars, curves, glance
from sdph.study.report.shown import Shown, folded, opened, picture, section, side_by_side, table, told_apart

PAGE = (
    '<!doctype html><html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, '
    'initial-scale=1"><title>{title}</title><style>{style}</style></head><body>{body}<script>{script}</script>'
    "</body></html>\n"
)
SCRIPT = """
for (const [event, open] of [['beforeprint', true], ['afterprint', false]])
  addEventListener(event, () => document.querySelectorAll('details').forEach(part => part.open = open));
"""


def write(folders: list[Path], target: Path) -> Path:
    """The report of one or several runs; `target` is a new file, or one that is written over."""
    if target.exists() and not target.is_file():  # a folder, or a device, which would be replaced
        raise CaseError(f"{target} is no file that a report could be written to; give another --out")
    runs = told_apart([opened(Path(folder)) for folder in folders])
    title = " and ".join(dict.fromkeys(run.case.title or run.name for run in runs))
    parts = [f"<h1>{html.escape(title)}</h1>", glance.shown(runs), curves.curves(runs), curves.profiles(runs)]
    parts += [
        bars.checks(runs),
        _steadiness(runs),
        _views(runs),
        _pictures(runs),
        bars.closures(runs),
        bars.times(runs),
        _results(runs),
    ]
    parts += [_limiters(runs), _effects(runs), _settings(runs), _versions(runs)]
    style = (paths.PACKAGE / "study" / "report" / "style.css").read_text(encoding="utf-8")
    page = PAGE.format(title=html.escape(title), style=style, body="\n".join(parts), script=SCRIPT)
    output.write_text(target, page)
    return target


def _steadiness(runs: list[Shown]) -> str:
    """Means over the last quarter of runs through whose openings gas goes, and whether they still change."""
    parts = []
    for run in (run for run in runs if openings.names(run.case)):
        rows = [row for row in steadiness.rows(run.history) if not row["column"].startswith("particle_")]
        if not rows:
            continue
        moving = ", ".join(row["column"] for row in rows if not row["steady"])
        said = f"these still change: {moving}" if moving else "all curves are steady"
        numbers = table([*rows[0]], [list(row.values()) for row in rows])
        parts += [f"<p><b>{html.escape(run.name)}</b>: {said}.</p>", folded("means of the last quarter", numbers)]
    return section("Is it steady?", "".join(parts))


def _views(runs: list[Shown]) -> str:
    views = [(run.name, frames.viewer(run.folder, run.case)) for run in runs]
    return section("Fields", "".join(f"<h3>{html.escape(name)}</h3>{text}" for name, text in views if text))


def _pictures(runs: list[Shown]) -> str:
    """Pictures that comparisons, and who runs them, left in the folders."""
    files = [path for run in runs for path in sorted(run.folder.glob("*.png")) if path.is_file()]
    return section("Figures", "".join(f"<p>{picture(path.read_bytes(), path.name)}</p>" for path in files))


def _results(runs: list[Shown]) -> str:
    numbers = [
        {k: v for k, v in run.summary.items() if not k.startswith(("wall_", LARGEST)) and not k.endswith("_per_window")}
        for run in runs
    ]
    body = side_by_side(runs, numbers) if any(numbers) else ""
    return section("Results", folded("all numbers of the summary", body))


def _limiters(runs: list[Shown]) -> str:
    """Section of the largest that limiters held in a window (docs/limiters.md)."""
    held = [{k.removeprefix(LARGEST): v for k, v in run.summary.items() if k.startswith(LARGEST)} for run in runs]
    body = side_by_side(runs, held) if any(held) else ""
    return section("Limiters: the largest of all windows", folded("numbers", body))


def _effects(runs: list[Shown]) -> str:
    """Effects of each run with the reasons for them."""
    from sdph.study.explain import tables

    parts = []
    for run in runs:
        rows = tables.effect_rows(_in_its_vessel(run))
        rows = [row for row in rows if row["effect"] in run.case.effects or row["called for"] == "yes"]
        head = f"<p><b>{html.escape(run.name)}</b>: {glance.state(run)}</p>"
        parts.append(head + (table(list(rows[0]), [list(row.values()) for row in rows]) if rows else ""))
    return section("What was run", folded("effects and the reasons for them", "".join(parts)))


def _in_its_vessel(run: Shown):
    """The case of a run with its openings where the mesh of its gas has them, as `sdph explain` judges it."""
    with tempfile.TemporaryDirectory() as folder, contextlib.suppress(CaseError):  # the mesh may be gone or damaged
        return vessel.foreseen(run.case, run.folder / "gas", Path(folder))
    return run.case


def _settings(runs: list[Shown]) -> str:
    """Keys that differ between runs, and every key of the resolved cases; its unit is the end of its name."""
    tables = [{key: _short(value) for key, value in flat(cases.to_table(run.case)).items()} for run in runs]
    keys = dict.fromkeys(key for own in tables for key in own)
    differ = {key for key in keys if len({str(own.get(key, "")) for own in tables}) > 1}
    body = ""
    if len(runs) > 1:
        own = [{key: value for key, value in own.items() if key in differ} for own in tables]
        body = side_by_side(runs, own) if differ else "<p>No key differs.</p>"
    return section("Settings", body + folded("every key", side_by_side(runs, tables)))


def _short(value):
    return ", ".join(map(str, value)) if isinstance(value, (list, np.ndarray)) else value


def _versions(runs: list[Shown]) -> str:
    rows = [
        run.origin.get("versions", {}) | {k: run.origin[k] for k in ("machine", "cores") if k in run.origin}
        for run in runs
    ]
    command = [
        {"command": " ".join(["sdph", *run.origin["command"][1:]])} if "command" in run.origin else {} for run in runs
    ]
    return section("Versions", side_by_side(runs, [a | b for a, b in zip(rows, command)]))
