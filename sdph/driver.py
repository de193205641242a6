"""`sdph run`: a run from its case, or from its last checkpoint, to its summary.

What is run is a `Simulation` of grains in a gas or a `LiquidRun`. The driver knows of both only what both have:

    start()  take_up(folder of the gas's checkpoint)  window()         how it goes
    time  windows  at_row  clock.outputs  clock.limit                  where it is
    row()  meshes()  walls()  ledger  wall  summary(out)  warnings()   what it has to show
    KEPT  gas                                                          what a checkpoint holds
"""

from __future__ import annotations

import contextlib
import math
import shutil
import time
from pathlib import Path

from sdph import case as cases
from sdph import environment, metrics, output, paths, restart
from sdph.guard import Unstable
from sdph.interruption import Stopped, listening
from sdph.ledger import Ledger
from sdph.schema import CaseError
from sdph.simulation import Simulation

FULL = 2**16  # bytes: with less, programs that do not say why they failed have failed for lack of room


def run(case, name: str, folder: Path, gas_folder: Path | None, reporter, *, allow_code: bool = False) -> dict:
    """Run a case into a new folder and return its summary.

    `gas_folder` holds the user's own OpenFOAM case (None: the scene's template), whose dictionaries may run code only
    with `allow_code`; `reporter` shows progress.
    """
    template = gas_folder or template_of(case, name)
    with output.claimed(output.create(folder)):
        try:
            output.write_origin(folder, gas_template=str(template.resolve()), allow_code=allow_code)
            output.write_text(folder / output.MARK, cases.dumps(case))
            return _guarded(Run(case, folder, reporter), None, template, allow_code)
        except CaseError:
            if not restart.newest(folder):  # the case cannot be run: as if it had not been tried
                shutil.rmtree(folder)
            raise


def template_of(case, name: str, file: Path | None = None) -> Path:
    """The OpenFOAM case of a case: the folder gas beside its `file`, else the template of its scene, or of `name`."""
    own = file and file.parent / "gas"
    return own if own and own.is_dir() else paths.gas_template(case.scene or name)


def resume(folder: Path, overrides: tuple[str, ...], reporter) -> dict:
    """Go on with a run from its newest whole checkpoint, or from its start where it has none; its summary."""
    if not (folder / output.MARK).is_file() or not (folder / output.ORIGIN).is_file():
        raise CaseError(f"{folder} holds no run to go on with; run it anew")
    case = cases.load(folder / output.MARK, overrides)
    with output.claimed(folder):
        checkpoint = restart.newest(folder, reporter.status)
        if checkpoint:
            checkpoint.refuse_other(cases.to_table(case))
        else:
            reporter.status(f"{folder} has no checkpoint: it begins again")
            output.clear(folder)
        origin = output.read_origin(folder)
        template = None if checkpoint else Path(origin["gas_template"])
        return _guarded(Run(case, folder, reporter), checkpoint, template, origin["allow_code"])


def open_gas(case, folder: Path, template: Path | None, status, allow_code: bool = False):
    """The gas solver that the case asks for; `auto` takes OpenFOAM where it is built, else the embedded one.

    `template` None goes on with the OpenFOAM case that is in `folder`.
    """
    if chosen_gas(case, status) == "embedded":
        from coupling.embedded import EmbeddedGas

        return EmbeddedGas(case)
    from coupling.openfoam.solver import OpenFoamGas

    return OpenFoamGas(case, folder / "gas", template, status=status, allow_code=allow_code)


def chosen_gas(case, status) -> str:
    """"openfoam" or "embedded": what solves the gas of a case on this machine."""
    if case.domain.periodic:
        raise CaseError(f"domain.periodic = {list(case.domain.periodic)}, but no gas solver has periodic sides; leave it out")
    if case.coupling.gas != "auto":
        return case.coupling.gas
    from coupling.openfoam import install

    if install.find():
        return "openfoam"
    status("OpenFOAM was not found: the gas is solved by the embedded solver (sdph openfoam setup --install gets it)")
    return "embedded"


def simulation_of(case, gas, ledger: Path):
    """What runs a case: a liquid (`gas` is None), or grains in a gas; its ledger goes to a new file."""
    if case.liquid:
        from sdph.liquid.run import LiquidRun

        return LiquidRun(case, ledger)
    return Simulation(case, gas, Ledger(ledger, case, gas.mesh.depth))


def _guarded(run: Run, checkpoint, template: Path | None, allow_code: bool) -> dict:
    """The summary of a run; where it fails, the folder says why, and the error says how to go on."""
    try:
        with listening() as wish:
            with _gas_of(run, template, allow_code) as gas:
                return run.go(gas, checkpoint, wish)
    except OSError as error:
        failure = output.CannotWrite(f"{run.folder} cannot be written: {error.strerror or error}; make room or give another folder")
        raise run.failed(failure) from error
    except (RuntimeError, CaseError, Stopped) as error:
        raise run.failed(error)


def _gas_of(run: Run, template: Path | None, allow_code: bool):
    """A context with the gas of a run, closed in the end; None where there is none."""
    if run.case.liquid:
        return contextlib.nullcontext()
    return contextlib.closing(open_gas(run.case, run.folder, template, run.reporter.status, allow_code))


