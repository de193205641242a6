"""Cost of a sub-step of the bubbling bed, part by part, on one thread and on two: python
benchmarks/grain_sub_step.py [spacing_mm] [until]

All effects, after `until` seconds of bed (0.01) on the embedded gas; 10 000 particles with a spacing of 5 mm, 324 with
27.8 mm. The least of all windows after that: of one thread the time of the processor, which knows nothing of other work
on the machine, of two the time on the wall.
"""

import sys
import time

import numba
import numpy as np

from sdph.study.bench import bed

WINDOWS = 30
WHOLE = ("_sub_step", "_advance", "prepare")  # of a stepper: what a sub-step goes through


class Timer:
    """Wraps a function; keeps its least time by `clock` and the sum of all [s]."""

    clock = time.process_time

    def __init__(self, function):
        self.function = function
        self.reset()

    def reset(self) -> None:
        self.least, self.sum = float("inf"), 0.0

    def __call__(self, *arguments):
        started = Timer.clock()
        result = self.function(*arguments)
        spent = Timer.clock() - started
        self.least, self.sum = min(self.least, spent), self.sum + spent
        return result


def timed(simulation) -> dict[str, Timer]:
    """Timers of whole sub-steps, of what limiters tell, of windows and of the transfer weights."""
    found, stepper = {}, simulation.stepper
    owners = ((simulation.transfer, "weights"), *((stepper, name) for name in (*WHOLE, "tell", "move")))
    for owner, name in owners:
        found[name] = Timer(getattr(owner, name))
        setattr(owner, name, found[name])
    return found


def loops(stepper) -> dict[str, float]:
    """Least time [ms] of each loop of a sub-step, called by itself."""
    zeros = np.zeros(len(stepper.state.x))
    stepper.force(zeros, np.zeros((len(zeros), 3)), zeros)
    found = {}
    for name, (loop, arguments) in stepper.loops(1e-7).items():
        own = Timer(loop)
        for _ in range(WINDOWS):
            own(*arguments)
        found[name] = 1e3 * own.least
    stepper.release()
    return found


def measured(simulation, timers) -> dict[str, float]:
    """Times [ms] of `WINDOWS` windows, then of the loops."""
    for timer in timers.values():
        timer.reset()
    steps = simulation.stepper.steps
    for _ in range(WINDOWS):
        simulation.window()
    row = {name: 1e3 * timer.least for name, timer in timers.items() if name != "move"}
    row["one sub-step"] = sum(row[name] for name in WHOLE)
    row["mean, rows and limiters too"] = 1e3 * timers["move"].sum / (simulation.stepper.steps - steps)
    return row | loops(simulation.stepper)


if __name__ == "__main__":
    spacing, until = (float(given) for given in (*sys.argv[1:], *("5.0", "0.01")[len(sys.argv) - 1 :]))
    simulation, times = bed(spacing, 10.0 if spacing < 10.0 else 20.0, until), {}
    timers = timed(simulation)
    for threads in range(1, numba.config.NUMBA_NUM_THREADS + 1):
        numba.set_num_threads(threads)
        Timer.clock = time.process_time if threads == 1 else time.perf_counter
        times[threads] = measured(simulation, timers)
    print(f"{len(simulation.state.x)} particles, [ms] on " + ", ".join(f"{threads} thread(s)" for threads in times))
    for name in times[1]:
        print(f"{name:28s}" + "".join(f"{row[name]:9.3f}" for row in times.values()))
