"""`sdph report`: what was run and what came of it, one HTML file that needs nothing else and no network."""

from __future__ import annotations

import base64
import html
import io
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from sdph.case import read as cases
from sdph.running import output
from sdph.running.limiters import LARGEST
from sdph.schema import CaseError, flat
from sdph.show import frames

STYLE = """
body { font: 15px/1.45 sans-serif; margin: 2em auto; max-width: 1200px; padding: 0 1em; color: #222 }
table { border-collapse: collapse; margin: 0.5em 0 1.5em }
td, th { padding: 0.15em 0.9em 0.15em 0; text-align: left; border-bottom: 1px solid #ddd }
td.number { text-align: right; font-variant-numeric: tabular-nums } .failed { color: #b00 }
img, canvas { max-width: 100% } h2 { margin-top: 1.6em }
canvas { border: 1px solid #ccc; touch-action: none }
"""
PAGE = (
    '<!doctype html><html lang="en"><head><meta '
    'charset="utf-8"><title>{title}</title><style>{style}</style></head><body>{body}</body></html>\n'
)
CLOSURE = (
    "mass_drift_rel",
    "energy_drift_rel",
    "motion_drift_rel",
    "numerical_work_rel",
    "exchange_energy_mismatch_rel",
    "exchange_momentum_mismatch_rel",
    "gas_momentum_drift_rel",
    "momentum_drift_rel",
    "energy_made_rel",
    "energy_missing_rel",
)
CHECK = ("name", "value", "reference", "tolerance")  # of a comparison
PLOTS = 6  # curves in one figure


@dataclass(frozen=True)
class Shown:
    """A run as the report sees it, finished or not."""

    folder: Path
    case: cases.Case
    summary: dict
    failure: dict
    origin: dict

    @property
    def name(self) -> str:
        return self.folder.name


def write(folders: list[Path], target: Path) -> Path:
    """The report of one or several runs; `target` is a new file, or one that is written over."""
    if target.exists() and not target.is_file():  # a folder, or a device, which would be replaced
        raise CaseError(f"{target} is no file that a report could be written to; give another --out")
    runs = [_open(Path(folder)) for folder in folders]
    title = " and ".join(dict.fromkeys(run.case.title or run.name for run in runs))
    parts = [f"<h1>{html.escape(title)}</h1>", _what(runs), _results(runs), _figures(runs), _views(runs)]
    parts += [_ledger(runs), _limiters(runs), _walls(runs), _settings(runs), _versions(runs)]
    output.write_text(target, PAGE.format(title=html.escape(title), style=STYLE, body="\n".join(parts)))
    return target


def _open(folder: Path) -> Shown:
    if not (folder / output.MARK).is_file():
        raise CaseError(f"{folder} holds no run (no {output.MARK}); give the folder of a run")
    summary = output.read_summary(folder) if (folder / "summary.json").is_file() else {}
    failure = _json(folder / output.FAILURE, {"what": str, "time_s": (int, float)})
    origin = _json(folder / output.ORIGIN, {"command": list, "versions": dict})
    return Shown(folder, cases.load(folder / output.MARK), summary, failure, origin)


def _json(path: Path, needs: dict) -> dict:
    """A JSON table in which `needs` (key -> type) are as they must be; empty where there is no such file."""
    table = output.read_json(path) if path.is_file() else {}
    for key, kind in needs.items() if table else ():
        if not isinstance(table.get(key), kind):
            raise CaseError(f"{path} is damaged ({key} = {str(table.get(key))[:40]!r}); run it again")
    return table


def _section(title: str, body: str) -> str:
    return f"<h2>{title}</h2>{body}" if body else ""


def _table(head: list, rows: list) -> str:
    """Rows of cells; numbers to the right, with six digits."""
    if not rows:
        return ""
    top = "".join(f"<th>{html.escape(str(cell))}</th>" for cell in head)
    body = "".join(f"<tr>{''.join(map(_cell, row))}</tr>" for row in rows)
    return f"<table><tr>{top}</tr>{body}</table>"


def _cell(value) -> str:
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return f'<td class="number">{value:.6g}</td>'
    return f"<td>{html.escape(str(value))}</td>"


def _side_by_side(runs: list[Shown], tables: list[dict]) -> str:
    """One row a key, one column a run."""
    keys = dict.fromkeys(key for table in tables for key in table)
    return _table(["", *(run.name for run in runs)], [[key, *(table.get(key, "") for table in tables)] for key in keys])


def _what(runs: list[Shown]) -> str:
    """State of each run, and its effects with the reasons for them."""
    from sdph.study.explain import tables

    parts = []
    for run in runs:
        parts.append(f"<p><b>{html.escape(run.name)}</b>: {_state(run)}</p>")
        rows = [r for r in tables.effect_rows(run.case) if r["effect"] in run.case.effects or r["called for"] == "yes"]
        parts.append(_table(list(rows[0]), [list(row.values()) for row in rows]) if rows else "")
    return _section("What was run", "".join(parts))


