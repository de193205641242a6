"""A step of the swirling sheet by moving particles over a delta-SPH step of as many particles: CPU time of one thread.

    python benchmarks/moving_particles.py [SPACING_MM]

The sheet runs from its nozzle on until it fills the domain, so coarse that this takes minutes. The delta-SPH side is
the dam break of `liquid_scaling.py` in three dimensions, walls counted, its rows made anew every 6 steps. Both in turn,
the least of the rounds. Rows, pressure (source, matrix, solver, forces by it) and the rest are told apart.
Memory is the largest the process held less what it held before it had a case, per particle.
"""

import math
import sys
import time

from liquid_scaling import held

from sdph import scenes
from sdph.case import read as cases
from sdph.methods.mps.method import MpsStepper
from sdph.study import bench

SPACING, FILLED, STEPS, ROUNDS = 0.1, 1.5e-3, 12, 5  # mm; s, 1.5 times the way through the domain


def sheet_of(spacing: float):
    """The case of a sheet of this spacing [mm]."""
    return cases.load(scenes.HERE / "swirl_sheet" / "case.toml", (f"resolution.spacing_mm={spacing}",))


def flown(case) -> MpsStepper:
    """A stepper of the case's sheet that has filled its domain."""
    stepper = MpsStepper(case)
    while stepper.time < FILLED:
        stepper.step(FILLED - stepper.time)
    return stepper


class Timed:
    """Counts the CPU time [s] of a function that it stands for."""

    def __init__(self, function):
        self.function, self.spent = function, 0.0

    def __call__(self, *given):
        begun = time.process_time()
        out = self.function(*given)
        self.spent += time.process_time() - begun
        return out


def parts(stepper) -> dict[str, float]:
    """CPU time [s] of a step: rows, pressure, the rest; iterations."""
    rows, pressed, before = Timed(stepper.neighbours.update), Timed(stepper._pressed), stepper.iterations
    stepper.neighbours.update, stepper._pressed = rows, pressed
    begun = time.process_time()
    for _ in range(STEPS):
        stepper.step(1e-3)
    whole = (time.process_time() - begun) / STEPS
    stepper.neighbours.update, stepper._pressed = rows.function, pressed.function
    found = {"rows": rows.spent / STEPS, "pressure": pressed.spent / STEPS}
    return {"whole": whole} | found | {
        "rest": whole - sum(found.values()), "iterations": (stepper.iterations - before) / STEPS
    }  # fmt: skip


def main(spacing: float) -> None:
    case = sheet_of(spacing)
    before = held("VmRSS")
    own = flown(case)
    count = len(own.state.x)
    memory = (held("VmHWM") - before) / count
    other = bench.tank(3, 0.37 * count)  # of which with walls as many
    for _ in range(2):
        other.step(1.0)
    best, theirs = {"whole": math.inf}, math.inf
    for _ in range(ROUNDS):
        found = parts(own)
        best = min(best, found, key=lambda one: one["whole"])
        begun = time.process_time()
        bench.step_time(other)
        theirs = min(theirs, (time.process_time() - begun) / bench.STEPS)
    per = 1e6 / count
    told = ", ".join(f"{name} {per * best[name]:.2f}" for name in ("whole", "rows", "pressure", "rest"))
    tail = f"{best['iterations']:.1f} iterations; {memory:.0f} B a particle"
    print(f"sheet, {count} particles: us a particle and step: {told}; {tail}")
    unit = 1e6 / len(other.state.x)
    print(f"delta-SPH, {len(other.state.x)} particles ({len(other.active)} of liquid): {unit * theirs:.2f} us")
    print(f"ratio by particle {per * best['whole'] / (unit * theirs):.2f}, "
          f"by particle of liquid {per * best['whole'] / (1e6 * theirs / len(other.active)):.2f}")  # fmt: skip


if __name__ == "__main__":
    main(float(sys.argv[1]) if len(sys.argv) > 1 else SPACING)
