"""Runs OpenFOAM's own programs on a case folder, serial or under MPI, and says what went wrong when they fail."""

from __future__ import annotations

import contextlib
import os
import re
import signal
import subprocess
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import BinaryIO, NamedTuple

from coupling.gas import GasError
from coupling.openfoam.programs import barrier, install

LOOK = 0.2  # s between two looks at a running solver
TELL = 10.0  # s between two lines on where it is
TAIL = 20000  # bytes of a log that are looked through

# A solver stands still when one step takes more of the processor than these allow: a paused program, a busy machine or
# a slow disk take none. All our choice, on the long side: an end too early costs a run, one too late some minutes.
MANY = 100  # times the longest step before: room for one that writes fields, or whose equations settle badly
STILL = 60.0  # s at least: room for steps of some 0.1 s that grow as droplets come in
KNOWN = 3  # steps that must be done for these two; before, there is nothing to measure by
FIRST = 1800.0  # s at least until then: a large mesh is read, and equations start from nothing
QUIET, FEW = 10.0, 5  # s and longest steps, by the clock, after which it is told that a solver stands still

TIME = re.compile(rb"^Time = (\d[\d.e+-]*)", re.MULTILINE)
HINTS = {  # on why a solver stands still, by what its name has
    "Parcel": "; OpenFOAM's tracking of parcels can loop for ever where walls meet at an angle: other walls or cells "
    "may help",
}

# lines of a solver that goes on well
CHATTER = re.compile(r"residual|continuity errors|^(Time = |ExecutionTime|Courant|PIMPLE|//)|^\W*$")
MEMORY = " (by somebody, or by the system because memory ran out)"

_HEARS: list[Callable[[str], None]] = []  # who hears of running solvers


def run(command: list[str], folder: Path, log: Path, environment: dict[str, str] | None = None) -> None:
    """Run a short program to its end, with no code of the case unless `environment` lets it."""
    variables = environment or barrier.environment()
    with log.open("wb") as out, starting(command[0]):
        process = subprocess.run(command, cwd=folder, env=variables, stdout=out, stderr=subprocess.STDOUT, check=False)
    if process.returncode:
        raise GasError(f"{command[0]} {ending(process.returncode)}: {reason(log)} (log: {log})")


@contextlib.contextmanager
def told(tell: Callable[[str], None]) -> Iterator[None]:
    """Within the context `tell` hears every ten seconds where a solver is, and how long it will take."""
    _HEARS.append(tell)
    try:
        yield
    finally:
        _HEARS.remove(tell)


def say(text: str) -> None:
    """Tell a line to all who hear."""
    for tell in _HEARS:
        tell(text)


@contextlib.contextmanager
def starting(program: str) -> Iterator[None]:
    """Turn the error of a program that is not there, or not for this machine, into a `GasError`."""
    try:
        yield
    except OSError as error:
        raise GasError(f"{program} cannot be started: {error.strerror}; sdph doctor says what is missing") from None


def run_solver(solver: str, folder: Path, log: Path, end: float, environment: dict[str, str], ranks: int) -> None:
    """Run a solver to its end [s], on `ranks` processes."""
    if ranks == 1:
        return _watch([solver], folder, log, end, environment)
    run(["decomposePar", "-force"], folder, folder / "log.decomposePar", environment)
    _watch([*install.mpirun(ranks), solver, "-parallel"], folder, log, end, environment)
    run(["reconstructPar"], folder, folder / "log.reconstructPar", environment)


def _watch(command, folder: Path, log: Path, end: float, environment: dict[str, str]) -> None:
    with log.open("wb") as out, starting(command[0]):
        process = subprocess.Popen(
            command, cwd=folder, env=environment, stdout=out, stderr=subprocess.STDOUT, start_new_session=True
        )
    try:
        with log.open("rb") as told:
            _attend(process, Steps(told, process.pid), log, end)
    finally:
        _end(process)
    if process.returncode:
        raise GasError(
            f"{command[0]} {ending(process.returncode)} at {solver_time(log):g} s: {reason(log)} (log: {log})"
        )


def _attend(process: subprocess.Popen, steps: Steps, log: Path, end: float) -> None:
    """Wait for the end of a solver, and tell where it is; `GasError` when it stands still."""
    last = time.perf_counter()
    while process.poll() is None:
        time.sleep(LOOK)
        steps.look()
        if steps.still.processor > steps.allowed():
            raise GasError(_stands(steps, log))
        if time.perf_counter() - last > TELL:
            last = time.perf_counter()
            _tell(steps, log, end)


class Clocks(NamedTuple):
    """Times [s] by the clock and of the processor."""

    wall: float
    processor: float


class Steps:
    """Steps of a running solver, whose times its log names, and what they take.

    `time` [s] is the last one named, `count` how many were, `moved` when that was, from the start on; `still` is how
    long that is ago, `longest` the longest between two looks that saw a new one, which is a step or several short ones.
    """

    def __init__(self, log: BinaryIO, pid: int):
        self._log, self._pid, self._begun, self._rest = log, pid, time.perf_counter(), b""
        self.time, self.count = 0.0, 0
        self.moved = self.still = self.longest = Clocks(0.0, 0.0)

    def look(self) -> None:
        """Read what the log has since the last look."""
        text = self._rest + self._log.read()
        whole = text.rfind(b"\n") + 1
        self._rest, found = text[whole:], TIME.findall(text[:whole])
        now = Clocks(time.perf_counter() - self._begun, processor_time(self._pid))
        self.still = Clocks(now.wall - self.moved.wall, now.processor - self.moved.processor)
        if found:
            if self.count:
                self.longest = Clocks(*map(max, self.longest, self.still))
            self.time, self.count = float(found[-1]), self.count + len(found)
            self.moved, self.still = now, Clocks(0.0, 0.0)

    def allowed(self) -> float:
        """Processor time [s] that the step may take."""
        return max(STILL if self.count > KNOWN else FIRST, MANY * self.longest.processor)


