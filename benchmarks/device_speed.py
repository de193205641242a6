"""A dam break on a CUDA device at growing numbers of particles: time per particle and step, by kernel too.

    python benchmarks/device_speed.py [DIMENSIONS:PARTICLES ...]

`steps`: rows are made anew once in six, as in liquid_scaling.py. `windows`: as a run goes, with ledger, guard and
limiters, no output. `kernels`: waits after each launch, which shows each kernel's own time and that of launching it.
Particles per second are those with walls, and those of liquid alone. Bytes are those of a step.
"""

import sys
import time
from collections import defaultdict

import numpy as np

from sdph.engine.gpu import card, found
from sdph.engine.gpu.toolkit import cuda
from sdph.methods.liquids import aboard
from sdph.running.alone import Alone
from sdph.study.bench import STEPS, dam, step_time

DEFAULT = ("2:1e5", "3:1e5", "2:1e6", "3:1e6", "2:1e7", "3:1e7")
ROUNDS, WINDOWS, SHOWN = 3, 3, 12
LAUNCHING = "(to launch)"


def of_kernels(go, steps: int) -> list[str]:
    """Lines of the time and launches a step, by kernel, of `go`, which takes as many steps; the longest first."""
    spent, launched, launch = defaultdict(float), defaultdict(int), card.Card._launch

    def timed(self, kernel, size, *arguments):
        cuda.synchronize()
        begun = time.perf_counter()
        launch(self, kernel, size, *arguments)
        spent[LAUNCHING] += time.perf_counter() - begun
        cuda.synchronize()
        spent[kernel.py_func.__name__] += time.perf_counter() - begun
        launched[kernel.py_func.__name__] += 1

    card.Card._launch = timed
    try:
        go()
    finally:
        card.Card._launch = launch
    order = sorted(spent, key=spent.get, reverse=True)[:SHOWN]
    return [f"  {own:16s} {1e3 * spent[own] / steps:8.3f} ms, {launched[own] / steps:4.1f} launches" for own in order]


def least(rounds: int, measure) -> float:
    """Least of the times [s] of as many rounds."""
    found = []
    for _ in range(rounds):
        cuda.synchronize()
        begun, steps = time.perf_counter(), measure()
        cuda.synchronize()
        found.append((time.perf_counter() - begun) / steps)
    return min(found)


def measured(dimensions: int, count: float) -> None:
    begun = time.perf_counter()
    run, there = Alone(dam(dimensions, count), None), card.begun()
    run.start()
    stepper = run.stepper
    aboard.board(stepper)
    made = time.perf_counter()
    run.window()
    step_time(stepper)
    ready = time.perf_counter()
    particles, liquid = len(stepper.state.x), len(stepper.active)
    print(
        f"{dimensions}-D: {particles} particles, {liquid} of liquid; made in {made - begun:.1f} s, "
        f"ready in {ready - made:.1f} s"
    )

    def steps() -> int:
        step_time(stepper)
        return STEPS

    def window() -> int:
        before = stepper.steps
        run.window()
        return stepper.steps - before

    for name, rounds, measure in (("steps", ROUNDS, steps), ("windows", WINDOWS, window)):
        before = np.array([there.launches, there.sent[1], there.brought[1], stepper.steps])
        spent = least(rounds, measure)
        launches, sent, brought, many = (
            np.array([there.launches, there.sent[1], there.brought[1], stepper.steps]) - before
        )
        print(
            f"{name}: {1e3 * spent:.3f} ms a step, {particles / spent:.3g} and {liquid / spent:.3g} particle-steps/s; "
            f"{launches / many:.1f} launches, {sent / many:.3g} bytes there, {brought / many:.3g} back"
        )
    free, whole = cuda.current_context().get_memory_info()
    print(
        f"{(whole - free) / particles:.0f} bytes of the device a particle",
        *of_kernels(steps, STEPS),
        sep="\n",
        flush=True,
    )


if __name__ == "__main__":
    print(found.described(), flush=True)
    for one in sys.argv[1:] or DEFAULT:
        dimensions, count = one.split(":")
        measured(int(dimensions), float(count))
