"""`sdph run`: a run from its case, or from its last checkpoint, to its summary.

A `Simulation` of grains in a gas, a liquid beside them or not, or a liquid or solids `Alone`, or `Together`. All have:

    start()  take_up(checkpoint)  window()                             how it goes
    time  windows  at_row  clock (sdph.engine.clock)                   where it is
    row()  meshes()  walls()  ledger  wall  summary(out)  warnings()  notices   what it has to show
    KEPT  gas                                                          what a checkpoint holds
"""

from __future__ import annotations

import contextlib
import errno
import math
import os
import shutil
import time
from pathlib import Path

from coupling.choice import open_gas
from coupling.gas import CheckpointError, GasError
from coupling.shared import SharedGas
from sdph import effects
from sdph.case import read as cases
from sdph.engine import contact, restart, world
from sdph.engine import device as environment
from sdph.engine.guard import Unstable
from sdph.engine.kept import Maybe, Unfit
from sdph.engine.ledger import Ledger
from sdph.methods.liquids.liquid import Liquid
from sdph.running import balances, chain, compiling, forces, hastened, inputs, on_device, output, ranks, vessel
from sdph.running.interruption import Stopped, listening
from sdph.running.outputs import Outputs
from sdph.running.simulation import Simulation
from sdph.scenes import paths
from sdph.schema import CaseError

NO_ROOM = [os.strerror(code) for code in (errno.ENOSPC, errno.EDQUOT, errno.EROFS)]  # as the gas solver says it too
FULL = 2**16  # bytes: with less, programs that do not say why they failed have failed for lack of room


def run(case, name: str, folder: Path, gas_folder: Path | None, reporter, *, allow_code: bool = False) -> dict:
    """Run a case into a new folder and return its summary; arguments as of `stepping`."""
    return _to_its_end(stepping(case, name, folder, gas_folder, reporter, allow_code=allow_code))


def _to_its_end(windows) -> dict:
    """The summary of a run that goes by its windows."""
    while True:
        try:
            next(windows)
        except StopIteration as end:
            return end.value


def stepping(case, name: str, folder: Path, gas_folder: Path | None, reporter, *, allow_code: bool = False):
    """Run a case into a new folder and yield its `Flight` after each window; who stops asking finds a checkpoint there.

    `gas_folder` holds the user's own OpenFOAM case (None: the scene's template), whose dictionaries may run code only
    with `allow_code`; `reporter` shows progress.
    """
    template = gas_folder or template_of(case, name)
    inputs.check(case)
    on_device.refuse(case)
    alone = not folder.parent.exists()
    with output.claimed(output.create(folder)):
        try:
            case = inputs.prepare(case, folder, template, allow_code)
            case = chain.made(case, folder, run, resume, reporter)
            return (yield from _guarded(Flight(case, folder, reporter), None, inputs.gas_of(folder), allow_code))
        except CaseError:
            if not restart.newest(folder):  # the case cannot be run: as if it had not been tried
                shutil.rmtree(folder)
                if alone and not any(folder.parent.iterdir()):
                    folder.parent.rmdir()
            raise


def template_of(case, name: str, file: Path | None = None) -> Path:
    """The OpenFOAM case of a case: what comes with its `file`, else the template of its scene, or of `name`."""
    return (file and inputs.beside(file)) or paths.gas_template(case.scene or name)


def resume(folder: Path, overrides: tuple[str, ...], reporter, *, allow_code: bool = False) -> dict:
    """Go on with a run from its newest whole checkpoint, or from its start where it has none; its summary.

    The run folder may come from elsewhere: its OpenFOAM case may run code only with `allow_code`, given anew."""
    if not (folder / output.MARK).is_file() or not (folder / output.ORIGIN).is_file():
        raise CaseError(f"{folder} holds no run to go on with; run it anew")
    case = cases.load(folder / output.MARK, overrides)
    inputs.check(case)
    on_device.refuse(case, world.here().number)
    with ranks.claimed(folder):
        if world.here().chief:
            restart.prepare(folder)
        checkpoint = restart.newest(folder, reporter.status)
        if checkpoint:
            checkpoint.refuse_other(cases.to_table(inputs.seen_from(case, folder)))
        elif restart.numbered(folder):
            raise CaseError(
                f"{folder} has no whole checkpoint; to begin again remove {folder / restart.FOLDER}, or run anew"
            )
        else:
            if world.here().number == 1:
                reporter.status(f"{folder} has no checkpoint: it begins again")
            if world.here().chief:
                output.clear(folder)
            case = chain.made(inputs.keep(case, folder), folder, run, resume, reporter)
        template = None if checkpoint else inputs.gas_of(folder)
        return _to_its_end(_guarded(Flight(case, folder, reporter), checkpoint, template, allow_code))


