"""`sdph stress --faults`: runs that are killed, starved or disturbed at random moments, and then go on.

After each fault: the message names it, nothing is left running and no port or lock is left, every output can be
read, and `sdph run --resume` ends with the same ledger, byte by byte, as a run that nobody disturbed.
"""

from __future__ import annotations

import contextlib
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

from sdph.engine import restart
from sdph.scenes import paths
from sdph.study.stress.processes import gone, processes, send

CASE = (
    "disc_cluster", "--set", "resolution.spacing_mm=20", "--set", "resolution.cell_mm=20",
    "--set", "coupling.window_tolerance=1e-4", "--set", "run.checkpoint_windows=5",
)  # fmt: skip
SHORT = ("--set", "run.output_interval_s=0.0001", "--until", "0.0003")
PATIENCE = 300.0  # s that a run may take
DISK, LARGE_DISK = "200k", "64m"  # of the small tmpfs, and what it is given to go on
CLOCK = r"""
#define _GNU_SOURCE
#include <dlfcn.h>
#include <sys/time.h>
#include <time.h>
static int calls;
static long back(void) { return ++calls > 40 ? 3600 : 0; }
int clock_gettime(clockid_t id, struct timespec* t) {
  static int (*real)(clockid_t, struct timespec*);
  if (!real) real = dlsym(RTLD_NEXT, "clock_gettime");
  int r = real(id, t);
  if (id == CLOCK_REALTIME) t->tv_sec -= back();
  return r;
}
time_t time(time_t* t) { struct timespec n; clock_gettime(CLOCK_REALTIME, &n); if (t) *t = n.tv_sec; return n.tv_sec; }
"""  # the wall clock steps back by an hour


@dataclass
class Site:
    """Scratch folder of the faults, how the gas is solved, and the ledger of the undisturbed run."""

    scratch: Path
    gas: tuple[str, ...]
    ledger: bytes = b""
    wall: float = 0.0

    def command(self, *words) -> list[str]:
        return [sys.executable, "-m", "sdph.cli", *map(str, words)]

    def start(self, folder: Path, environment: dict | None = None, *, resume: bool = False) -> subprocess.Popen:
        """A run in `folder`, its own folder for temporary files beside it."""
        words = ("run", "--resume", folder) if resume else ("run", *CASE, *SHORT, *self.gas, "--out", folder)
        temporary = self.scratch / "t"
        temporary.mkdir(exist_ok=True)
        python = os.pathsep.join(filter(None, (str(paths.PACKAGE.parent), os.environ.get("PYTHONPATH"))))
        variables = os.environ | {"TMPDIR": str(temporary), "PYTHONPATH": python} | (environment or {})
        return subprocess.Popen(
            self.command(*words), env=variables, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
        )


def run(moments: int) -> list[dict]:
    """`moments` random kills and every other fault once; rows as `sdph stress` prints them."""
    with tempfile.TemporaryDirectory(prefix="sf-") as scratch:
        site = _site(Path(scratch))
        chance = random.Random(1)
        checks = [_killed(site, chance, number) for number in range(moments)]
        checks += [
            fault(site) for fault in (_terminated, _interrupted, _second_run, _full_disk, _read_only, _clock_back)
        ]
    print("\n".join(f"{'ok' if c['ok'] else 'FAILED':8s}{c['name']:44s}{c['detail']}" for c in checks))
    return checks


def _site(scratch: Path, gas: tuple[str, ...] = ()) -> Site:
    """The undisturbed run, with kernels that were compiled before; gas by OpenFOAM where it is."""
    from coupling.openfoam.programs import install

    site = Site(scratch, gas or (("--gas", "openfoam", "--np", "2") if install.find() else ("--gas", "embedded")))
    for name in ("warm", "whole"):
        begun = time.monotonic()
        process = site.start(scratch / name)
        said = process.communicate(timeout=10 * PATIENCE)[1]
        if process.returncode:
            raise RuntimeError(f"the undisturbed run failed: {said}")
        site.wall = time.monotonic() - begun
    site.ledger = (scratch / "whole" / "ledger.csv").read_bytes()
    return site


