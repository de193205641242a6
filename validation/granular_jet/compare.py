"""The stream of agitated grains against OpenFOAM's two-fluid solver with the same closures and start.

Both runs are measured by one function (sdph.running.metrics.agitation), of the particles and of the cells.
"""

from __future__ import annotations

import dataclasses

from sdph.running.balances import work_of_gas
from sdph.running.metrics import agitation
from sdph.study.compare import check, times_of_both

from . import figures

TIMES = (0.05, 0.10, 0.15, 0.20)  # s; the shown ones too
# a step smeared over h = 3 mm in a layer that viscosity has made sqrt(nu t) = 9 mm wide at 0.05 s: h^2/(nu t)
BAR = 0.10
COURANT = 0.2  # of the stream in the two-fluid run, 0.8 ms: a quarter of it changes nothing by 1.3 % (README.md)
CELL = 4e-3  # m, of the two-fluid run, where grains need as fine a field as the particles are; half: README.md
AXIS = "y"  # along the stream


def tfm(run) -> list[dict]:
    """Rise of the grains, their energy of motion and of agitation, against twoPhaseEulerFoam."""
    from coupling.openfoam.comparators.run import run_two_fluid

    asked = run.outputs(TIMES)
    fine = dataclasses.replace(run.case.resolution, cell=CELL)
    case = dataclasses.replace(run.case, resolution=fine)
    reference = run_two_fluid(case, run.folder / "tfm", courant=COURANT)
    times = times_of_both(run, reference)
    start = run.case.domain.size[1] / 2
    own = [with_rise(_of_particles(run, t), start) for t in times]
    other = [with_rise(of_cells(case, reference, t), start) for t in times]
    figures.histories(run, times, own, other)
    figures.fields(run, reference, asked)
    names = {"rise_m": "rise of the grains [m]", "motion_J": "motion [J]", "agitation_J": "agitation [J]"}
    return [
        check(f"{names[key]} at {time:.2f} s", own[k][key], other[k][key], BAR, True)
        for key in names
        for time in asked
        for k in (run.output_at(times, time),)
    ] + work_of_gas(run.summary)


def with_rise(row: dict, start: float) -> dict:
    """A row of metrics with rise_m, the way [m] of the centre of the grains from `start` along the stream."""
    return row | {"rise_m": row[f"centre_{AXIS}_m"] - start}


def _of_particles(run, time: float) -> dict:
    rows = run.metrics
    k = run.output_at(rows["time_s"], time)
    return {name: float(column[k]) for name, column in rows.items()}


def of_cells(case, reference, time: float) -> dict:
    """`agitation.metrics` of the cells of a two-fluid run at `time` [s]."""
    fields = reference.fields[reference.nearest(time)]
    masses = fields["alpha_p"] * reference.volumes * case.grains.density
    velocities, theta = fields["particle_velocity"], fields["granular_temperature"]
    return agitation.metrics(reference.centres, masses, velocities, theta)