def _state(run: Shown) -> str:
    if run.failure:
        what, when = html.escape(run.failure["what"]), run.failure["time_s"]
        return f'<span class="failed">failed at t = {when:.6g} s: {what}</span>'
    if run.summary:
        return f"finished at t = {run.summary['time_s']:.6g} s"
    return (
        '<span class="failed">not finished: it is still going on, or was killed; sdph run --resume goes on with '
        "it</span>"
    )


def _results(runs: list[Shown]) -> str:
    numbers = [
        {k: v for k, v in run.summary.items() if not k.startswith(("wall_", LARGEST)) and not k.endswith("_per_window")}
        for run in runs
    ]
    body = _side_by_side(runs, numbers)
    for run in runs:
        for path in sorted(run.folder.glob("compare_*.json")):
            checks = [check for check in _json(path, {"checks": list})["checks"] if isinstance(check, dict)]
            rows = [[*map(check.get, CHECK), "ok" if check.get("ok") else "FAILED"] for check in checks]
            body += f"<h3>{html.escape(run.name)} against {path.stem.removeprefix('compare_')}</h3>"
            body += _table(["check", *CHECK[1:], ""], rows)
    return _section("Results", body)


def _figures(runs: list[Shown]) -> str:
    """Histories of all runs together, and the pictures that comparisons left."""
    pictures = [_histories(runs)]
    files = [path for run in runs for path in sorted(run.folder.glob("*.png")) if path.is_file()]
    pictures += [_picture(path.read_bytes(), path.name) for path in files]
    return _section("Figures", "".join(pictures))


def _picture(data: bytes, name: str) -> str:
    return f'<p><img alt="{html.escape(name)}" src="data:image/png;base64,{base64.b64encode(data).decode()}"></p>'


def _histories(runs: list[Shown]) -> str:
    files = [(run.name, run.folder / "history.csv") for run in runs]
    begun = [(name, file) for name, file in files if file.is_file() and file.stat().st_size]
    tables = [(name, output.read_table(file, output.TEXTS)) for name, file in begun]
    first = tables[0][1] if tables else {}
    columns = [key for key in first if key != "time_s" and first[key].dtype.kind == "f"][:PLOTS]
    if not columns:
        return ""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(
        len(columns), 1, figsize=(9.0, 2.2 * len(columns)), sharex=True, squeeze=False, layout="constrained"
    )
    for axis, column in zip(axes[:, 0], columns):
        for name, table in tables:
            if column in table:
                axis.plot(table["time_s"], table[column], label=_plain(name))
        axis.set_ylabel(_plain(column), fontsize=8)
    axes[0, 0].legend(fontsize=8)
    axes[-1, 0].set_xlabel("time [s]")
    picture = io.BytesIO()
    figure.savefig(picture, dpi=90, format="png")
    pyplot.close(figure)
    return _picture(picture.getvalue(), "history")


def _plain(text: str) -> str:
    """A text that matplotlib takes for no formula, and as a label does not leave out for its first letter."""
    return (" " if text.startswith("_") else "") + text.replace("$", r"\$")


def _views(runs: list[Shown]) -> str:
    views = [(run.name, frames.viewer(run.folder, run.case)) for run in runs]
    return _section("Fields", "".join(f"<h3>{html.escape(name)}</h3>{text}" for name, text in views if text))


def _ledger(runs: list[Shown]) -> str:
    """Section of the closure of the budgets."""
    closures = [{key: run.summary[key] for key in CLOSURE if key in run.summary} for run in runs]
    return _section("Ledger", _side_by_side(runs, closures)) if any(closures) else ""


def _limiters(runs: list[Shown]) -> str:
    """Section of the largest that limiters held in a window (docs/limiters.md)."""
    held = [{k.removeprefix(LARGEST): v for k, v in run.summary.items() if k.startswith(LARGEST)} for run in runs]
    return _section("Limiters: the largest of all windows", _side_by_side(runs, held)) if any(held) else ""


def _walls(runs: list[Shown]) -> str:
    """Section of wall times."""
    rows = [
        {k: v for k, v in run.summary.items() if k.startswith("wall_") or k.endswith(("_per_window", "_per_s"))}
        for run in runs
    ]
    return _section("Where the time went", _side_by_side(runs, rows)) if any(rows) else ""


def _settings(runs: list[Shown]) -> str:
    """Every key of the resolved case; its unit is the end of its name."""
    tables = [{key: _short(value) for key, value in flat(cases.to_table(run.case)).items()} for run in runs]
    return _section("Settings", _side_by_side(runs, tables))


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
    return _section("Versions", _side_by_side(runs, [a | b for a, b in zip(rows, command)]))
