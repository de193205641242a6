"""`sdph.run`, `sdph.resume` and `sdph.stepping`: runs from Python, on the driver of the command line."""

from __future__ import annotations

import contextlib
import os
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, TypedDict, Unpack

import numpy as np

from sdph.api import launch
from sdph.api.case import Case
from sdph.api.results import Run, arrays, cells, load
from sdph.running import compiling, driver, output
from sdph.running.progress import Reporter
from sdph.show import timeline

PathLike = str | os.PathLike[str]
OF_GAS = {"gas": "coupling.gas", "transport": "coupling.transport", "ranks": "coupling.gas_ranks"}


class Window:
    """A run right after one of its windows; it is of that moment, and changes nothing."""

    def __init__(self, flight: driver.Flight) -> None:
        self.folder: Path = flight.folder
        self._simulation = flight.simulation

    @property
    def time(self) -> float:
        """Time of the run [s]."""
        return float(self._simulation.time)

    @property
    def number(self) -> int:
        """Windows since the start, this one included."""
        return int(self._simulation.windows)

    @property
    def ledger(self) -> dict[str, float]:
        """Row of ledger.csv of this window."""
        return dict(self._simulation.ledger.last)

    @property
    def history(self) -> dict[str, float]:
        """Row of history.csv as it would be now."""
        return dict(self._simulation.row())

    @property
    def fields(self) -> timeline.Instant:
        """Time [s], particles and gas (None without one) as pyvista meshes."""
        meshes = self._simulation.meshes()
        gas = meshes.pop("gas", None)
        return timeline.Instant(self.time, timeline.together(list(meshes.values())), gas and gas.copy())

    @property
    def particles(self) -> dict[str, np.ndarray]:
        """Arrays of the particles by name, `position` (N, 3) [m] among them."""
        return arrays(self.fields.particles)

    @property
    def gas(self) -> dict[str, np.ndarray]:
        """Arrays of the gas by name, a value a cell, `centre` (M, 3) [m] among them; `CaseError` without a gas."""
        return cells(self.fields.gas, self.folder)

    def __repr__(self) -> str:
        return f"<window {self.number} of {self.folder}: t = {self.time:.6g} s>"


class Stepping(Iterator[Window]):
    """Windows of a run as it goes; `close` (or leaving a `with`) ends it early with a checkpoint, and `result` is the
    run in its folder, as far as it went."""

    def __init__(self, flights: Any, folder: Path, reporter: Reporter) -> None:
        self.folder, self._flights, self._reporter = folder, flights, reporter

    def __next__(self) -> Window:
        try:
            return Window(next(self._flights))
        except BaseException:
            self._reporter.close()
            raise

    def close(self) -> None:
        """End the run after the window that it is at; `sdph.resume` goes on with it."""
        self._flights.close()
        self._reporter.close()

    @property
    def result(self) -> Run:
        """The run in its folder."""
        return load(self.folder)

    def __enter__(self) -> Stepping:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()


class Voice(Reporter):
    """Reporter that hands warnings to Python's own; what else there is to say it says on stderr where `loud`, and that
    kernels are compiled always: minutes of silence look like a run that hangs."""

    def __init__(self, loud: bool) -> None:
        super().__init__(quiet=not loud)
        self.waiting = Reporter(line=False)

    def status(self, text: str) -> None:
        if text.startswith("warning: "):
            warnings.warn(text.removeprefix("warning: "), UserWarning, stacklevel=2)
        elif text == compiling.TEXT and self.quiet:
            self.waiting.status(text)
        else:
            super().status(text)


class Options(TypedDict, total=False):
    """Options of `run` and `stepping`, each may be left out."""

    gas: str | None  # "openfoam" or "embedded"; default: openfoam where it is
    out: PathLike | None  # a new folder; default: runs/NAME, numbered
    until: float | None  # end time [s]
    ranks: int | None  # MPI ranks of OpenFOAM
    transport: str | None  # "socket" or "file": how fields travel to OpenFOAM
    progress: bool  # say on stderr where it is
    allow_code: bool  # let the OpenFOAM files of the case run code


def stepping(case: Case | PathLike, **options: Unpack[Options]) -> Stepping:
    """A run that is stepped: `for window in sdph.stepping(case): ...`; `Options` say what may be given.

    Whoever leaves the loop early finds a checkpoint in the folder: `sdph.resume(folder)` goes on from there.
    """
    unknown = options.keys() - Options.__annotations__.keys()
    if unknown:
        raise TypeError(f"unknown option {min(unknown)}; known: {', '.join(Options.__annotations__)}")
    own, allow_code = _with_options(case, options), options.get("allow_code", False)
    template, reporter = own.gas_folder, Voice(options.get("progress", False))
    for warning in launch.looked_at(own.resolved, template, allow_code=allow_code):
        reporter.status(f"warning: {warning}")
    folder = Path(options.get("out") or output.free_name(Path("runs") / own.name))
    flights = driver.stepping(own.resolved, own.name, folder, template, reporter, allow_code=allow_code)
    return Stepping(flights, folder, reporter)


def run(
    case: Case | PathLike, *, callback: Callable[[Window], object] | None = None, **options: Unpack[Options]
) -> Run:
    """Run a case (or scene, folder, file) to its end; the finished run.

    `Options` say what may be given. `callback` is called with the `Window` after each window.
    """
    with stepping(case, **options) as windows:
        for window in windows:
            if callback:
                callback(window)
    return windows.result


def resume(folder: PathLike, *, until: float | None = None, progress: bool = False, allow_code: bool = False) -> Run:
    """Go on with a run from its last checkpoint, to another end [s] where one is given; the finished run."""
    overrides = () if until is None else (f"run.end_time_s={float(until)!r}",)
    with contextlib.closing(Voice(progress)) as reporter:
        driver.resume(Path(folder), overrides, reporter, allow_code=allow_code)
    return load(folder)


def _with_options(case: Case | PathLike, options: Options) -> Case:
    """A copy of the case with what was given beside it."""
    own = Case.of(case).copy()
    of_gas = {name: options.get(name) for name in OF_GAS}
    launch.refuse_useless(own.resolved, own.name, of_gas)
    changes = {OF_GAS[name]: value for name, value in of_gas.items() if value is not None}
    if (until := options.get("until")) is not None:
        changes["run.end_time_s"] = float(until)
    own.update(changes)
    return own
