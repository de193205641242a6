"""Runs OpenFOAM's own programs on a case folder, serial or under MPI, and says what went wrong when they fail."""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import time
from collections.abc import Callable
from pathlib import Path

from coupling.gas import GasError
from coupling.openfoam import case as case_files
from coupling.openfoam import install
from sdph.case import Case

LOOK = 0.2  # s between two looks at a running solver
HEAD = "FoamFile\n{{\n    version     2.0;\n    format      ascii;\n    class       dictionary;\n    object      {name};\n}}\n\n"


def write(case: Case, template: Path, folder: Path, macros: dict[str, dict[str, str]]) -> None:
    """A case folder from a template: the case's macros and mesh, and further macro files in `constant`."""
    shutil.copytree(template, folder, dirs_exist_ok=True)
    case_files.write_macros(case, folder)
    case_files.write_block_mesh(case, folder)
    for name, entries in macros.items():
        lines = "".join(f"{key} {text};\n" for key, text in entries.items())
        (folder / "constant" / name).write_text(HEAD.format(name=name) + lines, encoding="utf-8")


def run(command: list[str], folder: Path, log: Path) -> None:
    """Run a short program to its end."""
    with log.open("wb") as out:
        process = subprocess.run(command, cwd=folder, env=install.environment(), stdout=out, stderr=subprocess.STDOUT, check=False)
    if process.returncode:
        raise GasError(f"{command[0]} failed: {reason(log)} (log: {log})")


def run_solver(solver: str, folder: Path, log: Path, ranks: int, end: float, progress: Callable | None) -> None:
    """Run a solver, on `ranks` processes; `progress(time, end)` hears of its time [s]."""
    if ranks == 1:
        return _watch([solver], folder, log, end, progress)
    run(["decomposePar", "-force"], folder, folder / "log.decomposePar")
    as_root = ["--allow-run-as-root"] if os.geteuid() == 0 else []
    _watch(["mpirun", *as_root, "--oversubscribe", "-np", str(ranks), solver, "-parallel"], folder, log, end, progress)
    run(["reconstructPar"], folder, folder / "log.reconstructPar")


def _watch(command: list[str], folder: Path, log: Path, end: float, progress: Callable | None) -> None:
    with log.open("wb") as out:
        process = subprocess.Popen(
            command, cwd=folder, env=install.environment(), stdout=out, stderr=subprocess.STDOUT, start_new_session=True
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
    found = re.findall(rb"^Time = (\S+)", _tail(log), re.MULTILINE)
    return float(found[-1]) if found else 0.0


def reason(log: Path) -> str:
    """The lines of a log that say why a program ended, in one."""
    text = _tail(log).decode(errors="replace")
    fatal = re.search(r"FOAM FATAL (?:IO )?ERROR:?\s*(.*?)(?:\n\n|\n\s*From |\Z)", text, re.DOTALL)
    if fatal:
        return " ".join(fatal.group(1).split())
    signalled = re.search(r"sigFpe|sigSegv|Floating point exception|Segmentation fault", text)
    return signalled.group(0) if signalled else (text.strip().splitlines() or ["it wrote no log"])[-1]


def _tail(log: Path, size: int = 20000) -> bytes:
    with log.open("rb") as text:
        text.seek(0, os.SEEK_END)
        text.seek(max(0, text.tell() - size))
        return text.read()
