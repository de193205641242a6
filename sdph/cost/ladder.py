"""`sdph cost`: what accuracy costs. Runs a ladder over the knobs that a scene names, measures wall time and error.

validation/<scene>/cost.toml declares it:

    reference = "..."   what errors are taken against       base = ["key=value", ...]   overrides of every run
    drop = ["..."]      effects that are switched off, one at a time
    [knobs]             key of the case -> values, coarse to fine, all of one length
    [metrics.NAME]      a key of summary.json: reference (without it: Richardson's limit of the ladder) and scale

In place of [metrics], validation/<scene>/compare.py may have metrics(run) -> {name: (value, reference, scale)}.
"""

from __future__ import annotations

import csv
import json
import math
import os
import platform
import statistics
import tempfile
import time
import tomllib
from dataclasses import dataclass, field
from pathlib import Path

from sdph import case as cases
from sdph import compare, driver, output, paths, scenes
from sdph.progress import Reporter
from sdph.schema import CaseError

KEPT = ("wall_s", "wall_particles_s", "wall_exchange_s", "wall_gas_s", "particles", "cells", "windows", "sub_steps")
ALL = "-"  # in the column `without`: no effect is left out
LIMITS = (0.10, 0.05, 0.02, 0.01)  # errors that the table answers for


@dataclass(frozen=True)
class Ladder:
    """What validation/<scene>/cost.toml says."""

    reference: str
    base: list
    knobs: dict
    drop: list = field(default_factory=list)
    metrics: dict = field(default_factory=dict)


def declared(scene: str) -> Ladder:
    """The ladder that a scene declares."""
    file = paths.data("validation") / scene / "cost.toml"
    if not file.is_file():
        known = [name for name in scenes.names() if (file.parents[1] / name / "cost.toml").is_file()]
        raise CaseError(f"{scene} declares no ladder (validation/{scene}/cost.toml); scenes that do: {', '.join(known)}")
    return Ladder(**tomllib.loads(file.read_text(encoding="utf-8")))


