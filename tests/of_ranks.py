"""Runs that processes share, for tests of them."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import pyvista

WITH_MPI = pytest.mark.skipif(
    shutil.which("mpirun") is None and "CI" not in os.environ, reason="there is no mpirun (apt install openmpi-bin)"
)
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
