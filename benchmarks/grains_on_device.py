"""A sub-step of the bubbling bed in space on a CUDA device: time of it and of rows made anew, by kernel too.

    python benchmarks/grains_on_device.py [COLUMNS ...] [--cpu]

COLUMNS of particles across the bed's 0.5 m, a multiple of 50, as the jet ends on an edge of a cell: 100 are 80 000
particles in all, 250 are 1 250 000. There is no gas at first: nothing holds the particles up, and all go on with a
tenth of a metre a second; times of kernels are with a wait after each launch. Then windows of the same bed on the
embedded gas. With --cpu the processor takes the same; without a device the simulator would take hours.
"""

import sys
import time

from coupling.embedded import EmbeddedGas
from sdph import scenes
from sdph.case import read as cases
from sdph.engine import arrays, ashore
from sdph.methods.grains.grains import Grains
from sdph.running.simulation import Simulation
from sdph.study.bench import LONG
from sdph.study.explain.effect_costs import NoLedger

DEFAULT, STEPS, ROUNDS, WINDOW = (100, 250), 20, 3, 1.0
WINDOWS = 10


def case_of(columns: int, device: str):
    spacing = 500.0 / columns
    keys = [f"resolution.spacing_mm={spacing}", f"resolution.cell_mm={2.0 * spacing}", f'run.device="{device}"']
    return cases.load(scenes.find("bubbling_bed_3d")[1], [*keys, *LONG])


def started(columns: int, device: str) -> Grains:
    """Grains in a window in which nothing pushes them."""
    own = Grains(case_of(columns, device))
    own.start()
    own.state.v[:] = 0.1
    own.begin()
    nothing = arrays.zeros(len(own.state.x), own.state.x)
    own.force(nothing, arrays.vectors(nothing, nothing, nothing), nothing)
    return own


def step(stepper) -> None:
    stepper._advance(stepper._sub_step(1e-5), WINDOW)
    stepper.guard.sub_step(stepper)
    stepper.prepare(stepper.MOVING)


def mean(stepper, wait) -> float:
    """Mean time [s] of STEPS sub-steps."""
    begun = time.perf_counter()
    for _ in range(STEPS):
        step(stepper)
    wait()
    return (time.perf_counter() - begun) / STEPS


def measured(columns: int, device: str) -> None:
    own = started(columns, device)
    stepper, count, wait = own.stepper, len(own.state.x), lambda: None
    if device == "cuda":
        from sdph.engine.gpu.toolkit import cuda

        wait = cuda.synchronize
    mean(stepper, wait)
    least = min(mean(stepper, wait) for _ in range(ROUNDS))
    for _ in range(2):  # the first time compiles
        stepper.neighbours.built = ()
        begun = time.perf_counter()
        stepper.prepare()
        wait()
        anew = time.perf_counter() - begun
    print(f"{count} particles on {device}: {1e3 * least:.3f} ms a sub-step, {count / least:.3g} particle-steps/s")
    print(f"  rows made anew: {1e3 * anew:.2f} ms")
    if device == "cuda":
        from device_speed import of_kernels  # it asks for a device

        print(*of_kernels(lambda: mean(stepper, wait), STEPS), sep="\n")
    own.stepper.release()


def of_windows(columns: int, device: str) -> None:
    """Windows of a run on the embedded gas: the time of their parts, exchange, particles and gas."""
    case = case_of(columns, device)
    run = Simulation(case, EmbeddedGas(case), NoLedger())
    run.start()
    for _ in range(2):
        run.window()
    before, steps, begun = dict(run.wall), run.stepper.steps, time.perf_counter()
    for _ in range(WINDOWS):
        run.window()
    whole, steps = time.perf_counter() - begun, run.stepper.steps - steps
    told = ", ".join(f"{name} {1e3 * (spent - before[name]) / WINDOWS:.2f}" for name, spent in run.wall.items())
    print(f"  a window of {steps / WINDOWS:.1f} sub-steps: {1e3 * whole / WINDOWS:.2f} ms, of them {told}")
    moved = ashore.told(run.stepper)
    print("  " + ", ".join(f"{name} {value:.4g}" for name, value in moved.items()), flush=True)


if __name__ == "__main__":
    where = "cpu" if "--cpu" in sys.argv else "cuda"
    for given in [int(word) for word in sys.argv[1:] if word.isdigit()] or DEFAULT:
        measured(given, where)
        of_windows(given, where)