def _killed(site: Site, chance: random.Random, number: int) -> dict:
    """kill -9 of one process at a random moment."""
    victims = ("python", "sdphGasFoam", "mpirun") if "--np" in site.gas else ("python",)
    victim, moment = victims[number % len(victims)], chance.uniform(0.0, 1.05 * site.wall)
    folder = site.scratch / f"k{number}"
    process = site.start(folder)
    time.sleep(moment)
    hit = _kill(process, folder, victim)
    said = process.communicate(timeout=PATIENCE)[1]
    told = process.returncode == 3 and "sdphGasFoam" in said
    # the gas had no more to do
    too_late = process.returncode == 0 and (folder / "ledger.csv").read_bytes() == site.ledger
    named = not hit or victim == "python" or told or too_late
    return _verdict(site, folder, f"kill -9 {victim} at {moment:.2f} s", named, said)


def _kill(process: subprocess.Popen, folder: Path, victim: str) -> bool:
    """Kill the victim, and say whether it was there; it is waited for while the run goes on."""
    while process.poll() is None:
        found = (
            [pid for pid, name in processes(folder) if name.startswith(victim)] if victim != "python" else [process.pid]
        )
        if found:
            os.kill(found[-1], signal.SIGKILL)
            return True
        time.sleep(0.02)
    return False


def _terminated(site: Site) -> dict:
    return _stopped(site, signal.SIGTERM)


def _interrupted(site: Site) -> dict:
    return _stopped(site, signal.SIGINT)


def _stopped(site: Site, number: signal.Signals) -> dict:
    folder = site.scratch / number.name
    process = site.start(folder)
    _wait_for(process, folder / "checkpoints" / "000000005")
    process.send_signal(number)
    said = process.communicate(timeout=PATIENCE)[1]
    named = process.returncode == 128 + number and number.name in said and "--resume" in said
    return _verdict(site, folder, number.name, named, said)


def _second_run(site: Site) -> dict:
    """Check that neither a new run nor a resumed one gets into a folder where one is going on."""
    folder = site.scratch / "second"
    first = site.start(folder)
    _wait_for(first, folder / "history.csv")
    first.send_signal(signal.SIGSTOP)  # so that it is not done before the others have come
    others = [site.start(folder), site.start(folder, resume=True)]
    said = [other.communicate(timeout=PATIENCE)[1] for other in others]
    first.send_signal(signal.SIGCONT)
    first.communicate(timeout=PATIENCE)
    named = (
        first.returncode == 0
        and [o.returncode for o in others] == [2, 2]
        and "another run" in said[0]
        and "in use" in said[1]
    )
    return _verdict(site, folder, "a second run in the same folder", named, " | ".join(said))


def _full_disk(site: Site) -> dict:
    return _on_small_disk(site, "disk full", lambda folder, process: [], ("No space left", "cannot"), DISK)


def _read_only(site: Site) -> dict:
    """The folders that a run writes files into, in the middle of it."""

    def lock(folder: Path, process: subprocess.Popen) -> list[Path]:
        _wait_for(process, folder / "checkpoints" / "000000005")
        locked = [folder / "fields", folder / "checkpoints"]
        with _held(folder):  # who writes into a mount keeps it from being made read-only
            for path in locked:
                subprocess.run(["mount", "--bind", path, path], check=True)
                subprocess.run(["mount", "-o", "remount,bind,ro", path], check=True)
        return locked

    return _on_small_disk(site, "run folder made read-only", lock, ("Read-only file system", "cannot"), LARGE_DISK)


