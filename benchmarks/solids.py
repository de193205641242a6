"""A step of a solid over a delta-SPH step of as many particles: CPU time of one thread, in turn in one process.

    python benchmarks/solids.py

Elastic and of Johnson and Cook with damage in two dimensions (rings), elastic-plastic in three (the Taylor bar). The
delta-SPH side is the dam break of `liquid_scaling.py`, of as many particles of liquid, its rows made anew every 6
steps. The least of the rounds. The bar of issue 20 is 0.6 of a liquid's particle-steps per second.
"""

import math
import time

import numba

from sdph import scenes
from sdph.case import read as cases
from sdph.methods.solids.method import SolidStepper
from sdph.study import bench

ROUNDS, STEPS = 5, 12
STRONG = (
    "solid.yield_stress_Pa=4.9e5", "solid.hardening_Pa=8.07e5", "solid.hardening_exponent=0.73",
    "solid.rate_factor=0.1739", "solid.reference_rate_1_s=5e-4",
    "solid.failure=[0.00705, 1.732, -0.054, -0.0123, 0.0]", "solid.critical_damage=0.012",
)  # fmt: skip
RING = ("resolution.spacing_mm=0.00354",)  # some 12 000 particles, 14 layers
CASES = {
    "ring, elastic": ("thick_ring", RING, 2, 2e-6),
    "rings that meet, Johnson-Cook with damage": ("colliding_rings", STRONG, 2, 1e-4),
    "bar, elastic-plastic": ("taylor_bar", (), 3, 1e-5),
}


def spent(step, count: int) -> float:
    """CPU time [s] of a step, of so many."""
    begun = time.process_time()
    for _ in range(count):
        step()
    return (time.process_time() - begun) / count


def main() -> None:
    numba.set_num_threads(1)
    for name, (scene, changes, dimensions, begin) in CASES.items():
        solid = SolidStepper(cases.load(scenes.HERE / scene / "case.toml", changes))
        while solid.time < begin:  # under load
            solid.step(begin - solid.time)
        count = len(solid.state.x)
        liquid = bench.tank(dimensions, count)
        best = [math.inf, math.inf]
        for _ in range(ROUNDS + 1):  # the first compiles
            solids = spent(lambda own=solid: own.step(1.0), STEPS) / count
            liquids = spent(lambda own=liquid: bench.step_time(own), 2) / bench.STEPS / len(liquid.active)
            best = [min(best[0], solids), min(best[1], liquids)]
        print(
            f"{name}, {count} particles: {1e6 * best[0]:.3f} us a particle and step; liquid, {len(liquid.active)}: "
            f"{1e6 * best[1]:.3f}; particle-steps per second {best[1] / best[0]:.2f} of a liquid's",
            flush=True,
        )


if __name__ == "__main__":
    main()
