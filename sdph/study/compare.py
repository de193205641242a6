"""Parts of a comparison: a finished run, checks, and the scene's own validation/<scene>/compare.py."""

from __future__ import annotations

import importlib.util
import sys
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from sdph import scenes
from sdph.case import read as cases
from sdph.running import output
from sdph.scenes import paths
from sdph.schema import CaseError
from sdph.show import timeline

BETWEEN = 1e-6  # of the time between outputs: times nearer to each other are the same
DIGITS = 1e-7  # of a time: those that OpenFOAM's folders and run.pvd are written with


@dataclass(frozen=True)
class Finished:
    """A finished run: its case, summary and history (name -> column); `notices` are for who reads its checks."""

    folder: Path
    case: cases.Case
    summary: dict
    history: dict[str, np.ndarray]
    notices: list[str] = field(default_factory=list)

    def at(self, column: str, time: float) -> float:
        """A column of the history at `time` [s], linear between windows."""
        return float(np.interp(time, self.history["time_s"], self.history[column]))

    @property
    def ledger(self) -> dict[str, np.ndarray]:
        """Columns of ledger.csv, a row a window."""
        return _table(self.folder / "ledger.csv")

    @property
    def metrics(self) -> dict[str, np.ndarray]:
        """Columns of metrics.csv, a row an output."""
        return _table(self.folder / "metrics.csv")

    def fields(self, time: float):
        """(time, particles, gas) of the output at `time` [s]; CaseError where there is none."""
        own = timeline.read(self.folder)
        self.output_at(own.time_values, time)
        return timeline.state_at(own, time)

    def metric(self, column: str, time: float) -> float:
        """A column of metrics.csv at the output at `time` [s]; CaseError where there is none."""
        table = self.metrics
        return float(table[column][self.output_at(table["time_s"], time)])

    def output_at(self, times, time: float) -> int:
        """Number of the output at `time` [s] among those at `times`; CaseError where none is at that time."""
        apart, interval = np.abs(np.asarray(times) - time), self.case.run.output_interval
        k = int(apart.argmin())
        if apart[k] > _same(time, interval):
            raise CaseError(
                f"{self.folder} has no output at {time:g} s, where it is compared; the nearest is at {times[k]:g} s: "
                f"run it anew with run.output_interval_s (here {interval:g}) such that {time:g} s is a multiple of it"
            )
        return k

    def reached(self, times: Iterable[float]) -> list[float]:
        """Times [s] among `times` that the run reaches; a notice names the others."""
        end = self.summary["time_s"] * (1.0 + DIGITS)
        later = ", ".join(f"{t:g}" for t in times if t > end)
        if later:
            self.notices.append(f"{self.folder} ends at {self.summary['time_s']:g} s: no check at {later} s")
        return [t for t in times if t <= end]

    def outputs(self, times: Iterable[float]) -> list[float]:
        """Times [s] as of `reached`, each of an output; CaseError where there is none."""
        own, found = timeline.read(self.folder).time_values, self.reached(times)
        for time in found:
            self.output_at(own, time)
        return found


def open_run(folder: Path) -> Finished:
    """Reads a run folder; `CaseError` where it holds no finished run."""
    summary = output.read_summary(folder)
    for name in (output.MARK, "history.csv"):
        if not (folder / name).is_file():
            raise CaseError(f"{folder} has lost its {name}; run it again")
    return Finished(folder, cases.load(folder / output.MARK), summary, _table(folder / "history.csv"))


def _table(file: Path) -> dict[str, np.ndarray]:
    """Columns of a table of a run; its times never fall, and it has a row at least."""
    columns = output.read_table(file, output.TEXTS)
    times = columns["time_s"]
    if not len(times) or not (np.diff(times) >= 0.0).all():
        raise CaseError(f"{file} is damaged ({'its times fall' if len(times) else 'it has no row'}); run it again")
    return columns


def _same(time: float, interval: float) -> float:
    """Distance [s] from `time` [s] within which an output is at that time."""
    return BETWEEN * interval + DIGITS * abs(time)


def too_short(run: Finished) -> bool:
    """Tell whether a run ends before the first time that a reference of OpenFOAM writes at."""
    return run.summary["time_s"] < run.case.run.output_interval * (1.0 - BETWEEN)


def times_of_both(run: Finished, reference) -> list[float]:
    """Times [s] at which a run and a reference of OpenFOAM have fields; CaseError where there is none."""
    own, interval = np.array(timeline.read(run.folder).time_values), run.case.run.output_interval
    found = [t for t in sorted(reference.fields) if np.abs(own - t).min() <= _same(t, interval)]
    if not found:
        raise CaseError(
            f"{run.folder} has fields at none of the times of its reference, every {interval:g} s "
            "(run.output_interval_s, which was another before --resume): run it anew with one interval"
        )
    return found


def check(name: str, value: float, reference: float, tolerance: float, relative: bool = False) -> dict:
    """One row of a comparison: |value - reference| <= tolerance (times |reference| where relative)."""
    value, reference = float(value), float(reference)
    allowed = tolerance * abs(reference) if relative else tolerance
    return {
        "name": name,
        "value": value,
        "reference": reference,
        "tolerance": allowed,
        "ok": bool(abs(value - reference) <= allowed),
    }


def scene_module(scene: str):
    """validation/<scene>/compare.py as a module, which may import its neighbours; None where there is none."""
    file = paths.data("validation") / scene / "compare.py"
    if scene not in scenes.names() or not file.is_file():  # a case.toml may name no other code
        return None
    package, beside = f"sdph_validation_{scene}", [str(file.parent)]
    spec = importlib.util.spec_from_file_location(package, file, submodule_search_locations=beside)
    module = sys.modules[package] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def table(checks: list[dict]) -> str:
    """The checks as text, one line each; the share by which one is off stands where its reference is not 0."""
    head = f"{'check':72s} {'value':>14s} {'reference':>14s} {'difference':>12s} {'off':>10s} {'tolerance':>11s}"
    row = "{name:72s} {value:14.7g} {reference:14.7g} {difference:12.3g} {off:>10s} {tolerance:11.3g} {verdict}"
    lines = []
    for c in checks:
        difference = c["value"] - c["reference"]
        off = f"{100.0 * difference / abs(c['reference']):+.3g} %" if c["reference"] else ""
        lines.append(row.format(difference=difference, off=off, verdict="ok" if c["ok"] else "FAILED", **c))
    return "\n".join([head, *lines])
