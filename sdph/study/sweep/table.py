"""sweep.csv: a row a run, with the values of its keys and all of its summary; and the figure of a metric over a key."""

from __future__ import annotations

import difflib
import math
from pathlib import Path
from typing import NamedTuple

from sdph.case import read as cases
from sdph.running import output
from sdph.schema import CaseError, unknown
from sdph.study.sweep.jobs import FINE, Job

FILE, FIGURE = "sweep.csv", "sweep.png"
HEAD = ("run", "exit_code", "reason")
WIDTH, HEIGHT = 6.4, 3.6  # of a panel [inches]
NEAR = 5  # names that are told beside one that no summary has
SLIP = 0.9  # likeness from which on a word is another one misspelt; our choice


def rows(jobs: list[Job], outcomes: dict[str, dict]) -> list[dict]:
    """A row for each job whose outcome (by name) is known, all of the same columns."""
    found = [_row(job, outcomes[job.name]) for job in jobs if job.name in outcomes]
    columns = list(dict.fromkeys(key for row in found for key in row))
    return [dict.fromkeys(columns, "") | row for row in found]


def _row(job: Job, outcome: dict) -> dict:
    row = {"run": job.name, "exit_code": outcome["exit_code"], "reason": outcome["reason"]}
    row |= _values(job)
    return row | (output.read_summary(Path(job.folder)) if outcome["exit_code"] == FINE else {})


def _values(job: Job) -> dict:
    """Key -> value of a point; an empty text where it leaves the case's own."""
    return {key: cases.value_of(value) if value else "" for key, value in job.point.items()}


def write(folder: Path, jobs: list[Job], outcomes: dict[str, dict]) -> list[dict]:
    """sweep.csv with what is known, and its rows."""
    found = rows(jobs, outcomes)
    if found:
        output.write_rows(folder / FILE, found)
    return found


def read(folder: Path) -> dict[str, dict]:
    """Name of a run -> `exit_code` and `reason` of an earlier call; nothing where there was none."""
    if not (folder / FILE).is_file():
        return {}
    table = output.read_table(folder / FILE, mend="remove it: the runs that are done are known by their folders")
    return {
        str(name): {"exit_code": int(code), "reason": str(reason)}
        for name, code, reason in zip(*(table[key] for key in HEAD))
    }


class Axis(NamedTuple):
    """A varied key that runs are drawn over, by a component of its vectors, or by their length where that is None."""

    key: str
    vector: bool = False
    component: int | None = None

    @property
    def label(self) -> str:
        """Words under the axis."""
        if not self.vector:
            return self.key
        return f"length of {self.key}" if self.component is None else f"{self.key}[{self.component}]"

    def place(self, row: dict) -> float | None:
        """Place of a row along the axis; None where it has no such value."""
        value = row[self.key]
        if not self.vector:
            return value if _number(value) else None
        if not _vector(value):
            return None
        return math.hypot(*value) if self.component is None else value[self.component]


def axis(jobs: list[Job], over: str | None) -> Axis:
    """The axis of a figure: what was asked for, else the first key that takes several numbers, or else vectors;
    `CaseError` where there is none."""
    points = [_values(job) for job in jobs]
    found = {key: own for key in points[0] if (own := _axis(key, [point[key] for point in points]))}
    if over is None and not found:
        raise CaseError(f"--plot: no key takes several numbers in this sweep, {', '.join(points[0])}; leave --plot out")
    if over is None:
        return min(found.values(), key=lambda own: own.vector)
    if over not in points[0]:
        raise CaseError(unknown(over, points[0]).replace("unknown key", "no varied key called", 1))
    if over not in found:
        told = ", ".join(found) or "none"
        raise CaseError(f"{over} does not take several numbers in this sweep; those that do: {told}")
    return found[over]


