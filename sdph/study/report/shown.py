"""A run as the report sees it, finished or not, and what HTML is made of."""

from __future__ import annotations

import base64
import html
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np

from sdph.case import read as cases
from sdph.engine.table import Found
from sdph.running import output
from sdph.running.limiters import LARGEST
from sdph.schema import CaseError
from sdph.show import style


@dataclass(frozen=True)
class Shown:
    folder: Path
    case: cases.Case
    summary: dict
    failure: dict
    origin: dict
    parts: int = 1  # of its folder's path, as many as tell it from other runs

    @property
    def name(self) -> str:
        return "/".join(self.folder.resolve().parts[-self.parts :])

    @cached_property
    def history(self) -> dict[str, np.ndarray]:
        """Columns of history.csv that hold numbers, without those of limiters; empty where there is none."""
        path = self.folder / "history.csv"
        return Found(path, {k: v for k, v in _columns(path).items() if LARGEST + k not in self.summary})

    @cached_property
    def metrics(self) -> dict[str, np.ndarray]:
        """Columns of metrics.csv."""
        return _columns(self.folder / "metrics.csv")

    def profile(self, name: str) -> dict[str, np.ndarray]:
        """Columns of profile_NAME.csv; empty where there is none."""
        return _columns(self.folder / f"profile_{name}.csv")

    @cached_property
    def comparisons(self) -> dict[str, list[dict]]:
        """Name of a reference -> checks of `sdph compare` against it."""
        found = {}
        for path in sorted(self.folder.glob("compare_*.json")):
            checks = json_of(path, {"checks": list})["checks"]
            found[path.stem.removeprefix("compare_")] = [check for check in checks if isinstance(check, dict)]
        return found


def told_apart(runs: list[Shown]) -> list[Shown]:
    """The same with names that differ, where their folders do."""
    folders = {run.folder.resolve() for run in runs}
    for parts in range(1, max(len(folder.parts) for folder in folders)):
        named = [replace(run, parts=parts) for run in runs]
        if len({run.name for run in named}) == len(folders):
            return named
    return runs


def opened(folder: Path) -> Shown:
    """The run in a folder; `CaseError` where it holds none."""
    if not (folder / output.MARK).is_file():
        raise CaseError(f"{folder} holds no run (no {output.MARK}); give the folder of a run")
    summary = output.read_summary(folder) if (folder / "summary.json").is_file() else {}
    failure = json_of(folder / output.FAILURE, {"what": str, "time_s": (int, float)})
    origin = json_of(folder / output.ORIGIN, {"command": list, "versions": dict})
    return Shown(folder, cases.load(folder / output.MARK), summary, failure, origin)


def _columns(file: Path) -> dict[str, np.ndarray]:
    if not file.is_file() or not file.stat().st_size:
        return {}
    return Found(file, {k: v for k, v in output.read_table(file, output.TEXTS).items() if v.dtype.kind == "f"})


def json_of(path: Path, needs: dict) -> dict:
    """A JSON table in which `needs` (key -> type) are as they must be; empty where there is no such file."""
    table = output.read_json(path) if path.is_file() else {}
    for key, kind in needs.items() if table else ():
        if not isinstance(table.get(key), kind):
            raise CaseError(f"{path} is damaged ({key} = {str(table.get(key))[:40]!r}); run it again")
    return table


def section(title: str, body: str) -> str:
    return f"<section><h2>{title}</h2>{body}</section>" if body else ""


def folded(title: str, body: str) -> str:
    """A part that is opened by a click, and in print."""
    return f"<details><summary>{title}</summary>{body}</details>" if body else ""


def table(head: list, rows: list) -> str:
    """Rows of cells; numbers to the right, with six digits."""
    if not rows:
        return ""
    top = "".join(f"<th>{html.escape(str(cell))}</th>" for cell in head)
    body = "".join(f"<tr>{''.join(map(_cell, row))}</tr>" for row in rows)
    return f'<div class="wide"><table><tr>{top}</tr>{body}</table></div>'


def _cell(value) -> str:
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return f'<td class="number">{value:.6g}</td>'
    mark = ' class="failed"' if value == "FAILED" else ""
    return f"<td{mark}>{html.escape(str(value))}</td>"


def side_by_side(runs: list[Shown], tables: list[dict]) -> str:
    """One row a key, one column a run."""
    keys = dict.fromkeys(key for own in tables for key in own)
    return table(["", *(run.name for run in runs)], [[key, *(own.get(key, "") for own in tables)] for key in keys])


def picture(data: bytes, name: str, kind: str = "png", mark: str = "") -> str:
    """An image in the page itself; `mark` is its class."""
    text = base64.b64encode(data).decode()
    return f'<img class="{mark}" alt="{html.escape(name)}" src="data:image/{kind};base64,{text}">'


UNITS = (  # endings of keys and columns, the longer before the shorter -> unit
    ("_kg_m2_s", "kg/(m² s)"), ("_kg_m_s", "kg m/s"), ("_kg_m3", "kg/m³"), ("_kg_s", "kg/s"), ("_m2_s2", "m²/s²"),
    ("_m_s2", "m/s²"), ("_m_s", "m/s"), ("_Pa_m", "Pa/m"), ("_Pa", "Pa"), ("_Nm", "N m"), ("_N", "N"), ("_J", "J"),
    ("_W", "W"), ("_K", "K"), ("_kg", "kg"), ("_m3", "m³"), ("_m2", "m²"), ("_mm", "mm"), ("_ms", "ms"),
    ("_deg", "°"), ("_m", "m"), ("_s", "s"), ("_share", ""), ("_rel", ""),
)  # fmt: skip


def spoken(key: str) -> tuple[str, str]:
    """(words, unit) of a key or column: bed_height_m is ("bed height", "m")."""
    for ending, unit in UNITS:
        if key.endswith(ending):
            return key.removesuffix(ending).replace("_", " "), unit
    return key.replace("_", " "), ""


def measured(value: float, unit: str) -> str:
    """A number of three digits with its unit, as 20 mm."""
    if unit in style.PREFIXES:
        factor, unit = style.prefixed(unit, abs(value))
        value /= factor
    return f"{style.digits(value)} {unit}".strip()