def _on_small_disk(site: Site, name: str, harm, words, size: str) -> dict:
    """A run on a tmpfs of `size`; `harm` gives the mounts to be taken away again before the run goes on."""
    disk = site.scratch / name.split()[0]
    disk.mkdir()
    if (
        os.geteuid()
        or subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", disk], capture_output=True).returncode
    ):
        return {"name": name, "ok": True, "detail": "skipped: only root can mount a tmpfs"}
    try:
        process = site.start(disk / "run")
        mounts = harm(disk / "run", process)
        said = process.communicate(timeout=PATIENCE)[1]
        for mount in mounts:
            subprocess.run(["umount", mount], check=True)
        subprocess.run(["mount", "-o", f"remount,size={LARGE_DISK}", disk], check=True)
        named = process.returncode == 4 and any(word in said for word in words) and "Traceback" not in said
        return _verdict(site, disk / "run", name, named, said)
    finally:
        subprocess.run(["umount", "-R", disk], check=False)


def _clock_back(site: Site) -> dict:
    """The wall clock steps back by an hour in the middle of a run."""
    source, library, name = site.scratch / "clock.c", site.scratch / "clock.so", "the clock steps back"
    source.write_text(CLOCK, encoding="utf-8")
    compiler = shutil.which("cc") or shutil.which("gcc")
    if (
        not compiler
        or subprocess.run([compiler, "-shared", "-fPIC", "-o", library, source, "-ldl"], capture_output=True).returncode
    ):
        return {"name": name, "ok": True, "detail": "skipped: there is no C compiler"}
    process = site.start(site.scratch / "clock", {"LD_PRELOAD": str(library)})
    said = process.communicate(timeout=PATIENCE)[1]
    return _verdict(site, site.scratch / "clock", name, process.returncode == 0, said)


def _wait_for(process: subprocess.Popen, path: Path) -> None:
    while process.poll() is None and not path.exists():
        time.sleep(0.02)


def _resumed(site: Site, folder: Path) -> list[str]:
    """Faults of the run that goes on in a folder."""
    process = site.start(folder, resume=True)
    told = process.communicate(timeout=PATIENCE)[1]
    same = not process.returncode and (folder / "ledger.csv").read_bytes() == site.ledger
    return ([] if same else [f"it went on wrongly: {' '.join(told.split())[-300:]}"]) + _unreadable(folder)


def _verdict(site: Site, folder: Path, name: str, named: bool, said: str) -> dict:
    """Check what has to be true after every fault."""
    wrong = [] if named else [f"it said: {' '.join(said.split())[-300:]}"]
    if not gone(folder):
        wrong.append(f"left running: {processes(folder)}")
    wrong += _unreadable(folder)
    if (folder / "case.toml").exists():
        wrong += _resumed(site, folder)
    left = [path.name for path in (site.scratch / "t").glob("sdph-*")]
    if left and (folder / "case.toml").exists():
        wrong.append(f"left behind: {left}")
    return {"name": name, "ok": not wrong, "detail": "; ".join(wrong)}


@contextlib.contextmanager
def _held(folder: Path):
    """The processes of a run stand still."""
    pids = [pid for pid, _ in processes(folder)]
    send(pids, signal.SIGSTOP)
    try:
        yield
    finally:
        send(pids, signal.SIGCONT)


def _unreadable(folder: Path) -> list[str]:
    """Outputs and checkpoints that are named but not whole."""
    import pyvista

    wrong = []
    for path in (folder / "fields").glob("[pg]as_*.vt?") if (folder / "fields").is_dir() else ():
        if pyvista.read(path).n_points == 0:
            wrong.append(f"{path.name} is empty")
    if (folder / "run.pvd").exists():
        text = (folder / "run.pvd").read_text(encoding="utf-8")
        wrong += [
            f"{name} is missing" for name in text.split('file="')[1:] if not (folder / name.split('"')[0]).is_file()
        ]
    for name in ("summary.json", "failure.json", "origin.json"):
        if (folder / name).exists():
            json.loads((folder / name).read_text(encoding="utf-8"))
    checkpoints = restart.numbered(folder)
    if checkpoints and restart.newest(folder).folder != checkpoints[0]:
        wrong.append(f"{checkpoints[0].name} is damaged")
    return wrong
