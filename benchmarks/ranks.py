"""Processes that share a liquid: one, then several of one thread each, and as many threads in one process, in turn.

    python benchmarks/ranks.py [RANKS] [SPACING_MM ...]

The 3-D dam break, its first 200 steps or so. Prints particles, ms a step, efficiency (time of one process over that of
N, over N), and the same of threads. Wants a machine with nothing else on it.
"""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

TIMES = 3  # rounds, of which the best counts
UNTIL = {"run.output_interval_s": 0.01, "run.end_time_s": 0.01}


def measured(ranks: int, threads: int, spacing: float) -> dict:
    """Summary of a run."""
    with tempfile.TemporaryDirectory() as folder:
        sets = [f"--set={key}={value}" for key, value in (UNTIL | {"resolution.spacing_mm": spacing}).items()]
        command = [sys.executable, "-m", "sdph.cli", "run", "dam_break_3d", *sets, "--json", "--out", f"{folder}/run"]
        command += ["--ranks", str(ranks)] if ranks > 1 else []
        environment = os.environ | {"NUMBA_NUM_THREADS": str(threads)}
        done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True, cwd=Path.cwd())
        return json.loads(done.stdout)


def main(ranks: int, spacings: list[float]) -> None:
    for spacing in spacings:
        best = {}
        for _ in range(TIMES):
            for who in ((1, 1), (ranks, 1), (1, ranks)):
                told = measured(*who, spacing)
                step = 1e3 * told["wall_particles_s"] / told["sub_steps"]
                best[who] = min(best.get(who, (step, told)), (step, told), key=lambda one: one[0])
        one, shared, threaded = (best[who][0] for who in ((1, 1), (ranks, 1), (1, ranks)))
        told = best[ranks, 1][1]
        of_ranks = f"{ranks} ranks {shared:.2f} ms, efficiency {one / shared / ranks:.2f}"
        of_threads = f"{ranks} threads {threaded:.2f} ms, {one / threaded / ranks:.2f}"
        halo = f"copies {told['halo_share']:.3f} of own, busiest {told['imbalance']:.3f} of the mean"
        print(f"{told['particles']} particles: one process {one:.2f} ms; {of_ranks}; {of_threads}; {halo}", flush=True)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 2, [float(one) for one in sys.argv[2:]] or [6.0, 2.8575])
