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

from coupling.gas import GasError
from coupling.openfoam.programs import barrier, install

LOOK = 0.2  # s between two looks at a running solver
TELL = 10.0  # s between two lines on where it is
TAIL = 20000  # bytes of a log that are looked through

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
    begun = last = time.perf_counter()
    try:
        while process.poll() is None:
            time.sleep(LOOK)
            if time.perf_counter() - last > TELL:
                last = time.perf_counter()
                _tell(log, end, last - begun)
    finally:
        _end(process)
    if process.returncode:
        raise GasError(
            f"{command[0]} {ending(process.returncode)} at {solver_time(log):g} s: {reason(log)} (log: {log})"
        )


def _tell(log: Path, end: float, spent: float) -> None:
    """Say where the solver of a log is, `spent` [s] after it began."""
    now = solver_time(log)
    left = f", {spent * (end - now) / now:.0f} s left" if now > 0.0 else ""
    for tell in _HEARS:
        tell(f"{log.name.removeprefix('log.')}: t = {now:.4g} of {end:g} s{left}")


def _end(process: subprocess.Popen) -> None:
    """End a program, mpirun's ranks included."""
    if process.poll() is None:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()


def solver_time(log: Path) -> float:
    """The last time [s] that a solver's log names; 0 before the first."""
    found = re.findall(rb"^Time = (\d[\d.e+-]*)", _tail(log), re.MULTILINE)
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
