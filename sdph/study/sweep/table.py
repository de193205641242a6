"""sweep.csv: a row a run, with the values of its keys and all of its summary; and the figure of a metric over a key."""

from __future__ import annotations

import math
from pathlib import Path

from sdph.case import read as cases
from sdph.running import output
from sdph.schema import CaseError, unknown
from sdph.study.sweep.jobs import FINE, Job

FILE, FIGURE = "sweep.csv", "sweep.png"
HEAD = ("run", "exit_code", "reason")
WIDTH, HEIGHT = 6.4, 3.6  # of a panel [inches]


def rows(jobs: list[Job], outcomes: dict[str, dict]) -> list[dict]:
    """A row for each job whose outcome (by name) is known, all of the same columns."""
    found = [_row(job, outcomes[job.name]) for job in jobs if job.name in outcomes]
    columns = list(dict.fromkeys(key for row in found for key in row))
    return [dict.fromkeys(columns, "") | row for row in found]


def _row(job: Job, outcome: dict) -> dict:
    row = {"run": job.name, "exit_code": outcome["exit_code"], "reason": outcome["reason"]}
    row |= {key: cases.value_of(value) if value else "" for key, value in job.point.items()}
    return row | (output.read_summary(Path(job.folder)) if outcome["exit_code"] == FINE else {})


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


def chosen(found: list[dict], keys: list[str], metrics: list[str], over: str | None) -> tuple[str, list[str]]:
    """(key, metrics) to draw: what was asked for, else the first key that is a number and varies, and what the metrics
    of the scene tell; `CaseError` where there is none."""
    numeric = [key for key in keys if len({row[key] for row in found if _number(row[key])}) > 1]
    over = over or next(iter(numeric), None)
    if over not in keys:
        raise CaseError(unknown(str(over), keys).replace("unknown key", "no varied key called", 1))
    if over not in numeric:
        raise CaseError(f"{over} does not take several numbers in this sweep; numbers are drawn over: {numeric}")
    good = [row for row in found if row["exit_code"] == FINE]
    known = [key for key in found[0] if key not in (*HEAD, *keys) and all(_number(row[key]) for row in good)]
    for metric in metrics:
        if metric not in known:
            raise CaseError(unknown(metric, known).replace("unknown key", "no number of the summaries called", 1))
    return over, metrics


def _number(value) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def draw(found: list[dict], keys: list[str], metrics: list[str], over: str, path: Path) -> Path:
    """Each metric over a key, a line for each set of the other keys; runs that failed are crosses on the axis."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, panels = pyplot.subplots(
        len(metrics), 1, figsize=(WIDTH, HEIGHT * len(metrics)), squeeze=False, layout="constrained"
    )
    others = [key for key in keys if key != over and len({str(row[key]) for row in found}) > 1]
    for metric, axis in zip(metrics, panels[:, 0]):
        _panel(axis, found, metric, over, others)
    figure.savefig(path, dpi=150)
    pyplot.close(figure)
    return path


def _panel(axis, found: list[dict], metric: str, over: str, others: list[str]) -> None:
    lines: dict[str, list[tuple[float, float]]] = {}
    for row in (row for row in found if row["exit_code"] == FINE and _number(row[over])):
        label = ", ".join(f"{key} = {row[key]}" for key in others)
        value = math.nan if row[metric] is None else row[metric]
        lines.setdefault(label, []).append((row[over], value))
    for label, places in sorted(lines.items()):
        axis.plot(*zip(*sorted(places)), "o-", label=label, markersize=4)
    failed = [row[over] for row in found if row["exit_code"] != FINE and _number(row[over])]
    if failed:
        axis.plot(
            failed, [0.03] * len(failed), "x", color="tab:red", transform=axis.get_xaxis_transform(), label="failed"
        )
    axis.set_xlabel(over)
    axis.set_ylabel(metric)
    if failed or others:
        axis.legend(fontsize="small")