def simulation_of(case, gas, ledger: Path | None):
    """Simulation of a case: a liquid or solids alone (`gas` is None), or grains in a gas, beside a liquid where the
    case has one; its ledgers go to new files, or to none."""
    if "grains" not in case.matters:
        return hastened.of(case, ledger)
    simulation = Simulation(case.only("grains"), gas, Ledger(ledger, case, gas.mesh.depth, *effects.in_ledger(case)))
    if case.liquid:
        liquid = Liquid(case.only("liquid"), ledger.with_name("ledger_liquid.csv"), simulation.clock.shortest)
        simulation.beside.add(liquid, contact.between(case))
    return simulation


def _guarded(run: Flight, checkpoint, template: Path | None, allow_code: bool):
    """The windows of a run; where it fails, the folder says why, and the error says how to go on."""
    try:
        told = compiling.told(run.reporter.status)
        with listening() as wish, told, _gas_of(run, template, allow_code) as gas:
            return (yield from run.go(gas, checkpoint, wish))
    except OSError as error:
        failure = output.CannotWrite(
            f"{run.folder} cannot be written: {error.strerror or error}; make room or give another folder"
        )
        raise run.failed(failure) from error
    except (RuntimeError, CaseError, Stopped) as error:
        raise run.failed(error)  # noqa: B904  (the same error with a note, as a rule)


def _gas_of(run: Flight, template: Path | None, allow_code: bool):
    """A context with the gas of a run, closed in the end; None where there is none."""
    if "grains" not in run.case.matters:
        return contextlib.nullcontext()
    own = run.world
    gas = own.chief and open_gas(run.case.only("grains"), run.folder, template, run.reporter.status, allow_code)
    return contextlib.closing(gas if own.number == 1 else SharedGas(gas, own))


