"""Many sub-steps of the bed's engine: neither memory nor open files grow."""

import gc
import os
import resource
from pathlib import Path

import numpy as np
import pytest
from test_restart import load

from sdph import effects
from sdph.methods.grains import start
from sdph.methods.grains.method import Stepper

WARM, STEPS = 2000, int(os.environ.get("SDPH_LONG_STEPS", "20000"))  # 1e6 outside CI


def resident() -> int:
    """Bytes of memory that this process holds."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * resource.getpagesize()


def files() -> int:
    return len(os.listdir("/proc/self/fd"))


def test_neither_memory_nor_files_grow():
    case = load("bubbling_bed", "embedded", "resolution.spacing_mm=50", "particles.bed.upper_m=[0.5,0.25]")
    parameters = {row.name: effects.kernel_of(row, case) for row in effects.REGISTRY.values()}
    names = {name for effect in case.effects for name in effects.REGISTRY[effect].arrays}
    stepper = Stepper(case, parameters, start.fill(case, names))
    stepper.prepare()
    count = len(stepper.state.x)
    gravity = np.tile([0.0, -9.81, 0.0], (count, 1))
    nothing = np.zeros(count)

    def go(steps):
        end = stepper.steps + steps
        while stepper.steps < end:
            stepper.force(nothing, gravity, nothing)
            stepper.move(1e-2)

    go(WARM)
    gc.collect()
    before = resident(), files()
    go(STEPS)
    gc.collect()
    after = resident(), files()
    assert after[1] == before[1]
    assert after[0] - before[0] < 2 * 2**20, f"{(after[0] - before[0]) / 2**20:.1f} MiB more after {STEPS} sub-steps"
    assert np.isfinite(stepper.state.x).all()
    assert pytest.approx(len(stepper.state.x)) == count
