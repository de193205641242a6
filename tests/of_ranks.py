"""Runs that processes share, for tests of them."""

import csv
import json
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
from sdph.running import output

WITH_MPI = pytest.mark.skipif(
    shutil.which("mpirun") is None and "CI" not in os.environ, reason="there is no mpirun (apt install openmpi-bin)"
)
LATE = 120.0  # s after which who waits for others gives up
AMOUNTS = ("work_of_gravity_J", "kinetic_energy_J", "dissipated_J", "drained_kg", "injected_kg", "left_kg")
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


def assert_same_bits(first: Path, again: Path) -> None:
    """Particles and tables of two runs by the same processes."""
    ours, theirs = particles(first), particles(again)
    assert ours.keys() == theirs.keys()
    for name, values in ours.items():
        np.testing.assert_array_equal(theirs[name], values)
    for table in ("history.csv", "ledger.csv"):
        assert (first / table).read_text() == (again / table).read_text()


def rows_alike(found, one) -> None:
    """Columns of the history are those of one process, shares but for a few particles that round-off decides on."""
    for name in one.keys() - set(output.TEXTS):
        largest = np.nanmax(np.abs(one[name]), initial=0.0)
        bar = 0.02 if name.endswith("_share") else 1e-8 * largest + 1e-11
        bar = max(bar, 1e-4 * largest) if name.startswith(("wall_", "pipe_")) else bar  # of now: 5e-6 was found
        np.testing.assert_allclose(found[name], one[name], rtol=0.0, atol=bar, err_msg=name)


def alike(found: Path, one: Path, bar: float = 1e-11, amounts=AMOUNTS) -> None:
    """Fields, history, ledger and summary, of this the `amounts` too, are those of one process."""
    ours, theirs = particles(found), particles(one)
    np.testing.assert_array_equal(ours["ident"], theirs["ident"])
    for name, values in theirs.items():
        assert np.abs(ours[name] - values).max() <= bar * max(np.abs(values).max(), 1e-300), name
    for table in ("history.csv", "ledger.csv"):
        a, b = (list(csv.reader((folder / table).read_text().splitlines())) for folder in (found, one))
        assert len(a) == len(b) and a[0] == b[0], table
    rows_alike(*(output.read_table(folder / "history.csv", output.TEXTS) for folder in (found, one)))
    a, b = (json.loads((folder / "summary.json").read_text()) for folder in (found, one))
    assert a.keys() == b.keys()
    for key in ("sub_steps", "particles", "mass_kg", "liquid_particles"):
        assert a.get(key) == b.get(key), key
    for key in amounts:
        assert a[key] == pytest.approx(b[key], rel=1e-9, abs=1e-15), key
    assert a["mass_drift_rel"] < 1e-12 and a["momentum_drift_rel"] < 1e-12


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
