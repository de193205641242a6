"""Columns of grains that collapse onto a rough floor, in a plane, against the run-out that Lube et al. 2005 measured.

Half of a column, L wide and a L high, beside its plane of symmetry; it is let go at once. The deposit ends where grains
no longer cover the floor one grain deep, as its edge is seen in an experiment.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from sdph.study.compare import check
from sdph.study.validate import part

from . import alone

measured = part("experiments", "measured")

WIDTH = 0.1  # m, half of the column: that of Lube et al. is 9 cm
ASPECTS, SPACINGS = (1.0, 2.0, 3.0), (5e-3, 2.5e-3)  # -, m
END = 5.0  # sqrt(a L/g); the deposit is there after 3.3 (Lube et al. 2005)
ROOM = 2.0  # times the run-out that is expected; our choice
SMEAR = 4.0  # spacings over which a particle's grains count as spread out, about the reach of its kernel; our choice
BAR = 0.15  # scatter of what was measured
STILL = 1e-3  # of the energy of the fall of the column by its height: at rest; our choice


def checks(folder: Path, *_, aspects=ASPECTS, spacings=SPACINGS) -> list[dict]:
    rows, deposits = [], {}
    for a in aspects:
        for dx in spacings:
            run = collapsed(a, dx)
            deposits[a, dx] = run
            name = f"column a = {a:g}, {1e3 * dx:g} mm"
            rows.append(check(f"{name}: run-out over its half width [-]", runout(run), expected(a), BAR, True))
            rows.append(check(f"{name}: energy of motion left [-]", moving(run, a), 0.0, STILL))
    _figure(folder / "columns.png", deposits)
    return rows


def expected(a: float) -> float:
    """Run-out over half the width [-] by the fits to what was measured."""
    for row in measured.table("column_collapse"):
        if (row["geometry"], row["source"]) == ("planar", "Lube2005") and row["a_min"] <= a < row["a_max"]:
            return float(row["c"] * a ** row["n"])
    raise ValueError(f"no column of a = {a:g} was measured")


def collapsed(a: float, spacing: float):
    """The run of a column, at END."""
    size = (math.ceil((1.0 + ROOM * expected(a)) * WIDTH / spacing) * spacing, a * WIDTH + 4.0 * spacing)
    sides = {"axis": {"kind": "slip_wall", "side": "left"}, "rest": {"kind": "wall"}}
    run = alone.Alone(alone.case(size, ((0.0, 0.0), (WIDTH, a * WIDTH)), spacing, boundaries=sides))
    run.go(END * math.sqrt(a * WIDTH / alone.GRAVITY))
    return run


def depth(run) -> tuple[np.ndarray, np.ndarray]:
    """Places x [m] along the floor, and the depth [m] of grains there at the packing of the start."""
    spacing, s = run.case.resolution.spacing, run.state
    x, half = np.arange(0.0, run.case.domain.size[0], 0.25 * spacing), 0.5 * SMEAR * spacing
    area = np.append(0.0, np.cumsum(s.mass[np.argsort(s.x)])) / (alone.ALPHA_P * alone.DENSITY)
    place = np.sort(s.x)
    return x, (area[np.searchsorted(place, x + half)] - area[np.searchsorted(place, x - half)]) / (2.0 * half)


def runout(run) -> float:
    """Way of the front over the half width [-]."""
    x, deep = depth(run)
    bare = x[(deep < alone.DIAMETER) & (x > 0.5 * WIDTH)]
    return float((bare[0] if len(bare) else x[-1]) / WIDTH - 1.0)


def moving(run, a: float) -> float:
    """Energy of motion over m g a L [-]."""
    s = run.state
    return float(0.5 * s.mass @ (s.u**2 + s.v**2) / (s.mass.sum() * alone.GRAVITY * a * WIDTH))


def _figure(file: Path, deposits) -> None:
    with measured.figure(file, "x/L [-]", "depth/L [-]") as axes:
        for (a, dx), run in deposits.items():
            x, deep = depth(run)
            (line,) = axes.plot(x / WIDTH, deep / WIDTH, lw=1, label=f"a = {a:g}, {1e3 * dx:g} mm")
            axes.axvline(1.0 + expected(a), color=line.get_color(), ls=":", lw=0.7)
