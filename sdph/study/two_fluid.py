"""Any case of grains in a gas beside twoPhaseEulerFoam: same mesh, boundaries, closures and start.

A scene with a comparison of its own (validation/<scene>/compare.py) takes that. This one measures what every bed has,
by one function on the cells of both, as means over the second half of the run: a bubbling bed never repeats, and one
moment of it is chance. The bars are ours: a tenth, and for the place of the grains a twentieth of its height.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from coupling.openfoam import poly_mesh
from coupling.openfoam.comparators import known, two_fluid_fields, two_fluid_numbers
from coupling.openfoam.comparators.run import run_two_fluid
from coupling.openfoam.comparators.start import Start
from sdph.case import judge
from sdph.schema import CaseError
from sdph.study import cuts
from sdph.study.compare import check, times_of_both, too_short

BAR, PLACE, MASS, APART = 0.10, 0.05, 0.01, 0.20  # relative; APART: of the grains, how many stand in other cells
SHOWN = 4  # times of the figure
PICTURE = "compare_tfm.png"


class Cells(NamedTuple):
    """Fields of one side at T times on C cells: centres (C, D) [m], volumes (C,) [m3]; alpha_p and pressure [Pa], each
    (T, C); rise of the grains' mean temperature since the start [K], (T,)."""

    centres: np.ndarray
    volumes: np.ndarray
    alpha_p: np.ndarray
    pressure: np.ndarray
    warmth: np.ndarray


def lacks(case) -> list[str]:
    """Lines on what two fluids lack of a case."""
    return [*two_fluid_numbers.lacks(case), *two_fluid_fields.lacks(case)]


def tfm(run) -> list[dict]:
    """Checks of a run against two fluids, and `compare_tfm.png`."""
    first = run.fields(0.0)
    if first.gas is None:
        raise CaseError(f"{run.folder} has no gas; two fluids are compared with grains in a gas")
    known.refuse(lacks(run.case))
    if not first.particles.n_points:
        raise CaseError(f"{run.folder} has no grains at its start; two fluids begin with some")
    if too_short(run):
        return []
    box = first.gas.GetClassName() == "vtkRectilinearGrid"
    start = replace(_start(run.case, first), mesh=None if box else run.folder / "gas")
    reference = _by_the_metre(run_two_fluid(run.case, run.folder / "tfm", start=start), run.case, start)
    times = times_of_both(run, reference)
    own, other = _own(run, times, reference), _other(run.case, times, start, reference)
    picture(run, times, own, other)
    return checks(run.case, [k for k, t in enumerate(times) if t >= 0.5 * times[-1]], own, other)


def checks(case, late: list[int], own: Cells, other: Cells) -> list[dict]:
    """Checks of means over the times `late`."""
    weights = [cells.volumes * cells.alpha_p[late].mean(axis=0) * case.grains.density for cells in (own, other)]
    unit = "kg/m" if case.dimensions == 2 else "kg"
    found = [check(f"mass of the grains [{unit}]", *(weight.sum() for weight in weights), MASS, True)]
    if any(case.domain.gravity):
        found += _along_gravity(case, late, own, other, weights)
    if "heat" in case.effects and judge.scales_of(case).span:  # of one temperature there is the heat of motion alone
        warmer = [cells.warmth[late].mean() for cells in (own, other)]
        found.append(check("grains warmer than at the start, mean [K]", *warmer, BAR, True))
    apart = np.abs(weights[0] - weights[1]).sum() / (2.0 * weights[0].sum())
    return [*found, check("grains that stand in other cells, share", apart, 0.0, APART)]


def _by_the_metre(reference, case, start: Start):
    """The reference with the volumes of a plane mesh, of any depth, by the metre."""
    if case.dimensions == 3 or start.mesh is None:
        return reference
    return replace(reference, volumes=reference.volumes / np.ptp(poly_mesh.read(start.mesh).points[:, 2]))


