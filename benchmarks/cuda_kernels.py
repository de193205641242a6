"""Registers, spills and occupancy of the kernels of scenes, compiled for an H100 that need not be there.

    python benchmarks/cuda_kernels.py [scene or mps:scene ...]

Needs numba-cuda and nvidia-cuda-nvcc (`pip install 'sdph[cuda]' nvidia-cuda-nvcc`). Each scene begins and takes two
steps, in which its loops are heard of, with the types that its set of effects gives them; loops over pairs are not run.
Columns: registers of a thread, bytes that spill, calls that were not taken in (a power is one), bytes of arguments,
threads of a multiprocessor over the most that it holds, in blocks of 128.
"""

import sys

import numpy as np

from sdph import scenes
from sdph.case import read as cases
from sdph.engine.gpu import assembled
from sdph.methods.grains.grains import Grains
from sdph.running.alone import Alone
from sdph.study.explain.tables import table

LIQUIDS = (
    "dam_break", "dam_break_3d", "sloshing_box", "hydrostatic_tank", "square_patch", "taylor_green", "poiseuille",
    "water_under_air", "dam_break_gas",
)  # fmt: skip
GRAINS = ("bubbling_bed", "bubbling_bed_3d", "granular_jet", "segregation")
OTHERS = (
    "power_law_poiseuille", "capillary_wave", "bubble_rise", "channel_bore", "free_overfall", "sloshing_cassini",
    "taylor_bar",
)  # fmt: skip
# by moving particles: scene -> windows until all loops were called, keys; particles leave the sheet's domain, so short
MOVING = {
    "swirl_sheet": (20, "domain.size_m=[0.06, 0.06, 0.0005]", "resolution.spacing_mm=0.1"),
    "dam_break": (1, 'method.name="mps"', "resolution.spacing_mm=5.715"),
    "taylor_green": (1, 'method.name="mps"', "resolution.spacing_mm=50"),
}
STEPS, BY_MPS = 2, "mps:"


def loops_of(scene: str, *keys: str) -> list:
    """(loop, types of what it takes) of a scene's start and first steps."""
    case = cases.load(scenes.find(scene)[1], keys)
    with assembled.Heard() as heard:
        if case.grains:
            of_grains(case)
        else:
            run = Alone(case, None)
            run.start()
            run.method.begin()
            run.method.advance(run.clock.next(run.time), STEPS)
    return list(heard.loops)


class Followed(assembled.Heard):
    """Loops that were called; all of them are run."""

    def hear(self, loop, arguments):
        self.note(loop, arguments)
        return loop.here(*arguments)


def moving(scene: str) -> list:
    """(loop, types of what it takes) of a scene by moving particles."""
    windows, *keys = MOVING[scene]
    case = cases.load(scenes.find(scene)[1], keys)
    with Followed() as heard:
        run = Alone(case, None)
        run.start()
        for _ in range(windows):
            run.window()
    return list(heard.loops)


def of_grains(case) -> None:
    """Loops of grains that are on a device: those of a window's sub-steps."""
    own = Grains(case)
    own.start()
    own.begin()
    zeros = np.zeros(len(own.state.x))
    own.force(zeros, np.zeros((len(zeros), 3)), zeros)
    own.advance(1e-6)


def main(names) -> None:
    for name in names:
        scene, rows = name.removeprefix(BY_MPS), []
        loops = moving(scene) if name.startswith(BY_MPS) else loops_of(scene)
        for loop, taken in sorted(loops, key=lambda own: assembled.name_of(own[0])):
            found = assembled.assembled(loop, taken)
            named = dict(zip(("registers", "spills", "calls", "arguments", "occupancy"), found.told()))
            rows.append({"kernel": assembled.name_of(loop)} | named)
        print(f"{name}\n{table(rows)}\n", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:] or (*LIQUIDS, *GRAINS, *OTHERS, *(BY_MPS + scene for scene in MOVING)))
