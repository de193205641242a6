"""Particles that processes share, timed: one process, then several of one thread each, and as many threads in one.

`sdph bench --ranks N` has rows of CASES, `benchmarks/ranks.py` takes others.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable

from sdph import scenes
from sdph.case import read as cases
from sdph.running import ranks as processes
from sdph.schema import CaseError
from sdph.study.bench import Row

UNTIL = 0.01  # s; and three times that: what comes between is timed, without the start
CASES = {"liquid": ("dam_break_3d", 2.8575), "grains": ("bubbling_bed_3d", 8.0)}  # scene, spacing [mm]: our choice
OF_GAS = {"bubbling_bed_3d": ("--gas", "embedded")}


def rows(ranks: int, say: Callable[[str], None]) -> list[Row]:
    """Wall time of a step of one process over that of so many ranks, and over that of as many threads."""
    if ranks < 2:
        raise CaseError(f"--ranks {ranks}: to be compared with one process there must be at least 2")
    for scene, _ in CASES.values():
        processes.refuse(cases.load(scenes.HERE / scene / "case.toml"), ranks)
    found = []
    for kind, (scene, spacing) in CASES.items():
        say(f"{kind}, {scene} with {spacing:g} mm: one process, {ranks} ranks, {ranks} threads")
        (alone, told), (shared, _), (threaded, _) = (
            step(scene, spacing, *who) for who in ((1, 1), (ranks, 1), (1, ranks))
        )
        what = f"{kind}, 3-D, {told['particles']} particles: one process over {ranks}"
        found.append(Row(f"{kind}_{ranks}_ranks", f"{what} ranks", alone / shared))
        found.append(Row(f"{kind}_{ranks}_threads", f"{what} threads", alone / threaded))
    return found


def step(scene: str, spacing: float, ranks: int, threads: int) -> tuple[float, dict]:
    """ms of a step of the particles of a scene once all is loaded, with particles `spacing` [mm] apart, and the
    summary of the run."""
    # the first of them compiles what is not there yet
    _, first, told = (_ran(scene, spacing, ranks, threads, times * UNTIL) for times in (1, 1, 3))
    spent, steps = (told[key] - first[key] for key in ("wall_particles_s", "sub_steps"))
    return 1e3 * spent / steps, told


def _ran(scene: str, spacing: float, ranks: int, threads: int, until: float) -> dict:
    """Summary of a run of a scene; CaseError where it cannot be run."""
    with tempfile.TemporaryDirectory(prefix="sdph-bench-") as folder:
        given = {"run.output_interval_s": until, "run.end_time_s": until, "resolution.spacing_mm": spacing}
        sets = [f"--set={key}={value}" for key, value in given.items()]
        command = [sys.executable, "-m", "sdph.cli", "run", scene, *sets, "--json", "--out", f"{folder}/run"]
        command += OF_GAS.get(scene, ())
        command += ["--ranks", str(ranks)] if ranks > 1 else []
        done = subprocess.run(
            command, env=os.environ | {"NUMBA_NUM_THREADS": str(threads)}, capture_output=True, text=True
        )
        if done.returncode:
            raise CaseError(done.stderr.strip().splitlines()[-1].removeprefix("sdph: "))
        return json.loads(done.stdout)
