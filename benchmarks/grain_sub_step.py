"""Cost of a sub-step of the bubbling bed, part by part, on one thread and on two: python
benchmarks/grain_sub_step.py [until]

10 000 particles, all effects, after `until` seconds of bed (0.01) on the embedded gas. Least of all windows after that.
"""

import sys
import time

import numba

from sdph import scenes
from sdph.case import read as cases
from sdph.effects.around import wall_contact, walls
from sdph.effects.grains import granular_temperature
from sdph.methods.grains import contacts as shearing
from sdph.methods.grains import equations as rates
from sdph.running.simulation import Simulation

WINDOWS = 12
LOOPS = {
    shearing: ("shear",),
    rates: ("sum_density", "constitutive", "rates"),
    walls: ("extrapolate",),
    wall_contact: ("contact",),
    granular_temperature: ("advance_all",),
}


class NoLedger:
    """Takes the rows and forgets them."""

    table = None

    def open(self, *row) -> None:
        pass

    def close_window(self, *row) -> None:
        pass


class Timer:
    """Wraps a function; keeps its least wall time [s]."""

    def __init__(self, function):
        self.function, self.least = function, float("inf")

    def __call__(self, *arguments):
        started = time.perf_counter()
        result = self.function(*arguments)
        self.least = min(self.least, time.perf_counter() - started)
        return result


def bed(until: float) -> Simulation:
    from coupling.embedded import EmbeddedGas

    case = cases.load(scenes.HERE / "bubbling_bed" / "case.toml")
    simulation = Simulation(case, EmbeddedGas(case), NoLedger())
    simulation.start()
    while simulation.time < until:
        simulation.window()
    return simulation


def timed(simulation) -> dict[str, Timer]:
    """Timers of the loops, of whole sub-steps and of the transfer weights."""
    found = {}
    for module, names in LOOPS.items():
        for name in names:
            found[name] = Timer(getattr(module, name))
            setattr(module, name, found[name])
    stepper = simulation.stepper
    for owner, name in (
        (simulation.transfer, "weights"),
        (stepper, "_sub_step"),
        (stepper, "_advance"),
        (stepper, "prepare"),
    ):
        found[name] = Timer(getattr(owner, name))
        setattr(owner, name, found[name])
    return found


if __name__ == "__main__":
    simulation = bed(float(sys.argv[1]) if sys.argv[1:] else 0.01)
    timers, times = timed(simulation), {}
    for threads in range(1, numba.config.NUMBA_NUM_THREADS + 1):
        numba.set_num_threads(threads)
        for timer in timers.values():
            timer.least = float("inf")
        for _ in range(WINDOWS):
            simulation.window()
        times[threads] = {name: 1e3 * timer.least for name, timer in timers.items()}
        times[threads]["one sub-step"] = sum(times[threads][name] for name in ("_sub_step", "_advance", "prepare"))
    print(f"{len(simulation.state.x)} particles, [ms] on " + ", ".join(f"{threads} thread(s)" for threads in times))
    for name in times[1]:
        print(f"{name:16s}" + "".join(f"{row[name]:9.3f}" for row in times.values()))
