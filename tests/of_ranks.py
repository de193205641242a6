"""Runs that processes share, for tests of them."""

import os
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from threading import Barrier

import numpy as np
import pytest
import pyvista

from sdph.engine.world import World

WITH_MPI = pytest.mark.skipif(
    shutil.which("mpirun") is None and "CI" not in os.environ, reason="there is no mpirun (apt install openmpi-bin)"
)
LATE = 120.0  # s after which who waits for others gives up
SDPH = (sys.executable, "-m", "sdph.cli", "run")


def run(*options, ranks=1, **more):
    """The finished process of `sdph run`."""
    given = (*SDPH, *map(str, options), *(("--ranks", str(ranks)) if ranks > 1 else ()))
    return subprocess.run(given, capture_output=True, text=True, timeout=900, check=False, **more)


def fine(folder: Path, *options, ranks=1) -> Path:
    """The folder of a run that went well."""
    done = run(*options, ranks=ranks) if "--resume" in options else run(*options, "--out", folder, ranks=ranks)
    assert done.returncode == 0, done.stderr
    return folder


def particles(folder: Path):
    """The last particles, by number."""
    last = pyvista.read(sorted(folder.glob("fields/particles_*"))[-1])
    order = np.argsort(last["ident"])
    return {"place": last.points[order]} | {name: last[name][order] for name in last.array_names}


def shared_by(folder: Path) -> list[int]:
    """Numbers of the processes that share a run."""
    found = []
    for entry in Path("/proc").glob("[0-9]*"):
        try:
            words = (entry / "cmdline").read_bytes().decode().split("\0")
        except OSError:
            continue
        if "--resume" in words and str(folder) in words and "python" in words[0]:
            found.append(int(entry.name))
    return found


class Among(World):
    """One of several threads that stand for processes."""

    def __init__(self, rank: int, values: list, barrier: Barrier):
        self.rank, self.number, self.chief, self.values, self.barrier = rank, len(values), rank == 0, values, barrier

    def everywhere(self, value) -> list:
        self.values[self.rank] = value
        self.barrier.wait()
        found = list(self.values)
        self.barrier.wait()
        return found

    def told(self, value):
        return self.everywhere(value)[0]

    def gather(self, value):
        found = self.everywhere(value)
        return found if self.chief else None

    def exchange(self, parts: list) -> list:
        return [own[self.rank] for own in self.everywhere(parts)]

    def _reduced(self, values, how: str):
        found = getattr(np, how.lower())(np.array(self.everywhere(values)), axis=0)
        return found if np.ndim(found) else found.item()

    @classmethod
    def several(cls, number: int) -> list["Among"]:
        """Worlds of so many threads, by rank."""
        values, barrier = [None] * number, Barrier(number, timeout=LATE)
        return [cls(rank, values, barrier) for rank in range(number)]


def together(function, given) -> list:
    """What a function makes of each of what is given, each in a thread of its own."""
    with ThreadPoolExecutor(len(given)) as threads:
        return list(threads.map(function, given))
