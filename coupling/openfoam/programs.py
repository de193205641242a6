"""Runs OpenFOAM's own programs on a case folder, serial or under MPI, and says what went wrong when they fail."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import time
from collections.abc import Callable
from pathlib import Path

from coupling.gas import GasError
from coupling.openfoam import barrier, install

LOOK = 0.2  # s between two looks at a running solver
TAIL = 20000  # bytes of a log that are looked through

Progress = Callable[[float, float], None]


def run(command: list[str], folder: Path, log: Path, environment: dict[str, str] | None = None) -> None:
    """Run a short program to its end, with no code of the case unless `environment` lets it."""
    variables = environment or barrier.environment()
    with log.open("wb") as out:
        process = subprocess.run(command, cwd=folder, env=variables, stdout=out, stderr=subprocess.STDOUT, check=False)
    if process.returncode:
        raise GasError(f"{command[0]} failed: {reason(log)} (log: {log})")


def run_solver(
    solver: str, folder: Path, log: Path, end: float, progress: Progress | None, environment: dict[str, str], ranks: int
) -> None:
    """Run a solver to its end, on `ranks` processes; `progress(time, end)` [s] hears where it is."""
    if ranks == 1:
        return _watch([solver], folder, log, end, progress, environment)
    run(["decomposePar", "-force"], folder, folder / "log.decomposePar", environment)
    _watch([*install.mpirun(ranks), solver, "-parallel"], folder, log, end, progress, environment)
    run(["reconstructPar"], folder, folder / "log.reconstructPar", environment)


def _watch(command, folder: Path, log: Path, end: float, progress: Progress | None, environment: dict[str, str]) -> None:
    with log.open("wb") as out:
        process = subprocess.Popen(
            command, cwd=folder, env=environment, stdout=out, stderr=subprocess.STDOUT, start_new_session=True
        )
    try:
        while process.poll() is None:
            time.sleep(LOOK)
            if progress:
                progress(solver_time(log), end)
    finally:
        _end(process)
    if process.returncode:
        raise GasError(f"{command[0]} failed at {solver_time(log):g} s: {reason(log)} (log: {log})")


def _end(process: subprocess.Popen) -> None:
    """Nothing is left running, mpirun's ranks included."""
    if process.poll() is None:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()


def solver_time(log: Path) -> float:
    """The last time [s] that a solver's log names; 0 before the first."""
    found = re.findall(rb"^Time = (\S+)$", _tail(log), re.MULTILINE)
    return float(found[-1]) if found else 0.0


def reason(log: Path) -> str:
    """The lines of a log that say why a program ended, in one."""
    text = _tail(log).decode(errors="replace")
    fatal = re.search(r"FOAM FATAL (?:IO )?ERROR:?\s*(.*?)(?:\n\n|\n\s*From |\Z)", text, re.DOTALL)
    if fatal:
        return " ".join(fatal.group(1).split())
    signalled = re.search(r"sigFpe|sigSegv|Floating point exception|Segmentation fault", text)
    return signalled.group(0) if signalled else (text.strip().splitlines() or ["it wrote no log"])[-1]


def _tail(log: Path) -> bytes:
    with log.open("rb") as text:
        text.seek(0, os.SEEK_END)
        text.seek(max(0, text.tell() - TAIL))
        return text.read()
