"""Time of one force evaluation of a liquid against PySPH: python benchmarks/against_pysph.py

One dam break, the same particles, delta-SPH, cubic spline, h = 1.3 dx, f64, the same threads, both in turn in one run;
walls count as particles; medians of rounds. sdph's is a whole step (one evaluation and the integration), its neighbour
rows made anew every 6 steps, which is what a liquid on its way needs (5 to 8). PySPH's (Debian's python3-pysph, OpenMP,
neighbours cached) leaves the integration out; it looks for neighbours at every evaluation. Threads: NUMBA_NUM_THREADS,
2 unless set. Growth with the number of particles and threads: liquid_scaling.py.
"""

from __future__ import annotations

import os
import subprocess
import tempfile
import time
from pathlib import Path

THREADS = os.environ.setdefault("NUMBA_NUM_THREADS", "2")

import numpy as np  # noqa: E402

from sdph.case import read as cases  # noqa: E402

SYSTEM_PYTHON = "/usr/bin/python3"
ROUNDS, RATIO, REBUILD = 5, 1.3, 6
PEERS = {"2-D 10k": (2, 1.0e4), "2-D 100k": (2, 1.0e5), "3-D 100k": (3, 1.0e5)}


def stepper(dimensions: int, count: float):
    """A dam break of about `count` particles, walls included, on its way."""
    from sdph.methods.liquids.method import LiquidStepper

    column, size = ([1.0, 2.0], [4.0, 2.5]) if dimensions == 2 else ([1.0, 1.0, 1.0], [1.6, 1.2, 1.0])
    gravity = [0.0, -9.81, 0.0][:dimensions]
    spacing = (np.prod(column) / count) ** (1.0 / dimensions)
    for _ in range(20):  # walls take their share of the particles: to the spacing that gives `count` in all
        walls = 3.0 * (
            sum(size) + size[1] if dimensions == 2 else size[0] * size[2] + 2.0 * size[1] * (size[0] + size[2])
        )
        spacing *= ((np.prod(column) / spacing**dimensions + walls / spacing ** (dimensions - 1)) / count) ** (
            1.0 / dimensions
        )
    own = LiquidStepper(cases.from_table({
        "dimensions": dimensions, "effects": ["gravity", "density_diffusion", "liquid_damping", "tank"],
        "run": {"end_time_s": 1.0, "output_interval_s": 1.0}, "domain": {"size_m": size, "gravity_m_s2": gravity},
        "resolution": {"spacing_mm": 1e3 * spacing, "smoothing_ratio": RATIO},
        "liquid": {"density_kg_m3": 1000.0, "sound_speed_m_s": 60.0, "kernel": "cubic_spline"},
        "tank": {"open_sides": ["top"]}, "pools": {"column": {"shape": "box", "lower_m": [0.0] * dimensions,
        "upper_m": column}},
    }))  # fmt: skip
    go(own, 6)
    return own


def go(own, steps: int) -> float:
    """Seconds per step."""
    begun = time.perf_counter()
    for n in range(steps):
        if n % REBUILD == 0:
            own.neighbours.built = ()
        own.step(1.0)
    return (time.perf_counter() - begun) / steps


def export(own, file: Path) -> None:
    """The particles as PySPH takes them."""
    from sdph.engine import state as particles

    s, case = own.state, own.case
    z, w = (s.z, s.w) if len(s.z) else (np.zeros(len(s.x)), np.zeros(len(s.x)))
    np.savez(
        file, x=s.x, y=s.y, z=z, u=s.u, v=s.v, w=w, m=s.mass, rho=s.density, wet=particles.wet(s),
        dimensions=case.dimensions, h=case.smoothing_length, spacing=case.resolution.spacing, rho_0=case.liquid.density,
        c_0=case.liquid.sound_speed,
    )  # fmt: skip


def peer() -> None:
    print(f"{'':10s} {'particles':>10s} {'sdph [ms]':>10s} {'PySPH [ms]':>11s} {'ratio':>6s}   ({THREADS} threads)")
    for name, (dimensions, count) in PEERS.items():
        own = stepper(dimensions, count)
        with tempfile.TemporaryDirectory() as folder:
            export(own, Path(folder) / "particles.npz")
            ours, theirs = in_turn(own, Path(folder) / "particles.npz", REBUILD * max(1, int(1e5 / count)))
        print(
            f"{name:10s} {len(own.state.x):10d} {1e3 * ours:10.2f} {1e3 * theirs:11.2f} {theirs / ours:6.2f}",
            flush=True,
        )


def in_turn(own, file: Path, steps: int) -> tuple[float, float]:
    """Medians [s] of one step and of one evaluation of PySPH, measured in turn."""
    environment = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "VIRTUAL_ENV")} | {
        "OMP_NUM_THREADS": THREADS
    }
    command = [SYSTEM_PYTHON, str(Path(__file__).with_name("pysph_side.py")), str(file)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=environment) as other:
        line = other.stdout.readline()
        while line and line.strip() != "ready":  # PySPH tells of its compilation
            line = other.stdout.readline()
        if not line:
            raise SystemExit("PySPH did not start; on Debian: apt-get install --no-install-recommends python3-pysph")
        ours, theirs = [], []
        for _ in range(ROUNDS):
            ours.append(go(own, steps))
            few = max(1, steps // 6)
            other.stdin.write(f"{few}\n")
            other.stdin.flush()
            theirs.append(float(other.stdout.readline()) / few)
        other.stdin.close()
    return float(np.median(ours)), float(np.median(theirs))


if __name__ == "__main__":
    peer()
