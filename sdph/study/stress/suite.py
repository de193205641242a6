"""`sdph stress`: hard cases, one file each under validation/stress/, that have to stay stable.

A file names a scene to start from and changes it:

    title = "..."            why = "..."          base = "bubbling_bed"
    fast = true              among the subset that CI runs
    windows = 50             windows at most (default: to the end of the case)
    expect = "stable"        or "caught" (the guard must stop it), or "either"
    shear_1_s = [[...]]      adds the velocity gradient times (place - middle of the grains)
    [case...]                tables that replace those of the scene, key by key; false removes a table; walls.mesh lies
                             here
    [[then]]                 such tables again: the run goes on from its last state with them (windows, case)
    [at_most] [at_least]     measures (see `sdph.study.stress.measures`) and their bounds, besides those that hold for
                             every case
"""

from __future__ import annotations

import dataclasses
import tempfile
import time
import tomllib
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from coupling.gas import GasError
from sdph import scenes
from sdph.case import read as cases
from sdph.engine.guard import Unstable
from sdph.engine.state import WALL
from sdph.running import balances
from sdph.running.driver import simulation_of
from sdph.scenes import paths
from sdph.schema import CaseError, unknown
from sdph.study.stress.droplet_measures import DropletMeasures
from sdph.study.stress.liquid_measures import LiquidMeasures
from sdph.study.stress.measures import Measures

FOLDER = "validation"
# of a hard case steps may do much: what is numerical is not judged there
ALWAYS = {"lost_through_walls": 0.0} | {k: bar for k, bar in balances.BARS.items() if bar != balances.NUMERICAL}


class Refused(RuntimeError):
    """A run that its case does not allow to go on, by what has become of it."""


@dataclass(frozen=True)
class Hard:
    """One hard case, as its file says."""

    name: str
    title: str
    base: str
    why: str = ""
    fast: bool = False
    windows: int = 10**9
    expect: str = "stable"
    shear_1_s: list = field(default_factory=list)
    case: dict = field(default_factory=dict)
    then: list = field(default_factory=list)
    at_most: dict = field(default_factory=dict)
    at_least: dict = field(default_factory=dict)
    map: dict = field(default_factory=dict)


@dataclass(frozen=True)
class Verdict:
    """Outcome of a case: rows (measure, value, bound, ok), and what was said if the guard stopped it."""

    name: str
    rows: list
    wall: float
    stopped: str = ""

    @property
    def ok(self) -> bool:
        return all(row[3] for row in self.rows)

    @property
    def checks(self) -> list[dict]:
        """The rows as `sdph compare` has them: the bound is the reference, and there is no tolerance."""
        return [
            {
                "name": f"{self.name}: {name} {bound[:2]}",
                "value": value,
                "reference": float(bound[3:]),
                "tolerance": 0.0,
                "ok": bool(ok),
            }
            for name, value, bound, ok in self.rows
        ]


def files() -> list[Path]:
    return sorted((paths.data(FOLDER) / "stress").glob("*.toml"))


def load(file: Path) -> Hard:
    """A hard case from its file."""
    table = tomllib.loads(file.read_text(encoding="utf-8"))
    known = {f.name for f in dataclasses.fields(Hard)} - {"name"}
    for key in table.keys() - known:
        raise CaseError(f"{file.name}: {unknown(key, known)}")
    hard = Hard(name=file.stem, **table)
    if hard.then and "liquid" in tomllib.loads(scenes.find(hard.base)[1].read_text(encoding="utf-8")):
        raise CaseError(f"{file.name}: then is for grains; a liquid has one stage")
    return hard


def chosen(names: list[str], fast: bool) -> list[Hard]:
    """The cases of these names, or all; only the fast ones if so asked."""
    every = {file.stem: file for file in files()}
    for name in names:
        if name not in every:
            raise CaseError(unknown(name, every).replace("unknown key", "no hard case called", 1))
    found = [load(every[name]) for name in names or every]
    kept = [hard for hard in found if hard.fast or not fast]
    if not kept:
        raise CaseError(f"--fast: none of {', '.join(names)} is fast; leave --fast out, or name others")
    return kept


def case_of(hard: Hard, *changes: dict) -> cases.Case:
    """The case: its scene's, changed by the file, then by `changes`."""
    table = tomllib.loads(scenes.find(hard.base)[1].read_text(encoding="utf-8"))
    for change in (hard.case, *changes):
        table = merged(table, change)
    if "mesh" in table.get("walls", {}):
        table["walls"]["mesh"] = str(paths.data(FOLDER) / "stress" / table["walls"]["mesh"])
    return cases.from_table(table)


def merged(table: dict, change: dict) -> dict:
    """A table with another laid over it; `false` in the place of a table removes it."""
    out = dict(table)
    for key, value in change.items():
        if value is False and isinstance(out.get(key), dict):
            del out[key]
        else:
            out[key] = merged(out.get(key, {}), value) if isinstance(value, dict) else value
    return out