def rungs(own: Ladder) -> list[tuple[str, dict]]:
    """(label, settings): all knobs together from coarse to fine, then one at a time from the middle, then effects off."""
    count = len(next(iter(own.knobs.values())))
    middle = _level(own, count // 2)
    found = [(f"all {n + 1}/{count}", _level(own, n)) for n in range(count)]
    for key, values in own.knobs.items():
        found += [(key, middle | {key: value}) for value in values if value != middle[key]]
    return found + [(f"without {name}", middle | {"without": name}) for name in own.drop]


def _level(own: Ladder, n: int) -> dict:
    return {key: values[n] for key, values in own.knobs.items()} | {"without": ALL}


def climb(scene: str, file: Path, budget: float, repeats: int, report) -> list[dict]:
    """Measures the rungs that `file` lacks, cheapest first as they stand, until `budget` [s] is spent; all rows."""
    own, started = declared(scene), time.perf_counter()
    rows = read(file)
    _warm(scene, own)
    for label, settings in rungs(own):
        if any(all(str(row[key]) == str(value) for key, value in settings.items()) for row in rows):
            report(f"{label}: measured before")
            continue
        if time.perf_counter() - started > budget:
            report(f"the budget is spent before {label}; go on with the same command")
            break
        row = {"label": label, **settings, **measure(scene, own, settings, repeats)}
        rows.append(row)
        _append(file, row)
        report(f"{label}: {row['wall_s']:.3g} s")
    return rows


def measure(scene: str, own: Ladder, settings: dict, repeats: int) -> dict:
    """One rung: the median wall time of its repeats, and its metrics as JSON; the load of the machine."""
    walls, summary, found = [], {}, {}
    for _ in range(repeats):
        with tempfile.TemporaryDirectory() as folder:
            summary = driver.run(_case(scene, own, settings), scene, Path(folder) / "run", None, Reporter(quiet=True))
            found = metrics(scene, own, Path(folder) / "run")
        walls.append(summary["wall_s"])
    machine = {"repeats": repeats, "load": round(os.getloadavg()[0], 2), "cores": os.cpu_count(), "machine": platform.machine()}
    return {name: summary[name] for name in KEPT} | {"wall_s": statistics.median(walls), "metrics": json.dumps(found)} | machine


def _case(scene: str, own: Ladder, settings: dict, *more: str):
    table = cases.to_table(cases.load(scenes.find(scene)[1], (*own.base, *overrides(settings), *more)))
    if settings["without"] != ALL:
        table["effects"] = [name for name in table["effects"] if name != settings["without"]]
        table.pop(settings["without"], None)
    return cases.from_table(table)


def overrides(settings: dict) -> tuple[str, ...]:
    """`--set` arguments of a rung."""
    return tuple(f"{key}={value}" for key, value in settings.items() if key != "without")


def _warm(scene: str, own: Ladder) -> None:
    """Compiles all kernels: a run of one short window, at the coarsest."""
    case = _case(scene, own, _level(own, 0), "run.end_time_s=1e-6", "run.output_interval_s=1e-6", "run.report_at_s=[]")
    with tempfile.TemporaryDirectory() as folder:
        driver.run(case, scene, Path(folder) / "run", None, Reporter(quiet=True))


def metrics(scene: str, own: Ladder, folder: Path) -> dict:
    """Name -> (value, reference or None, scale) of a run."""
    run = compare.open_run(folder)
    if own.metrics:
        return {name: (run.summary[name], row.get("reference"), row["scale"]) for name, row in own.metrics.items()}
    return {name: tuple(map(float, row)) for name, row in compare.scene_module(scene).metrics(run).items()}


def read(file: Path) -> list[dict]:
    """Rows measured so far."""
    if not file.is_file():
        return []
    table = output.read_table(file)
    keys = list(table)
    return [dict(zip(keys, values)) for values in zip(*table.values())]


def _append(file: Path, row: dict) -> None:
    file.parent.mkdir(parents=True, exist_ok=True)
    with open(file, "a", newline="", encoding="utf-8") as opened:
        writer = csv.DictWriter(opened, row.keys(), lineterminator="\n")
        if file.stat().st_size == 0:
            writer.writeheader()
        writer.writerow(row)


def errors(rows: list[dict]) -> list[dict]:
    """The rows with `error`: the largest of |value - reference|/scale; references by Richardson where none is given."""
    limits = _richardson([json.loads(row["metrics"]) for row in rows if str(row["label"]).startswith("all ")])
    return [row | {"error": max(_errors(json.loads(row["metrics"]), limits).values())} for row in rows]


def _errors(found: dict, limits: dict) -> dict:
    return {name: abs(value - (limits[name] if best is None else best)) / abs(scale) for name, (value, best, scale) in found.items()}


def _richardson(levels: list[dict]) -> dict:
    """Limit of each metric as all knobs are refined together, by its observed order; the finest where there is none."""
    limits = {}
    for name in levels[-1] if levels else ():
        values = [level[name][0] for level in levels[-3:]]
        limits[name] = values[-1]
        if len(values) == 3 and (values[1] - values[0]) * (values[2] - values[1]) > 0.0:
            ratio = (values[1] - values[0]) / (values[2] - values[1])
            limits[name] += (values[2] - values[1]) / (ratio - 1.0) if ratio > 1.0 else 0.0
    return limits


def orders(own: Ladder, rows: list[dict]) -> dict[str, float]:
    """Observed order of the change of the metrics with each numeric knob alone, the others in the middle."""
    count, found = len(next(iter(own.knobs.values()))), {}
    middle = _level(own, count // 2)
    for key, values in own.knobs.items():
        line = [next((r for r in rows if all(str(r[k]) == str(v) for k, v in (middle | {key: value}).items())), None) for value in values[-3:]]
        if len(line) == 3 and all(line) and all(isinstance(v, (int, float)) for v in values):
            changes = [_distance(a, b) for a, b in zip(line, line[1:])]
            if min(changes) > 0.0:
                found[key] = math.log(changes[0] / changes[1]) / math.log(values[-3] / values[-2])
    return found


def _distance(a: dict, b: dict) -> float:
    """Largest difference of two rows' metrics over their scale."""
    one, other = json.loads(a["metrics"]), json.loads(b["metrics"])
    return max(abs(one[name][0] - other[name][0]) / abs(one[name][2]) for name in one.keys() & other.keys())


def cheapest(rows: list[dict], accuracy: float) -> dict | None:
    """The row that takes least time among those with all effects whose error is at most `accuracy`."""
    fine = [row for row in rows if row["error"] <= accuracy and row["without"] == ALL]
    return min(fine, key=lambda row: row["wall_s"], default=None)


def measured(scene: str) -> tuple[Path, list[dict]]:
    """The rows for a scene: the user's own, else those that come with sdph."""
    for file in (Path("runs/cost") / scene / "cost.csv", paths.data("validation") / scene / "cost.csv"):
        if file.is_file():
            return file, errors(read(file))
    raise CaseError(f"nothing is measured for {scene}, so no accuracy can be promised; measure it with: sdph cost {scene}")


def settings_for(scene: str, accuracy: float, report) -> tuple[str, ...]:
    """Overrides of the cheapest measured settings that hold `accuracy`; says which, and on what evidence."""
    file, rows = measured(scene)
    best = cheapest(rows, accuracy)
    if best is None:
        least = min(row["error"] for row in rows)
        raise CaseError(f"no measured setting of {scene} errs by {accuracy:g} or less (the best: {least:.2g}, {file}); ask for more, or refine its ladder")
    own = declared(scene)
    chosen = overrides({key: best[key] for key in own.knobs})
    report(f"--accuracy {accuracy:g}: {' '.join(chosen)}; measured error {best['error']:.2g} against {own.reference}, {best['wall_s']:.3g} s ({file})")
    return (*own.base, *chosen)
