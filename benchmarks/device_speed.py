"""A dam break on a CUDA device at growing numbers of particles: time per particle and step, by kernel too.

    python benchmarks/device_speed.py [DIMENSIONS:PARTICLES ...]

Rows are made anew once in six steps, as in liquid_scaling.py. `steps` runs as a run does; `kernels` waits after each
launch, which shows the kernels' own times. Particles are counted with walls, and those of liquid alone.
"""

import sys
import time
from collections import defaultdict

import numpy as np

from sdph.engine.gpu import card, found
from sdph.engine.gpu.toolkit import cuda
from sdph.methods.liquids import aboard
from sdph.study.bench import STEPS, step_time, tank

DEFAULT = ("2:1e5", "3:1e5", "2:1e6", "3:1e6")
ROUNDS = 3
FIELDS = ("x", "y", "z", "u", "v", "w", "density")


def of_kernels(stepper) -> dict:
    """Time [s] and launches by kernel of STEPS steps."""
    spent, launched = defaultdict(float), defaultdict(int)
    launch = card.Card._launch

    def timed(self, kernel, size, *arguments):
        cuda.synchronize()
        begun = time.perf_counter()
        launch(self, kernel, size, *arguments)
        queued = time.perf_counter()
        cuda.synchronize()
        name = kernel.py_func.__name__
        spent[name] += time.perf_counter() - begun
        spent["(to launch)"] += queued - begun
        launched[name] += 1

    card.Card._launch = timed
    try:
        step_time(stepper)
    finally:
        card.Card._launch = launch
    return {name: (spent[name], launched[name]) for name in sorted(spent, key=spent.get, reverse=True)}


def measured(dimensions: int, count: float) -> None:
    begun = time.perf_counter()
    stepper = tank(dimensions, count)
    made = time.perf_counter()
    small = count <= 2e5
    if small:
        twin = tank(dimensions, count)
    aboard.board(stepper)
    step_time(stepper)
    cuda.synchronize()
    first = time.perf_counter()
    if small:
        step_time(twin)
        ours = {name: getattr(stepper.state, name).copy_to_host() for name in FIELDS if len(getattr(stepper.state, name))}
        for name, values in ours.items():
            theirs = getattr(twin.state, name)
            print(f"  {name}: {np.abs(values - theirs).max() / max(np.abs(theirs).max(), 1e-300):.1e} of the largest")
        print(f"  processor: {min(step_time(twin) for _ in range(2)) / len(twin.active) * 1e6:.3f} us")
    particles, liquid = len(stepper.state.x), len(stepper.active)
    there = arrays_card()
    before = there.launches, there.sent.copy(), there.brought.copy()
    times = []
    for _ in range(ROUNDS):
        times.append(step_time(stepper))
        cuda.synchronize()
    steps = ROUNDS * STEPS
    spent = min(times)
    print(
        f"{dimensions}-D, {particles} particles, {liquid} of liquid: {1e3 * spent:.3f} ms a step ({', '.join(f'{1e3 * t:.3f}' for t in times)}), "
        f"{particles / spent:.3g} and {liquid / spent:.3g} particle-steps/s; launches a step "
        f"{(there.launches - before[0]) / steps:.1f}; to, from the host a step: {(there.sent - before[1]) / steps}, {(there.brought - before[2]) / steps}; "
        f"made in {made - begun:.1f} s, compiled and first steps {first - made:.1f} s; memory {cuda.current_context().get_memory_info()}"
    )
    for name, (seconds, many) in list(of_kernels(stepper).items())[:25]:
        print(f"  {name:20s} {1e3 * seconds / STEPS:9.3f} ms a step, {many / STEPS:5.1f} launches")
    sys.stdout.flush()


def arrays_card():
    return card.begun()


if __name__ == "__main__":
    print(found.described(), flush=True)
    for one in sys.argv[1:] or DEFAULT:
        dimensions, count = one.split(":")
        measured(int(dimensions), float(count))