def run(hard: Hard, *changes: dict) -> Verdict:
    """Run a hard case and judge it."""
    started, stopped = time.perf_counter(), ""
    case = case_of(hard, *changes)
    measures = _measures(case)
    with tempfile.TemporaryDirectory() as folder:
        try:
            simulation = _first(hard, case, Path(folder), measures)
            for number, stage in enumerate(hard.then):
                changed = case_of(hard, *changes, *(earlier.get("case", {}) for earlier in hard.then[: number + 1]))
                simulation = _next(
                    simulation, changed, Path(folder) / str(number), measures, stage.get("windows", 10**9)
                )
        except (GasError, Refused, Unstable) as error:
            stopped = str(error)
    return Verdict(hard.name, _judged(hard, measures, stopped), time.perf_counter() - started, stopped)


def _first(hard: Hard, case, folder: Path, measures):
    simulation = simulation_of(case, _gas(case), folder / "ledger.csv")
    if hard.shear_1_s:
        _shear(simulation.state, np.array(hard.shear_1_s))
    simulation.start()
    return _go(simulation, measures, hard.windows)


def _next(before, case, folder: Path, measures, windows: int):
    """Another case that takes over grains and gas as they are."""
    before.gas.checkpoint(folder)
    simulation = simulation_of(case, TakenOver(_gas(case), folder), folder / "ledger.csv")
    simulation.stepper.replace(before.state)
    simulation.start()
    return _go(simulation, measures, windows)


class TakenOver:
    """A gas solver whose `start` is a checkpoint of another case on the same mesh."""

    def __init__(self, gas, folder: Path):
        self.gas, self.folder = gas, folder

    def __getattr__(self, name):
        return getattr(self.gas, name)

    def start(self, alpha_g, sources, fields=()):
        return self.gas.restore(self.folder, fields=fields)


def _measures(case):
    if "time_scaling" in case.effects:
        return DropletMeasures(case)
    if case.liquid:
        return LiquidMeasures(case)
    return Measures(case)


def _gas(case):
    """The embedded solver; None for a liquid."""
    from coupling.embedded import EmbeddedGas

    return EmbeddedGas(case) if case.grains else None


def _go(simulation, measures, windows: int):
    """Run up to so many windows, or to the end of the case; every one is measured."""
    try:
        for _ in range(windows):
            if simulation.clock.over(simulation.time):  # a droplet that tears ends soon after
                break
            simulation.window()
            measures.window(simulation)
    except CaseError as error:
        raise Refused(str(error)) from None
    finally:
        measures.finish(simulation)
        simulation.ledger.table.close()
    return simulation


def _shear(state, gradient) -> None:
    """Adds gradient (d, d) [1/s] times the place relative to the middle of the particles, walls left out."""
    places = np.stack([state.x, state.y, state.z][: len(gradient)], axis=1)
    inside = state.kind != WALL
    added = np.where(inside[:, None], (places - places[inside].mean(axis=0)) @ gradient.T, 0.0)
    for velocity, change in zip((state.u, state.v, state.w), added.T):
        velocity += change


def _judged(hard: Hard, measures, stopped: str) -> list:
    """Rows (measure, value, bound, ok)."""
    told = bool(stopped)
    if hard.expect == "caught" or (hard.expect == "either" and told):
        return [("stopped with a reason", float(told), ">= 1", told)]
    if stopped:
        return [("stopped with a reason", 1.0, "<= 0", False)]
    values = measures.values()
    # what moving particles make in pools is a known miss of `validate` (docs/theory/mps.md), not of stability
    idle = {"energy_made_rel"} - hard.at_most.keys() if measures.case.incompressible else set()
    most = {name: bound for name, bound in (ALWAYS | hard.at_most).items() if name in values and name not in idle}
    rows = [(name, values[name], f"<= {bound:g}", values[name] <= bound) for name, bound in most.items()]
    rows += [(name, values[name], f">= {least:g}", values[name] >= least) for name, least in hard.at_least.items()]
    for name in hard.at_most.keys() - values.keys():
        raise CaseError(f"{hard.name}: {unknown(name, values)}")
    return rows


def line(verdict: Verdict) -> str:
    """One line: pass or fail, with the figure nearest to its bound or past it."""
    shown = [row for row in verdict.rows if not row[3]] or verdict.rows[-1:]
    figures = "; ".join(f"{name} = {value:.4g} ({bound})" for name, value, bound, _ in shown)
    return f"{'pass' if verdict.ok else 'FAIL'}  {verdict.name:28s} {verdict.wall:6.1f} s  {figures}" + (
        f"\n      {verdict.stopped}" if verdict.stopped else ""
    )


def show(verdict: Verdict) -> None:
    """Prints the line as soon as it is known."""
    print(line(verdict), flush=True)