class Flight:
    """A run as it goes: windows, what they leave behind, and checkpoints."""

    KEPT, FORMS = ("simulation", "out", "spent", "first"), {"first": Maybe(0.0)}  # see sdph.engine.kept

    def __init__(self, case, folder: Path, reporter):
        self.case, self.folder, self.reporter, self.world = case, folder, reporter, world.here()
        self.begun, self.goes = time.perf_counter(), False
        self.simulation, self.elapsed = None, 0.0  # wall time [s] of the parts of the run before this one
        self.first = None  # wall time [s] to the end of the first window
        self.saved_time, self.saved_window = time.monotonic(), 0
        self.saving = 0.0  # wall time [s] of the last checkpoint

    @property
    def spent(self) -> float:
        """Wall time [s] of the run."""
        return self.elapsed + time.perf_counter() - self.begun

    @spent.setter
    def spent(self, before: float) -> None:
        self.elapsed = before

    def go(self, gas, checkpoint, wish):
        """Run from the start, or from a checkpoint, window by window to the summary; `gas` None without grains."""
        self._begin(gas, checkpoint)
        if self.world.chief:
            output.write_text(self.folder / output.MARK, cases.dumps(inputs.seen_from(self.case, self.folder)))
            output.forget(self.folder, self.simulation.clock.over(self.simulation.time))
        self.goes = wish.patient = True
        with contextlib.closing(self.out):
            while not self.simulation.clock.over(self.simulation.time):
                begun = time.monotonic()
                self._window()
                if gas is None:  # one that hangs is not waited for
                    wish.allow(time.monotonic() - begun + self.saving)
                yield from self._shown()
                asked = self.world.most(wish.number or 0) or None  # one is asked to stop: all are
                if asked or self._due():
                    self._save()
                wish.obey(asked)
            self._save()
        summary = self.out.summary() | {"start_to_first_window_s": self.first, "wall_s": self.spent}
        if self.world.chief:
            output.write_summary(self.folder, summary)
        for warning in (*environment.warnings(), *self.simulation.warnings(), *balances.missed(summary)):
            self.reporter.status(f"warning: {warning}")
        return summary

    def _shown(self):
        """Yield the run as it is; a checkpoint is left where nobody asks for more."""
        try:
            yield self
        except GeneratorExit:
            self._save()
            raise

    def failed(self, error: BaseException) -> BaseException:
        """The error with a note on how to go on; failure.json keeps what happened. A run that was refused is as it
        was."""
        if isinstance(error, CaseError) and not self.goes:
            return error
        ranks.wait_for_the_first()
        checkpoint = restart.newest(self.folder)
        full = shutil.disk_usage(self.folder).free < FULL
        if isinstance(error, GasError) and (full or any(why in str(error) for why in NO_ROOM)):
            error = output.CannotWrite(f"{error}; make room or give another folder")
        if full:
            error.add_note(f"(No space left on the disk of {self.folder})")
        if checkpoint:
            error.add_note(restart.told(checkpoint, self.folder))
        time_s = self.simulation.time if self.simulation else 0.0
        with contextlib.suppress(OSError):
            if isinstance(error, Unstable):
                error.leave(self.folder)
                error.add_note(f"last good state: {self.folder}/last_good.npz and .png")
            output.write_json(
                self.folder / output.FAILURE, {"what": str(error), "kind": type(error).__name__, "time_s": time_s}
            )
        return error

    def _begin(self, gas, checkpoint) -> None:
        self.case = self.world.told(self.world.chief and vessel.walled(self.case, gas, self.folder))
        ledger = self.folder / "ledger.csv" if self.world.chief else None
        simulation = simulation_of(self.case, gas, ledger)
        self.simulation, self.out = simulation, Outputs(self.folder, simulation, self.world)
        if checkpoint is None:
            forces.refuse_nowhere(self.case, simulation.methods)
            mesh = vessel.own_mesh(gas, self.folder)
            vessel.refuse_beside(self.case, mesh)
            vessel.refuse_outside(self.case, vessel.Cells(self.case, mesh), simulation.state, self.world)
            simulation.start()
            self.out.start()
            self._save()
            return
        self.reporter.status(f"going on from {checkpoint.folder}")
        checkpoint.fill(self, lambda kept: self._take_up(checkpoint, kept["simulation"]))

    def admit(self, kept: dict) -> None:
        """Unfit where time, windows or wall times are not those of a run."""
        run = kept["simulation"]
        windows, time_s, wall = self.simulation.windows_of(run), self.simulation.time_of(run), run["wall"]
        if windows < 0 or time_s < 0.0 or (windows == 0) != (time_s == 0.0) or min(kept["spent"], *wall.values()) < 0.0:
            raise Unfit("its windows, time and wall time are not those of a run")
        if windows and not wall["particles"] > 0.0:
            raise Unfit("its particles took no time")

    def _take_up(self, checkpoint, kept: dict) -> None:
        """Take up a checkpoint, the gas first: where that fails, the run is as it was."""
        if (self.simulation.windows_of(kept), self.simulation.time_of(kept)) != (checkpoint.number, checkpoint.time):
            raise Unfit("its windows and time are not those that its name and manifest tell")
        try:
            self.simulation.take_up(checkpoint)
        except CheckpointError as error:
            raise checkpoint.refuse(error) from None

    def _window(self) -> None:
        self.simulation.window()
        self._pass_on()
        self.first = self.first or self.spent
        self.out.window()
        self.reporter.progress(self.simulation)

    def _pass_on(self) -> None:
        """Tell the user what the simulation has to say."""
        for notice in self.simulation.notices:
            self.reporter.status(notice)
        self.simulation.notices.clear()

    def _due(self) -> bool:
        """True where it is time for a checkpoint."""
        windows = self.case.run.checkpoint_windows or math.inf
        late = time.monotonic() - self.saved_time >= self.case.run.checkpoint_interval
        return self.world.told(late) or self.simulation.windows - self.saved_window >= windows

    def _save(self) -> None:
        begun = time.monotonic()
        table, now = cases.to_table(inputs.seen_from(self.case, self.folder)), self.simulation
        with now.whole() as chief:
            if chief:
                restart.write(self.folder, now.windows, now.time, table, self, now.gas)
        self.world.told(None)  # all wait until it is there
        self.saved_time, self.saved_window = time.monotonic(), self.simulation.windows
        self.saving = self.saved_time - begun
