"""The bubbling bed against OpenFOAM's two-fluid solver, and against what the paper says of it.

Both runs are measured by one function (sdph.running.metrics.bubble) on the same mesh. The paper's own description
(section 4.2, figures 6 to 10) is checked point by point.
"""

from __future__ import annotations

import dataclasses
import math

import numpy as np
from scipy.spatial import cKDTree

from coupling.gas import Mesh
from sdph.case.gas_cells import CellRows
from sdph.running.balances import work_of_gas
from sdph.running.metrics import bubble
from sdph.schema import CaseError
from sdph.show import timeline
from sdph.study.compare import check, times_of_both

from . import figures

SHOWN = (0.05, 0.10, 0.15, 0.20, 0.24)  # s, the figure's columns
LARGEST = 0.20  # s, when the paper's bubble is largest and lets go
GROWING = (0.05, 0.10, 0.15, 0.20, 0.25)  # s
LATE = 0.30  # s, reported: a second bubble is there by then, and what the first one is depends on the cells
CLUMPED, NEARER = 0.005, 0.5  # of the particles, most that may be nearer to another than this, of a spacing
AREA, AREA_BEFORE_AND_AFTER = 0.08, 0.10  # of the two-fluid area, at LARGEST and at the other times
PRESSURE = 0.02  # of the drop of two fluids: both carry the same weight, to 2 % as in fluidised_column; our choice
CENTROID = 0.010  # m
HEIGHT = 0.02  # of the two-fluid height
RESOLVED = 0.19  # Courant number of the two-fluid run (0.25 ms): its area no longer depends on the step (README.md)
DETACHMENT = 0.02  # s
HOTTEST = 3.0  # K
# at 0.1 s, limit of cells of 20, 10 and 5 mm (README.md)
TWO_FLUIDS = {"bubble_diameter_m": 0.1268, "bubble_centroid_m": 0.0463}
TWO_FLUIDS_HEAT = 705.6  # J, the same of what the grains take up
COMPARED_CELLS = (0.02, 0.01, 0.005)  # m, of the two-fluid runs that `sdph cost` draws
ROUND_OFF = 1e-12  # of a limit: heights are multiples of a cell
# readings of ours of what the paper says in words
FADED = 0.2  # of what was: "tends to zero"
NEAR = 0.5  # of the way out: "comes back to near its first place"
WARM = 0.1  # K, a twentieth of the figure's scale: "a zone that warms at the outer edge of the bubble"


def tfm(run) -> list[dict]:
    """Bubble metrics against twoPhaseEulerFoam with the same closures, mesh and inlet."""
    from coupling.openfoam.comparators.run import run_two_fluid

    _reaches(run, LARGEST)
    growing = run.outputs(GROWING)
    reference = run_two_fluid(run.case, run.folder / "tfm", courant=RESOLVED)
    times = times_of_both(run, reference)
    own, other = [_own(run, t) for t in times], [_other(reference, t) for t in times]
    figures.metrics(run, times, own, other)
    figures.fields(run, reference, [t for t in SHOWN if t <= times[-1]])
    found = [*_checks(times, own, other), *_bubble_checks(growing, times, own, other)]
    late = run.outputs((LATE,))
    found += [row | {"tolerance": math.inf, "ok": True} for row in _bubble_checks(late, times, own, other)]
    return [*found, *_finer(run, growing, times, own), *_clumps(run, late), *work_of_gas(run.summary)]


def _clumps(run, late) -> list[dict]:
    """Share of the particles that are nearer to another than NEARER spacings."""
    rows = []
    for t in late:
        _, grains, _ = run.fields(t)
        nearest = cKDTree(grains.points).query(grains.points, 2)[0][:, 1]
        share = float((nearest < NEARER * run.case.resolution.spacing).mean())
        rows.append(_below(f"particles nearer to another than half a spacing at {t:.2f} s [-]", share, CLUMPED))
    return rows


def _finer(run, growing, times, own) -> list[dict]:
    """The bubble against two fluids on cells of half the size, where they have converged to 4 % (README.md)."""
    from coupling.openfoam.comparators.run import run_two_fluid

    half = dataclasses.replace(run.case.resolution, cell=run.case.resolution.cell / 2)
    reference = run_two_fluid(dataclasses.replace(run.case, resolution=half), run.folder / "tfm_fine", courant=RESOLVED)
    other = [_other(reference, t) for t in times]
    return _bubble_checks(growing, times, own, other, ", two fluids on cells of half the size")


