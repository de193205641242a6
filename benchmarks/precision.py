"""Gain of single precision: the loops over pairs with every array and number in 32 bits against 64.

    python benchmarks/precision.py

A bubbling bed at its own resolution, one sub-step; least time of several, results against those of 64 bits relative to
the largest. Positions in 32 bits resolve 6e-8 of the domain: the last row says what of a sub-step's motion is lost by
that.
"""

import time

import numpy as np

from sdph import scenes
from sdph.case import read as cases
from sdph.study.explain import effect_costs
from sdph.study.explain.tables import table

ROUNDS = 30
OUTPUTS = {"sum_density": 2, "shear": 3, "rates": 3}


def loops_of(simulation) -> dict[str, tuple]:
    """Loops of one sub-step by name, each with its arguments."""
    effect_costs.step(simulation, 1e-7)
    stepper = simulation.stepper
    zeros = np.zeros(len(stepper.state.x))
    stepper.force(zeros, np.zeros((len(zeros), 3)), zeros)
    return stepper.loops(1e-7)


def single(value):
    """Floats and arrays of floats in 32 bits, inside tuples too; all else as it is."""
    if isinstance(value, np.ndarray):
        return value.astype(np.float32) if value.dtype == np.float64 else value
    if isinstance(value, tuple):
        parts = [single(part) for part in value]
        return type(value)(*parts) if hasattr(value, "_fields") else tuple(parts)
    return np.float32(value) if isinstance(value, float) else value


def compared(name: str, loop, given: tuple) -> dict:
    """Time of a loop in 64 and 32 bits, and how far its outputs are apart."""
    count = OUTPUTS[name]
    both = given, single(given)
    for arguments_ in both:
        loop(*arguments_)
    apart = max(
        np.abs(a - b).max() / np.abs(a).max()
        for a, b in zip(both[0][-count:], both[1][-count:])
        if np.abs(a).max() > 0.0
    )
    times = np.array([[_timed(loop, arguments_) for arguments_ in both] for _ in range(ROUNDS)]).min(axis=0)
    return {
        "loop": name,
        "64 bits [us]": 1e6 * times[0],
        "32 bits [us]": 1e6 * times[1],
        "faster by": times[0] / times[1],
        "apart": float(apart),
    }


def _timed(loop, given) -> float:
    started = time.perf_counter()
    loop(*given)
    return time.perf_counter() - started


def lost_motion(simulation, dt: float) -> float:
    """Share of the particles' ways in a sub-step of `dt` [s] that positions in 32 bits round away, root mean square."""
    s = simulation.state
    way = s.v * dt
    kept = (s.y.astype(np.float32) + way.astype(np.float32)).astype(np.float64) - s.y.astype(np.float32)
    return float(np.sqrt(((kept - way) ** 2).mean() / (way**2).mean()))


if __name__ == "__main__":
    simulation = effect_costs.prepared(cases.load(scenes.HERE / "bubbling_bed" / "case.toml"))
    loops = loops_of(simulation)
    print(table([compared(name, *loops[name]) for name in OUTPUTS if name in loops]))
    simulation.state.v[:] = np.random.default_rng(1).normal(0.0, 0.01, len(simulation.state.v))  # 1 cm/s, the dense bed
    print(f"motion lost to positions in 32 bits, sub-step 1e-4 s at 1 cm/s: {lost_motion(simulation, 1e-4):.1%}")
