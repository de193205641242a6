"""`sdph run --ranks N`: a run whose particles N processes share, each those of its part of space.

The process that was asked prepares the run folder, starts the others by MPI's own launcher, and waits. They go on with
that folder as with any run that has no checkpoint yet; the first of them writes.
"""

from __future__ import annotations

import contextlib
import ctypes
import functools
import importlib.metadata
import importlib.util
import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import NoReturn

from coupling.gas import GasError
from coupling.openfoam.programs import install
from sdph.case import read as cases
from sdph.engine import device, restart, world
from sdph.running import inputs, on_device, output
from sdph.running.interruption import SIGNALS
from sdph.running.progress import Reporter
from sdph.schema import CaseError
from sdph.version import __version__

# effects whose loops are told what particles of others are like (HALO, and what they refresh themselves)
OF_LIQUIDS = (
    "density_diffusion", "drain", "frame", "gravity", "inflow", "laminar_viscosity", "liquid_damping", "outflow",
    "shear_thinning", "shifting", "surface_tension", "tank", "xsph",
)  # fmt: skip
OF_GRAINS = (
    "artificial_viscosity", "break_up", "conduction", "drag", "electric_field", "evaporation", "friction",
    "gas_pressure", "grain_drag", "grain_shifting", "granular_pressure", "granular_temperature", "granular_viscosity",
    "gravity", "heat", "inflow", "lift", "micro_explosion", "outflow", "radiation", "reaction", "turbulent_dispersion",
    "wall_heat", "walls",
)  # fmt: skip
OF_MPS = (
    "free_energy_tension", "gravity", "inflow", "laminar_viscosity", "outflow", "perforation", "suction", "tank",
)  # fmt: skip
SHARED = {"liquid": OF_LIQUIDS, "mps": OF_MPS, "grains": OF_GRAINS}
PR_SET_PDEATHSIG = 1  # linux/prctl.h
KNOWN = range(6)  # codes that a process ends with of itself
RULE = "-" * 20  # about what mpirun has to say
DIED = re.compile(r"process rank (\d+) .*exited on (signal \d+ \([^)]*\))")
CROWD = 16  # processes a core at most, where no launcher of one's own knows better; our choice
GRACE = 3.0  # s that others wait for what the first process has to say; so that all end within 5 s; our choice


def refuse(case, number: int) -> None:
    """CaseError where these processes cannot share the particles of a case."""
    given, mend = f"--ranks {number}", "leave --ranks out, and the run has one process with threads"
    on_device.refuse(case, number)
    known = SHARED.get(case.moved_by(case.matters[0]), ())
    if not known or len(case.matters) > 1:
        raise CaseError(f"{given}: only grains in a gas or a liquid alone are shared among processes; {mend}")
    if name := next((name for name, own in case.nozzles.items() if own.record and not own.table), None):
        raise CaseError(f"{given}: nozzles.{name} records a run, which is of one process; run it first, or {mend}")
    if left := sorted(set(case.effects) - set(known)):
        raise CaseError(f"{given}: {left[0]} is not shared among processes; known: {', '.join(known)}; {mend}")
    most = CROWD * (os.cpu_count() or 1)
    if number > most and not case.run.launcher:
        raise CaseError(f"{given}: this machine has room for {most} processes; give fewer, or a run.launcher")
    if importlib.util.find_spec("mpi4py") is None:
        raise CaseError(f"{given} needs mpi4py, which is not installed: pip install 'sdph[mpi]'; or {mend}")
    program = launcher(case, number)[0]
    if shutil.which(program) is None:
        raise CaseError(f"{given}: there is no {program}; install Open MPI (apt install openmpi-bin), or {mend}")


def launcher(case, number: int) -> list[str]:
    """Head of the command that starts so many processes: `run.launcher`, or Open MPI's mpirun."""
    if case.run.launcher:
        return [*shlex.split(case.run.launcher), "-n", str(number)]
    return [*install.mpirun(number), "--bind-to", "none"]


def run(case, folder: Path, number: int, template: Path, options: list[str], *, allow_code: bool) -> int:
    """Run a case in a new folder by so many processes, with `options` of the command line; the exit code. `template` is
    the OpenFOAM case of its gas."""
    refuse(case, number)
    inputs.check(case)
    with output.claimed(output.create(folder)):
        case = inputs.prepare(case, folder, template, allow_code)
        code = _started(case, folder, number, options)
    if code == 2 and not restart.numbered(folder):  # the case cannot be run: as if it had not been tried
        shutil.rmtree(folder)
    return code


