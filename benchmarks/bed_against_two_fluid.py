"""The bubbling bed, 0.3 s, against twoPhaseEulerFoam on the same cells with 3 outer iterations, in turn in one run:

    python benchmarks/bed_against_two_fluid.py [rounds: 3] [embedded or openfoam]

Medians of wall time and of processor time (all threads, the gas solver's too) from the start of a program to its end;
the two fluids' set-up by blockMesh and setFields is part of theirs as loading kernels is of ours. twoPhaseEulerFoam
runs on one core, with the largest step that keeps its answer (1 ms, validation/bubbling_bed); half its processor time
is what 2 ms would take.
"""

import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from coupling.openfoam.comparators import run as comparators
from sdph import scenes
from sdph.case import read as cases


def timed(work) -> tuple[float, float]:
    """Wall time and processor time [s] of the programs that `work` runs."""
    begun, before = time.perf_counter(), used()
    work()
    return time.perf_counter() - begun, used() - before


def used() -> float:
    spent = resource.getrusage(resource.RUSAGE_CHILDREN)
    return spent.ru_utime + spent.ru_stime


def main(rounds: str = "3", gas: str = "embedded"):
    case = cases.load(scenes.find("bubbling_bed")[1])
    command = [sys.executable, "-m", "sdph.cli", "run", "bubbling_bed", "--gas", gas, "--out"]
    times = []
    for number in range(int(rounds) + 1):  # the first compiles
        with tempfile.TemporaryDirectory() as folder:
            comparators.shelf = lambda place=Path(folder): place / "references"  # nothing comes from earlier runs
            ours = timed(
                lambda place=folder: subprocess.run([*command, f"{place}/run"], check=True, capture_output=True)
            )
            theirs = timed(lambda place=Path(folder): comparators.run_two_fluid(case, place / "tfm"))
        print(
            f"round {number}: sdph {ours[0]:.1f} s wall, {ours[1]:.1f} s CPU; two fluids {theirs[0]:.1f} s, "
            f"{theirs[1]:.1f} s",
            flush=True,
        )
        times.append((*ours, *theirs))
    wall, cpu, other_wall, other_cpu = np.median(times[1:], axis=0)
    print(f"medians: sdph / two fluids = {wall / other_wall:.2f} by wall time, {cpu / other_cpu:.2f} by processor time")


if __name__ == "__main__":
    main(*sys.argv[1:3])
