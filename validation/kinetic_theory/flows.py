"""Couette and Poiseuille flow of agitated grains between walls, against the closures' own profiles (profiles.py).

Couette: walls slide apart, half of the collisions with them diffuse, so that grains slip and are hottest there.
Poiseuille: gravity pulls along rough walls; grains are cold and dense in the middle. The gap is 15 diameters of 4 mm:
conduction evens theta out over 1.8 to 2 diameters, which is 3 and 6 spacings.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from sdph.laws import granular
from sdph.study.compare import check

from . import boxes, profiles

HEIGHT, LENGTH, DIAMETER, ALPHA_P = 0.06, 0.03, 4e-3, 0.45  # m, m, m, -
FLOWS = {
    "Couette": profiles.Flow(HEIGHT, ALPHA_P, DIAMETER, wall=0.6, specularity=0.5),  # 20/s, as the shear cell
    "Poiseuille": profiles.Flow(HEIGHT, ALPHA_P, DIAMETER, gravity=1.0),
}
SETTLED, MEASURED, SAMPLES = 8.0, 4.0, 50  # relaxation times of the slowest shear; our choice
ACROSS = np.linspace(0.0, HEIGHT, 241)  # m, where the closures' profile is taken
BINS = 12  # across the gap: two spacings of the coarser each
QUANTITIES = {"u": "m/s", "theta": "m2/s2", "alpha_p": "-"}
BAR = 0.05  # issue 18; of the largest value across the gap


def checks(folder: Path, *_, spacings=boxes.SPACINGS, flows=tuple(FLOWS)) -> list[dict]:
    found = {(name, dx): measured(FLOWS[name], dx) for name in flows for dx in spacings}
    _figure(folder / "flows.png", found)
    return [row for (name, dx), own in found.items() for row in against(f"{name}, {1e3 * dx:g} mm", *own)]


def against(name: str, law: dict, ours: dict, contacts: int) -> list[dict]:
    """Checks of one flow, as `measured` has it."""
    rows = []
    for what, unit in QUANTITIES.items():
        error = math.sqrt(np.mean((ours[what] - law[what]) ** 2)) / np.abs(law[what]).max()
        rows.append(check(f"{name}: {what} [{unit}], rms off over its largest", error, 0.0, BAR))
    for what in ("pressure", "stress"):
        rows.append(check(f"{name}: {what} on the walls over the closures' [-]", ours[what] / law[what], 1.0, BAR))
    rows.append(check(f"{name}: contacts with walls that the stress leaves out", contacts, 0.0, 0.0))
    return rows


def measured(flow, spacing: float) -> tuple[dict, dict, int]:
    """Means by bin over MEASURED and on the walls: of the closures at the same places, of the grains; contacts."""
    law = profiles.solved(flow, ACROSS)
    run, end = started(flow, spacing, float(law.theta.mean())), relaxation(float(law.theta.mean()))
    for _ in range(SAMPLES):
        run.window(SETTLED * end / SAMPLES)
    run.forget()
    before, samples = run.grains.stepper.contacts, []
    for _ in range(SAMPLES):
        run.window(MEASURED * end / SAMPLES)
        samples.append(binned(run, law))
    ours, theirs = np.nanmean(samples, axis=0)
    push = run.push / (LENGTH * MEASURED * end)
    along = 0.5 * (push[1, 1] - push[0, 1]) if flow.wall else -0.5 * push[:, 1].sum()
    return (
        dict(zip(QUANTITIES, theirs)) | {"pressure": law.pressure, "stress": law.stress},
        dict(zip(QUANTITIES, ours)) | {"pressure": push[:, 0].mean(), "stress": along},
        run.grains.stepper.contacts - before,
    )


def relaxation(theta: float) -> float:
    """Time [s] in which shear across the gap evens out: H^2/(pi^2 nu)."""
    own = (ALPHA_P, theta, boxes.RESTITUTION, boxes.g0(ALPHA_P), boxes.DENSITY)
    return HEIGHT**2 * ALPHA_P * boxes.DENSITY / (math.pi**2 * granular.gidaspow_viscosity(*own, DIAMETER))


def started(flow, spacing: float, theta: float):
    """Grains of even alpha_p and theta [m2/s2]: sheared evenly, or at rest."""
    walls = {side: {"kind": "wall", "side": side, "velocity_m_s": [way * flow.wall, 0.0]}
             for side, way in (("bottom", -1.0), ("top", 1.0))}  # fmt: skip
    own = {"grains": {"diameter_mm": 1e3 * DIAMETER}, "domain": {"gravity_m_s2": [flow.gravity, 0.0]}}
    own |= {"walls": {"specularity": flow.specularity}} if flow.wall else {}
    run = boxes.Alone(boxes.case((LENGTH, HEIGHT), ALPHA_P, spacing, theta, boundaries=walls, **own))
    run.begin_with(u=flow.wall * (2.0 * run.state.y / HEIGHT - 1.0))
    return run


def binned(run, law) -> np.ndarray:
    """Means of u, theta and alpha_p by bin (2, 3, BINS): of grains, and of the closures where the grains are; nan where
    there are none."""
    s = run.state
    at = np.minimum((s.y / HEIGHT * BINS).astype(int), BINS - 1)
    count = np.bincount(at, minlength=BINS)
    ours = (s.u, s.theta, boxes.alpha_p(s))
    theirs = tuple(np.interp(s.y, ACROSS, values) for values in (law.u, law.theta, law.share))
    with np.errstate(invalid="ignore"):
        return np.array([[np.bincount(at, each, BINS) / count for each in side] for side in (ours, theirs)])


def _figure(file: Path, found: dict) -> None:
    """Profiles across the gap: lines of the closures, marks of the grains."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    names, y = list(dict.fromkeys(name for name, _ in found)), (np.arange(BINS) + 0.5) * 1e3 * HEIGHT / BINS
    figure, panels = pyplot.subplots(len(names), 3, figsize=(9, 3 * len(names)), constrained_layout=True, squeeze=False)
    for (name, dx), (law, ours, _) in found.items():
        for axes, (what, unit) in zip(panels[names.index(name)], QUANTITIES.items()):
            axes.plot(law[what], y, "k-", lw=1)
            axes.plot(ours[what], y, "o" if dx == boxes.SPACINGS[0] else "x", mfc="none", label=f"{1e3 * dx:g} mm")
            axes.set(xlabel=f"{what} [{unit}]", ylabel="y [mm]", title=name)
            axes.legend(fontsize=7)
    figure.savefig(file, dpi=90)
    pyplot.close(figure)
