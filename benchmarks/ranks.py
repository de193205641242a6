"""Processes that share particles: one, then several of one thread each, and as many threads in one process, in turn.

    python benchmarks/ranks.py [RANKS] [SCENE] [SPACING_MM ...]

The first steps of the 3-D dam break, or of a bed in 3-D (bubbling_bed_3d; the particles' side alone). Prints
particles, ms a step, efficiency (time of one process over that of N, over N), and the same of threads. Wants a machine
with nothing else on it.
"""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

TIMES = 3  # rounds, of which the best counts
UNTIL = {"dam_break_3d": 0.01, "bubbling_bed_3d": 0.01}  # s; and three times that: what comes between is measured
SPACINGS = {"dam_break_3d": [6.0, 2.8575], "bubbling_bed_3d": [7.5, 5.0]}  # mm


def measured(scene: str, ranks: int, threads: int, spacing: float) -> tuple[float, dict]:
    """ms of a step once all is loaded, and the summary of a run."""
    first, told = (ran(scene, ranks, threads, spacing, times * UNTIL[scene]) for times in (1, 3))
    spent, steps = (told[key] - first[key] for key in ("wall_particles_s", "sub_steps"))
    return 1e3 * spent / steps, told


def ran(scene: str, ranks: int, threads: int, spacing: float, until: float) -> dict:
    """Summary of a run."""
    with tempfile.TemporaryDirectory() as folder:
        given = {"run.output_interval_s": until, "run.end_time_s": until, "resolution.spacing_mm": spacing}
        sets = [f"--set={key}={value}" for key, value in given.items()]
        command = [sys.executable, "-m", "sdph.cli", "run", scene, *sets, "--json", "--out", f"{folder}/run"]
        command += ["--gas", "embedded"] if scene == "bubbling_bed_3d" else []
        command += ["--ranks", str(ranks)] if ranks > 1 else []
        environment = os.environ | {"NUMBA_NUM_THREADS": str(threads)}
        done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True, cwd=Path.cwd())
        return json.loads(done.stdout)


def main(ranks: int, scene: str, spacings: list[float]) -> None:
    for spacing in spacings:
        best = {}
        for _ in range(TIMES):
            for who in ((1, 1), (ranks, 1), (1, ranks)):
                step, told = measured(scene, *who, spacing)
                best[who] = min(best.get(who, (step, told)), (step, told), key=lambda one: one[0])
        one, shared, threaded = (best[who][0] for who in ((1, 1), (ranks, 1), (1, ranks)))
        told = best[ranks, 1][1]
        of_ranks = f"{ranks} ranks {shared:.2f} ms, efficiency {one / shared / ranks:.2f}"
        of_threads = f"{ranks} threads {threaded:.2f} ms, {one / threaded / ranks:.2f}"
        halo = f"copies {told['halo_share']:.3f} of own, busiest {told['imbalance']:.3f} of the mean"
        print(f"{told['particles']} particles: one process {one:.2f} ms; {of_ranks}; {of_threads}; {halo}", flush=True)


if __name__ == "__main__":
    given = dict(enumerate(sys.argv))
    chosen = given.get(2, "dam_break_3d")
    main(int(given.get(1, 2)), chosen, [float(one) for one in sys.argv[3:]] or SPACINGS[chosen])
