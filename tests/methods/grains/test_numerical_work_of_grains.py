"""What explicit sub-steps make of the work of grains (`numerical_work_J` of the ledger) is first order in their length.
docs/results.md has the table."""

import itertools
import math

import numpy as np
from grain_boxes import started, table, windows

from sdph.case import read as cases

END, EFFECTS = 0.02, ("drag", "granular_pressure", "granular_viscosity", "granular_temperature", "friction",
                      "artificial_viscosity", "conduction")  # fmt: skip


def done(folder, factor, *more, **given):
    """A run of a box of grains to END in ten windows, its sub-steps `factor` times as long as they may be."""
    own = table([*EFFECTS, *more], **given, **windows(END, 10))
    own["run"]["step_factor"] = factor
    if more:
        own["particles"]["bed"]["velocity_m_s"] = [0.0, -0.5]
    run = started(cases.from_table(own), folder)
    if not more:
        s, k = run.grains.state, 2.0 * math.pi / 0.06
        s.u[:], s.v[:] = 0.3 * np.sin(k * s.y), 0.2 * np.sin(k * s.x)
    while run.time < END * (1.0 - 1e-9):
        run.window()
    run.ledger.table.close()
    return run


def orders(folder, factors, *more, **given) -> list[float]:
    """Orders in the number of sub-steps, from one of `factors` to the next."""
    found = []
    for factor in factors:
        (own := folder / str(factor)).mkdir()
        run = done(own, factor, *more, **given)
        work, share = run.ledger.sums["numerical_work_J"], run.ledger.summary()["numerical_work_rel"]
        found.append((run.grains.steps, abs(work)))
        print(f"{run.grains.steps} sub-steps: {work:.4g} J, {share:.3%} of what is dissipated")
    return [math.log(b / d) / math.log(c / a) for (a, b), (c, d) in itertools.pairwise(found)]


def test_stirred_grains(tmp_path):
    found = orders(tmp_path, (0.25, 0.125, 0.0625, 0.03125))
    print("orders", found)
    assert all(0.9 < order < 1.1 for order in found)


def test_a_bed_that_falls_on_its_floor(tmp_path):
    found = orders(tmp_path, (0.5, 0.25, 0.125, 0.0625), "gravity", "walls", periodic=("x",), gravity=(0.0, -9.81))
    print("orders", found)
    assert all(0.9 < order < 1.2 for order in found)