def _axis(key: str, values: list) -> Axis | None:
    """The axis of the values of a key; None where they are fewer than two numbers, or vectors of a length."""
    if len({value for value in values if _number(value)}) > 1:
        return Axis(key)
    vectors = [value for value in values if _vector(value)]
    if len({len(value) for value in vectors}) != 1:
        return None
    varied = [i for i, parts in enumerate(zip(*vectors)) if len(set(parts)) > 1]
    if not varied:
        return None
    return Axis(key, True, varied[0] if len(varied) == 1 else None)


def known(found: list[dict], keys: list[str]) -> list[str]:
    """Names of the numbers of the summaries so far."""
    good = [row for row in found if row["exit_code"] == FINE]
    return [key for key in found[0] if key not in (*HEAD, *keys) and any(_number(row[key]) for row in good)]


def refuse_unknown(found: list[dict], keys: list[str], metrics: list[str], left: int = 0) -> None:
    """CaseError where a metric is a number of none of the summaries; while runs are `left`, only where it is a known
    one misspelt: what is told only where something happened may stand in a summary that is still to come."""
    own, good = known(found, keys), any(row["exit_code"] == FINE for row in found)
    for metric in metrics if good else []:
        if metric not in own and (not left or difflib.get_close_matches(metric, own, 1, SLIP)):
            told = unknown(metric, own).replace("unknown key", "no number of the summaries called", 1)
            raise CaseError(f"--plot: {told}")


def awaited(found: list[dict], keys: list[str], metrics: list[str]) -> str:
    """A line on metrics that no summary has yet, with the nearest that there are; empty where there is none."""
    own = known(found, keys)
    told = [f"{name} (near: {_near(name, own)})" for name in metrics if own and name not in own]
    return f"--plot: no summary yet has {', '.join(told)}; those that follow may" if told else ""


def _near(name: str, own: list[str]) -> str:
    return ", ".join(difflib.get_close_matches(name, own, NEAR, 0.4)) or "none"


def _vector(value) -> bool:
    return isinstance(value, list) and len(value) > 1 and all(map(_number, value))


def _number(value) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def draw(found: list[dict], keys: list[str], metrics: list[str], over: Axis, path: Path) -> Path:
    """Each metric over a key, a line for each set of the other keys; runs that failed, and those that have no such
    number, are crosses on the axis."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, panels = pyplot.subplots(
        len(metrics), 1, figsize=(WIDTH, HEIGHT * len(metrics)), squeeze=False, layout="constrained"
    )
    others = [key for key in keys if key != over.key and len({str(row[key]) for row in found}) > 1]
    for metric, axis in zip(metrics, panels[:, 0]):
        _panel(axis, found, metric, over, others)
    figure.savefig(path, dpi=150)
    pyplot.close(figure)
    return path


def _order(value) -> tuple[bool, float, str]:
    """Place of a value among others of its key: numbers by size, then all else by its text, the last of these."""
    return not _number(value), float(value) if _number(value) else 0.0, str(value)


def _panel(axis, found: list[dict], metric: str, over: Axis, others: list[str]) -> None:
    lines: dict[tuple, list[tuple[float, float]]] = {}
    placed = [(at, row) for row in found if (at := over.place(row)) is not None]
    for at, row in placed:
        if row["exit_code"] == FINE:
            own = tuple(_order(row[key]) for key in others)
            lines.setdefault(own, []).append((at, row[metric] if _number(row[metric]) else math.nan))
    for own, places in sorted(lines.items()):
        label = ", ".join(f"{key} = {told}" for key, (*_, told) in zip(others, own))
        axis.plot(*zip(*sorted(places)), "o-", label=label, markersize=4)
    failed = [at for at, row in placed if row["exit_code"] != FINE]
    none = [at for at, row in placed if row["exit_code"] == FINE and not _number(row[metric])]
    for label, places, colour in (("failed", failed, "tab:red"), ("has none", none, "tab:gray")):
        if places:
            low = [0.03] * len(places)
            axis.plot(places, low, "x", color=colour, transform=axis.get_xaxis_transform(), label=label)
    axis.set_xlabel(over.label)
    axis.set_ylabel(metric)
    if failed or none or others:
        axis.legend(fontsize="small")