def paper(run) -> list[dict]:
    """The paper's description of figures 6 to 10, each point with its number."""
    _reaches(run, SHOWN[-1])
    history = run.history
    times = [t for t in timeline.read(run.folder).time_values if t > 0.0]
    rows = [_own(run, t) for t in times]
    beside, above = (_tracked(history, ident) for ident in (645, 1050))
    checks = [
        check("fig. 6: bubble lets go of the floor [s]", bubble.detachment(times, rows), LARGEST, DETACHMENT),
        _below("fig. 6: equivalent diameter at 0.20 s [m]", _own(run, LARGEST)["bubble_diameter_m"], 0.195),
        _above(
            "fig. 6: wake at 0.24 s, rise of the underside in its middle [m]",
            _wake(run, 0.24),
            run.case.resolution.cell,
        ),
        check(
            "fig. 7: highest gas temperature in the middle at 0.20 s [K]",
            _own(run, LARGEST)["gas_temperature_max_K"],
            345.0,
            HOTTEST,
        ),
        _above("fig. 8: grains at the bubble's rim at 0.20 s over those elsewhere [K]", _warm_rim(run), WARM),
        _above(
            "fig. 9: 645 moves outward first [m]", beside["x_m"][0] - beside["x_m"].min(), run.case.resolution.spacing
        ),
        _above("fig. 9: 645 comes back, of the way that it went [-]", _way_back(beside["x_m"]), NEAR),
        _above("fig. 9: 645 then moves up [m]", beside["y_m"][-1] - beside["y_m"][0], run.case.resolution.spacing),
        _above("fig. 9: 1050 moves up [m]", above["y_m"][-1] - above["y_m"][0], run.case.resolution.spacing),
        _below(
            "fig. 10: heat to 645 at 0.24 s over its largest before 0.20 s [-]",
            _left(history, beside["convective_heat_W"], 0.24),
            FADED,
        ),
        _above(
            "fig. 10: mean heat to 1050 after 0.20 s over that before [-]",
            _growth(history, above["convective_heat_W"]),
            1.0,
        ),
        _below(
            "fig. 10: conduction to 1050 at 0.22 s over its largest before 0.20 s [-]",
            _left(history, above["conductive_heat_W"], 0.22),
            FADED,
        ),
    ]
    return checks


def _reaches(run, time: float) -> None:
    if run.summary["time_s"] < time * (1.0 - ROUND_OFF):
        raise CaseError(
            f"the run ends at {run.summary['time_s']:g} s and is compared until {time:g} s; go on with: sdph run "
            f"--resume {run.folder} --until {time:g}"
        )


def metrics(run) -> dict[str, tuple]:
    """Metrics of `sdph cost`: the bubble at the end of the excerpt, and the heat to the grains, against the limit of
    two fluids."""
    return _metrics(run.summary, run.summary["heat_exchanged_J"])


def _metrics(bubble_at_end: dict, heat: float) -> dict[str, tuple]:
    own = {name: (bubble_at_end[name], limit, None) for name, limit in TWO_FLUIDS.items()}
    return own | {"heat to the grains [J]": (heat, TWO_FLUIDS_HEAT, None)}


def others(case, folder):
    """Others in `sdph cost`: (label, solver, wall time [s], metrics) of two fluids on finer and finer cells."""
    from coupling.openfoam.comparators.run import run_two_fluid

    for number, cell in enumerate(COMPARED_CELLS):
        refined = dataclasses.replace(case, resolution=dataclasses.replace(case.resolution, cell=cell))
        reference = run_two_fluid(refined, folder / f"tfm_{number}")
        at_end = _other(reference, case.run.end_time)
        yield (
            f"all {number + 1}/{len(COMPARED_CELLS)}, {1e3 * cell:g} mm",
            reference.solver,
            reference.wall,
            _metrics(at_end, _heat(reference, case)),
        )


def _heat(reference, case) -> float:
    """Heat that the grains of a two-fluid run have taken up [J], per metre of depth."""
    fields = reference.fields[reference.nearest(case.run.end_time)]
    warmth = fields["alpha_p"] * (fields["particle_temperature"] - case.particles["bed"].temperature)
    return float((warmth * reference.volumes).sum() * case.grains.density * case.grains.heat_capacity)


def _checks(times, own, other) -> list[dict]:
    k = int(np.argmin(np.abs(np.array(times) - LARGEST)))
    return [
        check("detachment [s], reference the paper's", bubble.detachment(times, own), LARGEST, DETACHMENT),
        check(
            "detachment [s], reference two fluids",
            bubble.detachment(times, own),
            bubble.detachment(times, other),
            DETACHMENT,
        ),
        check("pressure drop at 0.20 s [Pa]", own[k]["pressure_drop_Pa"], other[k]["pressure_drop_Pa"], PRESSURE, True),
    ]


