"""The gas through a window, or through the part of it that it can finish."""

from __future__ import annotations

from coupling.gas import GasError
from sdph.case import judge
from sdph.methods.grains import expansion

PART = 4.0  # a window that the gas cannot finish is taken again, so much shorter (our choice),
REPEATS = 4  # so often at most: down to 1/256


def advance(run, end: float):
    """Gas of a `Simulation` through the window to `end` [s], or through the part of it that it can finish: where that
    ends, and what was handed. `GasError` where it finishes none."""
    for _ in range(REPEATS + 1):
        run.grains.begin()
        run.stepper.guard.rule(end - run.time, run.clock.limit)
        handed = run.timed("exchange", run.hand, end - run.time)
        failure = run.timed("gas", run.advance_gas, handed)
        if failure is None:
            if handed.alpha_g is not None:
                run.grains.tell_crowded(handed.alpha_g, run.gas.mesh.centres)
            return end, handed
        run.gas_state, tried = run.gas.retreat(), end - run.time
        end, run.repeated = run.time + tried / PART, run.repeated + 1
        run.notices.append(
            f"window {run.windows + 1}, t = {run.time:.6g} s: taken again, a quarter of {tried:.3g} s long, because "
            f"{failure}"
        )
    keys = f"coupling.window_largest_s below {tried:.2g} or coupling.courant (now {run.case.coupling.courant:g})"
    begins = expansion.told_by(run.case, judge.scales_of(run.case), run.time)
    raise GasError(
        f"the gas cannot finish window {run.windows + 1} at t = {run.time:.6g} s, not even {tried:.3g} s of it: "
        f"{failure}{begins}; lower {keys}, or look at what enters there ([boundaries], [nozzles]) and at "
        "resolution.cell_mm"
    )
