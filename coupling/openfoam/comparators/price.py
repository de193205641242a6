"""Time that OpenFOAM's solvers take for a reference, told before they begin: of steps, of cells and of parcels.

Prices are those of the runs in `validation/bubbling_bed/cost.csv` (two fluids, 1250 to 20 000 cells, within 17 %) and
`validation/evaporating_jet/cost.csv` (droplets, 600 to 9600 cells, within 10 %), 27 November 2026, on one core. What a
parcel takes is less sure: 0.5 to 2 us fit that record alike, and a run with eight times the parcels on a busy machine
said more, so that it is the largest of these. On another machine all hold to about a factor of two.
"""

from __future__ import annotations

import itertools
import math
import re
from typing import NamedTuple

from coupling.openfoam.comparators.droplet_sources import Injector
from coupling.openfoam.poly_mesh import PolyMesh
from sdph.case.gas_cells import cells
from sdph.case.sections import Case

ROW = re.compile(r"\(([^ ()]+) ([^ ()]+)\)")  # of a table of steps against time


class Price(NamedTuple):
    """Time [s] of a step, of a step of each cell and of each parcel."""

    step: float
    cell: float
    parcel: float


TWO_FLUIDS = Price(3.4e-3, 2.7e-6, 0.0)
DROPLETS = Price(1.5e-3, 2.1e-6, 2e-6)


def of_two_fluids(case: Case, numbers: dict[str, str], mesh: PolyMesh | None) -> str:
    """Words on a run with these macros (`two_fluid_numbers.macros`), on a mesh of the case's own or that of its box."""
    number, count = steps(case.run.end_time, numbers), _cells(case, mesh)
    return f"{count} cells, {number} steps{_about(TWO_FLUIDS, number, count, 0.0)}"


def of_droplets(case: Case, injectors: list[Injector], step: float, mesh: PolyMesh | None) -> str:
    """Words on a run with these injectors and steps of `step` [s]; half of all parcels are there on average."""
    number, count = steps(case.run.end_time, {"time_step": repr(step)}), _cells(case, mesh)
    parcels = sum(len(one.rows.mass) * max(1, round(one.duration / step)) for one in injectors)
    about = _about(DROPLETS, number, count, 0.5 * parcels)
    return f"{count} cells, {number} steps, up to {parcels} parcels{about}"


def steps(end: float, numbers: dict[str, str]) -> int:
    """Steps to an end [s], of one length or as a table against time has them, linear between its rows."""
    if "time_step" in numbers:
        return math.ceil(end / float(numbers["time_step"]) * (1.0 - 1e-9))
    rows = [(float(time), float(step)) for time, step in ROW.findall(numbers["time_steps"])]
    ends = [*(min(time, end) for time, _ in rows), end]
    lengths = [*(step for _, step in rows), rows[-1][1]]
    parts = zip(itertools.pairwise(ends), itertools.pairwise(lengths))
    return math.ceil(sum((after - before) / (0.5 * (a + b)) for (before, after), (a, b) in parts))


def _cells(case: Case, mesh: PolyMesh | None) -> int:
    return len(mesh.volumes) if mesh else math.prod(cells(case))


def _about(price: Price, number: int, count: int, parcels: float) -> str:
    took = number * (price.step + price.cell * count + price.parcel * parcels)
    return f": about {took:.2g} s, an estimate to a factor of two; what is left is told every ten seconds"
