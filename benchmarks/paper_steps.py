"""The bubbling bed in this code's windows against the paper's own steps of 5 us: python benchmarks/paper_steps.py

Both on the embedded gas and from the same moment of the same run; cost is wall time per simulated second.
"""

import time

from sdph.study.bench import LARGE, bed

PAPER = 5e-6  # s, Chen, Qiang & Gao 2014, section 4.2: particles and gas alike
START, OURS, THEIRS = 0.02, 0.01, 0.002  # s of bed: before, and looked at each way


def cost(simulation, duration: float) -> tuple[float, int, int]:
    """Wall time [s] per simulated second over `duration` [s] or a little more; windows and sub-steps a simulated
    second."""
    begun, windows, steps, started = simulation.time, simulation.windows, simulation.stepper.steps, time.perf_counter()
    while simulation.time < begun + duration:
        simulation.window()
    wall, passed = time.perf_counter() - started, simulation.time - begun
    return (
        wall / passed,
        round((simulation.windows - windows) / passed),
        round((simulation.stepper.steps - steps) / passed),
    )


if __name__ == "__main__":
    simulation = bed(*LARGE, START)
    ours = cost(simulation, OURS)
    simulation.clock.limits["largest"] = PAPER
    theirs = cost(simulation, THEIRS)
    for name, (wall, windows, steps) in (("our windows", ours), ("steps of 5 us", theirs)):
        print(f"{name}: {wall:.0f} s wall per simulated second, {windows} windows and {steps} sub-steps in it")
    print(f"speed-up {theirs[0] / ours[0]:.1f}")