def processor_time(pid: int) -> float:
    """Processor time [s] of a process or one that it started (a rank under mpirun), of which has most; 0 if it is
    gone."""
    return max(map(_processor_time, _family(pid)))


def _processor_time(pid: int) -> float:
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()  # from the third on, see proc(5)
    except OSError:  # it ended meanwhile
        return 0.0
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def _family(pid: int) -> list[int]:
    """Numbers of a process and of all that it started and that run."""
    found = []
    with contextlib.suppress(OSError):  # it ended meanwhile
        for task in Path(f"/proc/{pid}/task").glob("*/children"):
            found += map(int, task.read_text().split())
    return [pid, *(each for child in found for each in _family(child))]


def _stands(steps: Steps, log: Path) -> str:
    """Line on a solver that stands still."""
    name, hint = _name(log), ""
    if steps.count > 1:
        hint = f"; steps before took {max(LOOK, steps.longest.processor):.1g} s at most: compare a run that ends before"
        hint += f" that time (sdph run with --until less than {steps.time:g})"
    hint += "".join(text for part, text in HINTS.items() if part in name)
    return (
        f"{name} stands still at {steps.time:g} s since {steps.still.wall:.0f} s, {steps.still.processor:.0f} s of the "
        f"processor, and was ended (log: {log}){hint}"
    )


def _tell(steps: Steps, log: Path, end: float) -> None:
    """Say where a solver is, and how long it will take or that it stands still."""
    more = f", {steps.moved.wall * (end - steps.time) / steps.time:.0f} s left" if steps.time > 0.0 else ""
    if steps.still.wall > max(QUIET, FEW * steps.longest.wall):
        more = f", stands still since {steps.still.wall:.0f} s"
    say(f"{_name(log)}: t = {steps.time:.4g} of {end:g} s{more}")


def _name(log: Path) -> str:
    """Name of the solver of a log."""
    return log.name.removeprefix("log.")


def _end(process: subprocess.Popen) -> None:
    """End a program, mpirun's ranks included."""
    if process.poll() is None:
        family = _family(process.pid)  # ranks are groups of their own, and one in an endless loop outlives mpirun
        os.killpg(process.pid, signal.SIGKILL)
        for each in family[1:]:
            with contextlib.suppress(ProcessLookupError):  # it was of the group
                os.kill(each, signal.SIGKILL)
        process.wait()


def solver_time(log: Path) -> float:
    """The last time [s] that a solver's log names; 0 before the first."""
    found = TIME.findall(_tail(log))
    return float(found[-1]) if found else 0.0


def ending(code: int) -> str:
    """The end of a program, from its return code; mpirun gives 128 + signal of its rank."""
    number = -code if code < 0 else code - 128
    if number not in signal.valid_signals():
        return f"ended with code {code}"
    return f"was killed by {signal.Signals(number).name}{MEMORY if number == signal.SIGKILL else ''}"


def reason(log: Path) -> str:
    """Reason that a program ended, in one line: the cause that its log names, else its last line, unless that is of a
    solver that goes on well."""
    last = (_tail(log).decode(errors="replace").strip().splitlines() or ["it wrote no log"])[-1]
    return cause(log) or (
        f"its log breaks off at {solver_time(log):g} s without a cause" if CHATTER.search(last) else last
    )


def cause(log: Path) -> str:
    """The cause of a program's end that its log names, in one line; empty where it names none."""
    text = _tail(log).decode(errors="replace")
    fatal = re.search(r"FOAM FATAL (?:IO )?ERROR:?\s*(.*?)(?:\n\n|\n\s*From |\Z)", text, re.DOTALL)
    if fatal:
        return " ".join(fatal.group(1).split())
    if told := re.findall(r"^sdphGasFoam: (.+)$", text, re.MULTILINE):
        return told[-1]
    if signalled := re.search(r"sigFpe|sigSegv|Floating point exception|Segmentation fault", text):
        return signalled.group(0)
    if rank := re.search(r"mpirun noticed that process (rank \d+) .* exited on (signal \d+ \(.*\))", text):
        return f"{rank.group(1)} exited on {rank.group(2)}"
    return (
        "one of its processes was killed or failed without a word" if "returned\na non-zero exit code" in text else ""
    )


def _tail(log: Path) -> bytes:
    with log.open("rb") as text:
        text.seek(0, os.SEEK_END)
        text.seek(max(0, text.tell() - TAIL))
        return text.read()


def end_group(process: subprocess.Popen) -> None:
    """End a process and all that it started; mpirun is asked first, since it ends its ranks itself."""
    if process.poll() is None:
        process.terminate()
        with contextlib.suppress(subprocess.TimeoutExpired):  # it is killed next
            process.wait(1.0)
    with contextlib.suppress(ProcessLookupError):  # nothing of the group is left
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()