def resume(folder: Path, number: int, overrides: tuple[str, ...], options: list[str]) -> int:
    """Go on with a run by so many processes, with `options` of the command line; the exit code."""
    case = cases.load(folder / output.MARK, overrides)
    refuse(case, number)
    with output.claimed(folder):
        return _started(case, folder, number, options)


def _started(case, folder: Path, number: int, options: list[str]) -> int:
    """The exit code of the processes; a signal to this one asks them to stop."""
    threads = str(max(1, (os.cpu_count() or 1) // number))
    environment = {"NUMBA_NUM_THREADS": threads, **os.environ, world.MARK: str(number)}
    command = [*launcher(case, number), sys.executable, "-m", "sdph.cli", "run", "--resume", str(folder), *options]
    heard, how = [], {"start_new_session": True, "stderr": subprocess.PIPE, "text": True, "preexec_fn": _end_with_us}
    with subprocess.Popen(command, env=environment, **how) as processes:

        def ask(signum: int, frame) -> None:
            heard.append(signum)
            processes.send_signal(signal.SIGUSR1)  # which mpirun hands on

        before = {signum: signal.signal(signum, ask) for signum in SIGNALS}
        try:
            told = _passed_on(processes.stderr)
            code = processes.wait()
        finally:
            for signum, handler in before.items():
                signal.signal(signum, handler)
            with contextlib.suppress(ProcessLookupError):
                os.killpg(processes.pid, signal.SIGKILL)
    if heard and code:
        return 128 + heard[0]
    if died := DIED.search(" ".join(told)):
        raise _lost(folder, f"rank {died[1]} (from 0) of {number} was ended by {died[2]}")
    if code not in KNOWN:
        raise _lost(folder, f"{command[0]} ended with code {code}: {' '.join(told) or 'it does not say why'}")
    return code


def _end_with_us() -> None:
    """Have the launcher, and so its processes, asked to end once this process is gone (prctl of Linux)."""
    with contextlib.suppress(OSError, AttributeError):
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)


def _passed_on(lines) -> list[str]:
    """Pass on what processes say; what their launcher says, between lines of dashes, is returned."""
    told, within, reporter = [], False, Reporter(line=False)
    for line in lines:
        if line.startswith(RULE):
            within = not within
        elif within:
            told.append(line.strip())
        elif not line.startswith("mpirun: "):
            reporter.status(line.rstrip("\n"))
    return told


def _lost(folder: Path, why: str) -> GasError:
    """Error of a run whose processes are gone, with how to go on."""
    error, checkpoint = GasError(f"the particles' side failed: {why} (by somebody, or for lack of memory)"), None
    with contextlib.suppress(CaseError):
        checkpoint = restart.newest(folder)
    output.write_json(folder / output.FAILURE, {"what": str(error), "kind": "GasError", "time_s": None})
    if checkpoint:
        error.add_note(restart.told(checkpoint, folder))
    return error


def agree(here: world.World) -> None:
    """CaseError where processes do not run the same programs: they would wait for each other for ever, or differ."""
    versions = {name: importlib.metadata.version(name) for name in ("numpy", "numba", "mpi4py")}
    own = ", ".join(f"{name} {version}" for name, version in versions.items())
    known = here.everywhere(f"sdph {__version__} of sources {device.sources()}, {own}")
    if other := next(((rank, told) for rank, told in enumerate(known) if told != known[0]), None):
        raise CaseError(
            f"--ranks {here.number}: rank {other[0]} (from 0) runs {other[1]}, the first one {known[0]}; install the "
            "same on every machine"
        )


def claimed(folder: Path):
    """Context that keeps other runs out of a folder; of several processes the one that started them does."""
    return output.claimed(folder) if world.here().number == 1 else contextlib.nullcontext()


@functools.cache
def wait_for_the_first() -> None:
    """Wait once, in another process than the first one, for it to end this one: what fails everywhere is told once."""
    if not world.here().chief:
        time.sleep(GRACE)


def end_all(kind, error, trace) -> NoReturn:
    """Take the place of sys.excepthook: others would wait for ever for a process that a fault in the code has ended."""
    sys.__excepthook__(kind, error, trace)
    end(1)


def end(code: int) -> NoReturn:
    """End this process with a code, without a word to the others: their launcher then ends them too."""
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)