def _along_gravity(case, late, own: Cells, other: Cells, weights) -> list[dict]:
    """Height of the grains' middle, and the gas's pressure from floor to lid."""
    heights = own.centres @ -np.asarray(case.domain.gravity) / np.linalg.norm(case.domain.gravity)
    middles = [weight @ heights / weight.sum() - heights.min() for weight in weights]
    ends = [np.abs(heights - end) < 0.5 * case.resolution.cell for end in (heights.min(), heights.max())]
    means = [cells.pressure[late].mean(axis=0) for cells in (own, other)]
    floors, lids = ([np.average(mean[at], weights=own.volumes[at]) for mean in means] for at in ends)
    falls = np.subtract(floors, lids)
    return [
        check("middle of the grains over the lowest cells [m]", *middles, PLACE, True),
        check("pressure of the gas from floor to lid [Pa]", *falls, BAR, True),
    ]


def _start(case, first) -> Start:
    """Grains as the first output has them; velocity and temperature of a cell are those of the nearest particle."""
    centres = np.asarray(first.gas.cell_centers().points)[:, : case.dimensions]
    nearest = cKDTree(np.asarray(first.particles.points)[:, : case.dimensions]).query(centres)[1]
    velocity, warmth = np.asarray(first.particles["velocity"])[nearest], _temperature(case, first)[nearest]
    return Start(centres, np.asarray(first.gas["alpha_p"]), velocity, warmth)


def _temperature(case, instant) -> np.ndarray:
    """Temperature [K] of the particles; where the case follows none, that of its gas."""
    if "temperature" not in instant.particles.array_names:
        return np.full(instant.particles.n_points, case.gas.temperature)
    return np.asarray(instant.particles["temperature"])


def _own(run, times, reference) -> Cells:
    """The run's fields on the cells of the reference."""
    where, rows, begun = reference.centres[:, : run.case.dimensions], [], _mean_temperature(run, 0.0)
    for t in times:
        instant = run.fields(t)
        centres = np.asarray(instant.gas.cell_centers().points)[:, : run.case.dimensions]
        same = cKDTree(centres).query(where)[1]
        alpha_p, pressure = (np.asarray(instant.gas[name])[same] for name in ("alpha_p", "pressure"))
        rows.append((alpha_p, pressure, _mean_temperature(run, t) - begun))
    return Cells(where, reference.volumes, *map(np.array, zip(*rows)))


def _mean_temperature(run, time: float) -> float:
    instant = run.fields(time)
    return float(np.average(_temperature(run.case, instant), weights=instant.particles["mass"]))


def _other(case, times, start: Start, reference) -> Cells:
    where = reference.centres[:, : case.dimensions]
    rows = [[reference.fields[t][name] for t in times] for name in ("alpha_p", "pressure", "particle_temperature")]
    alpha_p, pressure, temperature = map(np.array, rows)
    warmth = np.average(temperature, weights=alpha_p * reference.volumes, axis=1)
    begun = start.at(where)
    warmth -= np.average(begun.temperature, weights=begun.alpha_p * reference.volumes)
    return Cells(where, reference.volumes, alpha_p, pressure, warmth)


def picture(run, times, own: Cells, other: Cells) -> None:
    """alpha_p of both sides at four times, the run above; in three dimensions on an upright cut through the middle."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    pieces, numbers = cuts.cut(run.case, run.fields(0.0).gas)
    numbers = cKDTree(own.centres).query(numbers)[1]
    width, height = np.ptp(np.concatenate(pieces), axis=0)
    shown = sorted({round(k) for k in np.linspace(0, len(times) - 1, SHOWN)})
    size = (2.2 * len(shown) + 1.2, 2 * max(1.2, min(4.0, 2.2 * height / width)) + 0.8)
    figure, axes = pyplot.subplots(2, len(shown), figsize=size, layout="constrained", squeeze=False)
    for column, k in enumerate(shown):
        for row, cells in enumerate((own, other)):
            values, most = cells.alpha_p[k][numbers], run.case.grains.packing_limit
            image = cuts.painted(axes[row, column], pieces, values, (0.0, most), "alpha_p")
        axes[0, column].set_title(f"{times[k]:.3g} s")
    for axis, name in zip(axes[:, 0], ("SDPH", "two fluids")):
        axis.set_ylabel(name)
    figure.colorbar(image, ax=axes, label="volume fraction of grains [-]")
    figure.savefig(run.folder / PICTURE, dpi=120)
    pyplot.close(figure)