class Run:
    """A run as it goes: windows, what they leave behind, and checkpoints."""

    KEPT = ("simulation", "out", "spent", "first")  # see sdph.restart

    def __init__(self, case, folder: Path, reporter):
        self.case, self.folder, self.reporter = case, folder, reporter
        self.begun, self.goes = time.perf_counter(), False
        self.simulation = None
        self.elapsed = 0.0  # wall time [s] of the parts of the run before this one
        self.first = None  # wall time [s] to the end of the first window
        self.saved_time, self.saved_window = time.monotonic(), 0

    @property
    def spent(self) -> float:
        """Wall time [s] of the run."""
        return self.elapsed + time.perf_counter() - self.begun

    @spent.setter
    def spent(self, before: float) -> None:
        self.elapsed = before

    def go(self, gas, checkpoint, wish) -> dict:
        """From the start, or from a checkpoint, to the summary; `gas` None for a liquid."""
        self._begin(gas, checkpoint)
        output.write_text(self.folder / output.MARK, cases.dumps(self.case))
        (self.folder / output.FAILURE).unlink(missing_ok=True)
        self.goes = wish.patient = True
        with contextlib.closing(self.out):
            while self.simulation.time < self.case.run.end_time:
                self._window()
                if wish.number is not None or self._due():
                    self._save()
                wish.obey()
            self._save()
        summary = _summary(self.simulation, self.out) | {"start_to_first_window_s": self.first, "wall_s": self.spent}
        output.write_summary(self.folder, summary)
        for warning in (*environment.warnings(), *self.simulation.warnings()):
            self.reporter.status(f"warning: {warning}")
        return summary

    def failed(self, error: BaseException) -> BaseException:
        """The error with a note on how to go on; failure.json keeps what happened. A run that was refused is as it was."""
        if isinstance(error, CaseError) and not self.goes:
            return error
        checkpoint = restart.newest(self.folder)
        if shutil.disk_usage(self.folder).free < FULL:
            error.add_note(f"(No space left on the disk of {self.folder})")
        if checkpoint:
            error.add_note(f"(last checkpoint: {checkpoint.folder}; go on with: sdph run --resume {self.folder})")
        time_s = self.simulation.time if self.simulation else 0.0
        with contextlib.suppress(OSError):
            if isinstance(error, Unstable):
                error.leave(self.folder)
                error.add_note(f"last good state: {self.folder}/last_good.npz and .png")
            output.write_json(self.folder / output.FAILURE, {"what": str(error), "kind": type(error).__name__, "time_s": time_s})
        return error

    def _begin(self, gas, checkpoint) -> None:
        simulation = simulation_of(self.case, gas, self.folder / "ledger.csv")
        self.simulation, self.out = simulation, Outputs(self.folder, simulation)
        if checkpoint is None:
            simulation.start()
            self.out.start()
            self._save()
            return
        self.reporter.status(f"going on from {checkpoint.folder}")
        checkpoint.fill(self)
        simulation.take_up(checkpoint.gas)

    def _window(self) -> None:
        self.simulation.window()
        self.first = self.first or self.spent
        self.out.window()
        self.reporter.progress(self.simulation)

    def _due(self) -> bool:
        """Whether it is time for a checkpoint."""
        windows = self.case.run.checkpoint_windows or math.inf
        apart = time.monotonic() - self.saved_time
        return apart >= self.case.run.checkpoint_interval or self.simulation.windows - self.saved_window >= windows

    def _save(self) -> None:
        restart.write(self.folder, self.simulation.windows, self.simulation.time, cases.to_table(self.case), self, self.simulation.gas)
        self.saved_time, self.saved_window = time.monotonic(), self.simulation.windows


class Outputs:
    """All that a run writes as it goes: history by row, fields and metrics by output interval."""

    KEPT = ("fields", "history", "metrics", "first", "last", "rows")  # see sdph.restart

    def __init__(self, folder: Path, simulation):
        self.simulation, self.fields = simulation, output.Fields(folder)
        self.history, self.metrics = output.Table(folder / "history.csv"), output.Table(folder / "metrics.csv")
        self.first, self.last, self.rows = {}, {}, []

    def start(self) -> None:
        """The rows and fields of the start, and the walls, which stay as they are."""
        self.fields.write_walls(self.simulation.walls())
        self.first = self.simulation.row()
        self.history.write(self.first)
        self._write()

    def window(self) -> None:
        """After each window."""
        if self.simulation.at_row:
            self.last = self.simulation.row()
            self.history.write(self.last)
        if self.simulation.time in self.simulation.clock.outputs:
            self._write()

    def close(self) -> None:
        for table in (self.history, self.metrics, self.simulation.ledger.table):
            table.close()

    def _write(self) -> None:
        self.fields.write(self.simulation.time, self.simulation.meshes())
        self.rows.append(metrics.row(self.simulation))
        self.metrics.write(self.rows[-1])


def _summary(simulation, out: Outputs) -> dict:
    """summary.json, less the wall time of the whole."""
    case, count = simulation.case, len(simulation.state.x)
    summary = {"title": case.title, "time_s": simulation.time, "particles": count, "windows": simulation.windows}
    summary |= simulation.summary(out) | metrics.summary(case, out.rows) | simulation.ledger.summary()
    summary |= {f"wall_{part}_s": spent for part, spent in simulation.wall.items()}
    summary |= {f"{part}_ms_per_window": 1e3 * spent / simulation.windows for part, spent in simulation.wall.items()}
    return summary | {"particle_steps_per_s": count * simulation.stepper.steps / simulation.wall["particles"]}
