"""Dam break at growing numbers of particles: time per particle and step, threads, memory.

    python benchmarks/liquid_scaling.py [DIMENSIONS:PARTICLES ...]

Each in a process of its own. Times are told per particle of liquid and per particle, walls included: the dry part of
the channel has many, which cost little, and the fewer the finer it is. Rows are made anew every 6 steps (a liquid on
its way needs that every 8 to 20). Memory is the largest the process held less what it held before it had a case, per
particle. 3-D is the same column, as deep as it is wide. Threads: NUMBA_NUM_THREADS.
"""

import math
import subprocess
import sys

import numba
import numpy as np

from sdph.study.bench import step_time, tank

DEFAULT = ("2:1e4", "2:1e5", "3:1e5")


def held(what: str) -> float:
    """VmRSS or VmHWM of this process [bytes], as Linux tells."""
    with open("/proc/self/status", encoding="ascii") as status:
        return next(1024.0 * float(line.split()[1]) for line in status if line.startswith(what))


def measured(dimensions: int, count: float) -> str:
    tank(dimensions, 2000).step(1.0)  # kernels compiled or loaded
    before = held("VmRSS")
    stepper = tank(dimensions, count)
    step_time(stepper)
    particles, liquid, spent = len(stepper.state.x), len(stepper.active), {}
    memory = (held("VmHWM") - before) / particles
    for _ in range(max(2, int(2e6 / count))):  # the best of the rounds counts
        for threads in range(1, numba.config.NUMBA_NUM_THREADS + 1):
            numba.set_num_threads(threads)
            spent[threads] = min(spent.get(threads, math.inf), step_time(stepper))
    times = ", ".join(f"{threads}: {1e6 * t / liquid:.3f} ({1e6 * t / particles:.3f})" for threads, t in spent.items())
    near = float(np.mean(stepper.rows.number[stepper.active]))
    return (
        f"{dimensions}-D, {liquid} particles of liquid ({particles} with walls), {near:.0f} in a row: us per particle "
        f"and step by threads {times}; "
        f"speed-up {spent[1] / min(spent.values()):.2f}; {memory:.0f} bytes a particle"
    )


if __name__ == "__main__":
    wanted = sys.argv[1:] or DEFAULT
    if len(wanted) == 1:
        dimensions, count = wanted[0].split(":")
        print(measured(int(dimensions), float(count)))
    else:
        for one in wanted:
            subprocess.run([sys.executable, __file__, one], check=True)
