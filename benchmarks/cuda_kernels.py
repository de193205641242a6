"""Registers, spills and occupancy of the kernels of scenes, compiled for an H100 that need not be there.

    python benchmarks/cuda_kernels.py [scene or mps:scene ...]

Needs numba-cuda and nvidia-cuda-nvcc (`pip install 'sdph[cuda]' nvidia-cuda-nvcc`). Each scene begins and takes two
steps, in which its loops are heard of, with the types that its set of effects gives them; loops over pairs are not run
where it goes on without.
Columns: registers of a thread, bytes that spill, calls that were not taken in (a power is one), bytes of arguments,
threads of a multiprocessor over the most that it holds, in blocks of 128.
"""

import sys
from types import SimpleNamespace

import numpy as np

from coupling import by_cell
from coupling.transfer import Transfer
from sdph import scenes
from sdph.case import read as cases
from sdph.case.gas_cells import cell_edges
from sdph.engine.gpu import assembled
from sdph.exchange.exchange import Exchange
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
WHOLE = ("taylor_bar", "bubble_rise")  # all loops are run: what pairs give decides what comes next
STEPS, BY_MPS = 2, "mps:"


def loops_of(scene: str, *keys: str) -> list:
    """(loop, types of what it takes) of a scene's start and first steps."""
    ear = Followed() if scene in WHOLE else assembled.Heard()
    return loops_in(cases.load(scenes.find(scene)[1], keys), ear)


def loops_in(case, ear) -> list:
    """(loop, types of what it takes) that `ear` hears of in a case's start and first steps."""
    with ear as heard:
        if case.grains:
            of_grains(case)
        else:
            run = Alone(case, None)
            run.start()
            run.method.begin()
            run.method.advance(run.clock.next(run.time), STEPS)
    return list(heard.loops)


def of_grains(case) -> None:
    """Loops of grains that are on a device: those of a window, in a gas at rest."""
    own, dt = Grains(case), 1e-6
    own.start()
    own.begin()
    centres = np.array(np.meshgrid(*map(middles, cell_edges(case)), indexing="ij")).reshape(case.dimensions, -1).T
    centres = np.pad(centres, ((0, 0), (0, 3 - case.dimensions)))
    mesh = SimpleNamespace(
        centres=centres, volumes=np.ones(len(centres)), depth=1.0, dimensions=case.dimensions, spread=None
    )  # fmt: skip
    fields = {name: np.ones(len(centres)) for name in ("density", "temperature")}
    fields["vapour_mass_fraction"] = np.zeros(len(centres))
    fields |= {name: np.zeros_like(centres) for name in ("velocity", "vorticity")}
    gas = SimpleNamespace(fields=fields | {"power": np.zeros(len(centres))}, time=0.0)
    exchange = Exchange(case, mesh, own.parameters)
    transfer = Transfer(mesh, case.smoothing_length)
    transfer.weights(own.places() + 1e3)  # outside of the mesh
    weights = by_cell.listed(transfer.weights(own.places()))
    handed = exchange.hand(own.state, weights, (weights, own.share_inside()), gas, dt)
    taken = exchange.take(own.state, handed, gas)
    by_cell.deposit(weights, handed.velocity, np.zeros((weights.total, 3)))
    own.force(taken.warming, np.zeros_like(handed.velocity), handed.damping)
    own.advance(dt)


def middles(edges):
    """Middles of cells between edges."""
    return 0.5 * (edges[1:] + edges[:-1])


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
