"""Measures the rungs of a ladder: wall time and metrics of each, one row of cost.csv at a time."""

from __future__ import annotations

import csv
import json
import math
import os
import platform
import statistics
import tempfile
import time
from collections import defaultdict
from pathlib import Path

from coupling.gas import GasError
from coupling.openfoam.programs import install
from sdph import scenes
from sdph.engine.guard import Unstable
from sdph.running import driver
from sdph.running.progress import Reporter
from sdph.schema import CaseError, unknown
from sdph.study import compare
from sdph.study.cost import measured_case
from sdph.study.cost import rows as measured_rows
from sdph.study.cost.ladder import ALL, Ladder, case_of, declared, rungs

KEPT = ("wall_s", "wall_particles_s", "wall_exchange_s", "wall_gas_s", "particles", "cells", "windows", "sub_steps")
SHORT = (
    "run.end_time_s=1e-6",
    "run.output_interval_s=1e-6",
    "run.report_at_s=[]",
    "run.average_from_s=0",
    "coupling.window_largest_s=1e-6",
)


def climb(scene: str, file: Path, budget: float, repeats: int, report) -> list[dict]:
    """Measures the rungs that `file` lacks, in their order, until `budget` [s] is spent; all rows."""
    own, started = declared(scene), time.perf_counter()
    measured_case.keep(scene, own, file)
    rows = measured_rows.read(file)
    if budget > 0.0:
        rows += _others(scene, own, file, rows, report)
    for label, settings in rungs(own):
        if any(measured_rows.has(row, settings) for row in rows):
            report(f"{label}: measured before")
            continue
        if time.perf_counter() - started > budget:
            report(f"the budget is spent before {label}; go on with the same command")
            break
        rows.append(
            _keep(
                file,
                {"label": label, "solver": measured_rows.OWN, **settings, **measure(scene, own, settings, repeats)},
            )
        )
        report(f"{label}: {rows[-1]['wall_s']:.3g} s")
    return rows


def measure(scene: str, own: Ladder, settings: dict, repeats: int) -> dict:
    """One rung: the median wall time of its repeats, its metrics as JSON, the machine and its load. Kernels are warm.
    A run that is stopped, as one without an effect that it needs may be, has no metrics; a liquid has no gas to tell
    of."""
    with tempfile.TemporaryDirectory() as folder:
        try:
            _run(case_of(scene, own, settings, *SHORT), scene, Path(folder) / "warm")
            made = [_run(case_of(scene, own, settings), scene, Path(folder) / str(number)) for number in range(repeats)]
            found = metrics(scene, own, Path(folder) / "0", settings["without"])
        except (GasError, Unstable):
            made, found = [dict.fromkeys(KEPT, math.nan)], {}
        except CaseError:  # such as of grains that nothing holds back any more
            if settings["without"] == ALL:
                raise
            made, found = [dict.fromkeys(KEPT, math.nan)], {}
    wall = statistics.median(summary["wall_s"] for summary in made)
    return (
        {name: made[0].get(name, ALL) for name in KEPT}
        | {"wall_s": wall, "metrics": json.dumps(found)}
        | _machine(repeats)
    )


def _run(case, scene: str, folder: Path) -> dict:
    name, file = scenes.find(scene)
    return driver.run(case, name, folder, driver.template_of(case, name, file), Reporter(quiet=True))


def _machine(repeats: int) -> dict:
    return {
        "repeats": repeats,
        "load": round(os.getloadavg()[0], 2),
        "cores": os.cpu_count(),
        "machine": platform.machine(),
        "measured": time.strftime("%Y-%m-%d"),
    }


def metrics(scene: str, own: Ladder, folder: Path, without: str) -> dict:
    """Name -> (value, reference or None, scale or None) of a run; what an effect that is left out would have made is
    0."""
    run = compare.open_run(folder)
    if not own.metrics:
        return compare.scene_module(scene).metrics(run)
    if without == ALL and (lacking := [name for name in own.metrics if name not in run.summary]):
        raise CaseError(
            f"{scene}: metrics of its ladder: {unknown(lacking[0], run.summary)}; it is not in summary.json"
        )
    made = run.summary if without == ALL else defaultdict(float, run.summary)
    return {name: (made[name], None, None) for name in own.metrics}


def _others(scene: str, own: Ladder, file: Path, rows: list[dict], report) -> list[dict]:
    """Rows of other solvers on the same scene that `file` lacks; none where the scene has none, or they are not
    installed."""
    module, found = compare.scene_module(scene), []
    if not hasattr(module, "others"):
        return found
    if not install.find():
        report("other solvers are left out: OpenFOAM was not found (sdph openfoam setup --install)")
        return found
    case, blank = case_of(scene, own, own.middle), dict.fromkeys([*own.keys, "without", *KEPT], ALL)
    with tempfile.TemporaryDirectory() as folder:
        try:
            # those that were run before come from the cache
            for label, solver, wall, values in module.others(case, Path(folder)):
                if any((row["solver"], row["label"]) == (solver, label) for row in rows):
                    continue
                row = (
                    {"label": label, "solver": solver}
                    | blank
                    | {"wall_s": wall, "metrics": json.dumps(values)}
                    | _machine(1)
                )
                found.append(_keep(file, row))
                report(f"{solver}, {label}: {wall:.3g} s")
        except GasError as error:
            report(f"other solvers are left out: {error}")
    return found


def _keep(file: Path, row: dict) -> dict:
    """Append a row; a table whose columns are others, of another ladder, stays as it is."""
    file.parent.mkdir(parents=True, exist_ok=True)
    if file.is_file() and (head := file.read_text(encoding="utf-8").partition("\n")[0]) != ",".join(row):
        raise CaseError(
            f"{file} has the columns {head}, and the ladder {','.join(row)}: move it away and measure again"
        )
    with open(file, "a", newline="", encoding="utf-8") as opened:
        writer = csv.DictWriter(opened, row.keys(), lineterminator="\n")
        if file.stat().st_size == 0:
            writer.writeheader()
        writer.writerow(row)
    return row