def _bubble_checks(growing, times, own, other, beside="") -> list[dict]:
    """Area, centroid, height and hottest gas at the times `growing` among `times`; `beside` ends the names."""
    rows = []
    for t in growing:
        i = int(np.argmin(np.abs(np.array(times) - t)))
        area = AREA if t == LARGEST else AREA_BEFORE_AND_AFTER
        bars = {"bubble_area_m2": (area, True), "bubble_centroid_m": (CENTROID, False), "bed_height_m": (HEIGHT, True)}
        for name, bar in (bars | {"gas_temperature_max_K": (HOTTEST, False)}).items():
            words, unit = name.rsplit("_", 1)
            label = f"{words.replace('_', ' ')} at {t:.2f} s [{unit}]{beside}"
            rows.append(check(label, own[i][name], other[i][name], *bar))
    return rows


def _own(run, time: float) -> dict:
    _, _, gas = run.fields(time)
    sizes = np.asarray(gas.compute_cell_sizes()["Area"])
    return bubble.metrics(
        gas.cell_centers().points, sizes, *(np.asarray(gas[name]) for name in ("alpha_p", "temperature", "pressure"))
    )


def _other(reference, time: float) -> dict:
    fields = reference.fields[reference.nearest(time)]
    return bubble.metrics(
        reference.centres, reference.volumes, *(fields[name] for name in ("alpha_p", "gas_temperature", "pressure"))
    )


def _below(name: str, value: float, limit: float) -> dict:
    return {"name": name, "value": float(value), "reference": limit, "tolerance": 0.0, "ok": bool(value <= limit)}


def _above(name: str, value: float, limit: float) -> dict:
    least = limit - ROUND_OFF * abs(limit)
    return {
        "name": name,
        "value": float(value),
        "reference": limit,
        "tolerance": limit - least,
        "ok": bool(value >= least),
    }


def _tracked(history, ident: int) -> dict[str, np.ndarray]:
    prefix = f"particle_{ident}_"
    return {key.removeprefix(prefix): column for key, column in history.items() if key.startswith(prefix)}


def _left(history, values, time: float) -> float:
    """Size of the mean over 10 ms around `time` over the largest of such means before the bubble lets go."""
    clock = history["time_s"]
    means = [abs(values[np.abs(clock - t) <= 0.005].mean()) for t in np.arange(0.01, LARGEST, 0.005)]
    return float(abs(values[np.abs(clock - time) <= 0.005].mean()) / max(means))


def _growth(history, values) -> float:
    late = history["time_s"] > LARGEST
    return float(values[late].mean() / values[~late].mean())


def _way_back(x) -> float:
    """Share of its way out to the left that a particle has come back by; 0 where it never went."""
    out = x[0] - x.min()
    return float((x[-1] - x.min()) / out) if out > 0.0 else 0.0


def _warm_rim(run) -> float:
    """Mean temperature of the grains within a kernel's reach of the bubble less that of all others [K], at 0.20 s."""
    _, grains, gas = run.fields(LARGEST)
    centres = gas.cell_centers().points
    sizes = np.asarray(gas.compute_cell_sizes()["Area"])
    void = bubble.largest_void(centres, CellRows(Mesh(centres, sizes, 2), bubble.UP), np.asarray(gas["alpha_p"]))
    near = cKDTree(centres[void]).query(grains.points)[0] <= 2.0 * run.case.smoothing_length
    temperature = np.asarray(grains["temperature"])
    return float(temperature[near].mean() - temperature[~near].mean())


def _wake(run, time: float) -> float:
    """Height of the underside of the bubble in its middle over that 4 cm beside it [m]."""
    _, _, gas = run.fields(time)
    centres, sizes = gas.cell_centers().points, np.asarray(gas.compute_cell_sizes()["Area"])
    order, shape = bubble.rows_of(centres)
    rows = CellRows(Mesh(centres, sizes, 2), bubble.UP)
    void = bubble.largest_void(centres, rows, np.asarray(gas["alpha_p"]))[order].reshape(shape)
    x, y = (centres[order, a].reshape(void.shape) for a in (0, 1))
    lowest = np.where(void.any(axis=0), np.take_along_axis(y, void.argmax(axis=0)[None], 0)[0], np.nan)
    offset = np.abs(x[0] - run.case.domain.size[0] / 2)
    return float(np.nanmean(lowest[offset < 0.01]) - np.nanmean(lowest[np.abs(offset - 0.04) < 0.01]))
