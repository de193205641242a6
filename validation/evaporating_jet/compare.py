"""The evaporating jet against OpenFOAM's droplet solver (reactingParcelFoam), and against what the physics bounds.

Figures 12 to 16 of Chen, Qiang & Gao 2014 side by side: figure_12.png ... in the run folder. What the two models treat
differently stands in README.md; `shares.py` beside this file measures the share of each difference.
"""

from __future__ import annotations

import dataclasses
import math

import numpy as np

from coupling.openfoam.comparators.droplet_numbers import COURANT
from sdph.running.balances import work_of_gas
from sdph.study.compare import check

MASS = 0.15  # of the evaporated mass in the limit of the droplet solver's step (issues 4 and 19)
HEAT = 0.1  # of what the droplets took up, with the closures made alike
FRONT = 0.05  # of the front's place
TIMES = (0.05, 0.1, 0.15, 0.2)  # s
COMPARED_CELLS = (0.2, 0.1, 0.05)  # m, of the droplet runs that `sdph cost` draws
DROP = {"drag": "putnam", "heat": "ranz_marshall"}  # closures of the droplet solver, as validation/spray_plug shows
POINTS = ("coupling.voidage=false", "coupling.film=true", "evaporation.onset='paper'")
SAME = (*(f"{effect}.law='{law}'" for effect, law in DROP.items()), *POINTS)
HOT = ("nozzles.jet.temperature_K=300.0", "run.end_time_s=0.1")  # droplets above the onset from the nozzle on
VARIANTS = {
    "evaporating_jet": ((), ("dpm",)),  # whose checks end with those of `exact`
    "closures alike": (SAME, ("dpm",)),
    "hot": ((*SAME, *HOT), ("dpm",)),
}
FIGURES = {  # number -> (what, unit, times [s])
    12: ("temperature", "droplets [K]", (0.1, 0.2)),
    13: ("gas_temperature", "gas [K]", (0.1, 0.2)),
    14: ("gas_velocity", "speed of the gas [m/s]", (0.1, 0.2)),
    15: ("vapour_mass_fraction", "vapour mass fraction", (0.1, 0.15, 0.2)),
    16: ("contours", "vapour mass fraction", (0.15,)),
}
OURS = {"gas_temperature": "temperature", "gas_velocity": "velocity", "vapour_mass_fraction": "vapour_mass_fraction"}


def dpm(run) -> list[dict]:
    """Evaporated mass, front and droplets' temperatures against the droplets, and the bounds of sdph-notes 4.3."""
    times = run.outputs(TIMES)
    reference, coarse = droplets(run, run.folder)
    same, end = alike(run.case), max(times)
    name = "evaporated mass [kg]" if same else "evaporated mass [kg], closures differ,"
    checks = [
        check(f"{name} at {end:g} s", evaporated(run, end), limit_by(reference, coarse, run.case, end), MASS, True)
    ]
    for t in times:
        if same:
            checks.append(
                check(f"heat in the droplets [J] at {t:g} s", heat(run, t), heat_of(reference, run.case, t), HEAT, True)
            )
        front = reference.parcels[nearest(reference, t)]["position"][:, 0].max()
        checks.append(check(f"front [m] at {t:g} s", run.metric("front_m", t), front, FRONT, True))
    checks += bounds(run, times)
    for number, figure in FIGURES.items():
        _figure(run, reference, number, *figure)
    return checks


def others(case, folder):
    """Others in `sdph cost`: (label, solver, wall time [s], metrics) of the droplet solver on finer and finer cells,
    and with them steps."""
    for number, cell in enumerate(COMPARED_CELLS):
        refined = dataclasses.replace(case, resolution=dataclasses.replace(case.resolution, cell=cell))
        reference, end = _droplet_run(refined, folder / f"dpm_{number}"), case.run.end_time
        front = float(reference.parcels[nearest(reference, end)]["position"][:, 0].max())
        values = {
            "evaporated_kg": evaporated_by(reference, case, end),
            "front_m": front,
            "heat_exchanged_J": heat_of(reference, case, end),
        }
        label = f"all {number + 1}/{len(COMPARED_CELLS)}, {1e3 * cell:g} mm"
        yield label, reference.solver, reference.wall, {name: (value, None, None) for name, value in values.items()}


def exact(run) -> list[dict]:
    """The bounds alone: no reference has to run for them."""
    return bounds(run, run.outputs(TIMES))


def alike(case) -> bool:
    """True where the case has the closures of the droplet solver."""
    laws = all(case.parameters[name].law == law for name, law in DROP.items())
    onset = case.parameters["evaporation"].onset == "paper"
    return laws and onset and case.coupling.film and not case.coupling.voidage


def bounds(run, times) -> list[dict]:
    """sdph-notes 4.3: free flight and fall, onset, saturation, mass; that there is fall and evaporation at all."""
    nozzle, own, gravity = (
        run.case.nozzles["jet"],
        run.case.parameters["evaporation"],
        math.hypot(*run.case.domain.gravity),
    )
    checks = []
    for t in times:
        checks.append(at_most(f"front [m] at {t:g} s", run.metric("front_m", t), nozzle.speed * t))
        checks.append(at_most(f"sag [m] at {t:g} s", run.metric("sag_m", t), 0.5 * gravity * t * t))
        if nozzle.temperature < own.onset_temperature:
            core = run.metric("core_temperature_K", t)
            checks.append(at_most(f"core [K] at {t:g} s", core, own.onset_temperature))
        checks.append(
            at_most(
                f"largest vapour mass fraction at {t:g} s",
                run.metric("vapour_mass_fraction_max", t),
                saturated(run.case),
            )
        )
    share, what = run.summary["evaporated_kg"] / run.summary["injected_kg"], "share of the liquid that evaporated"
    checks += [some(f"sag [m] at {t:g} s", run.metric("sag_m", t)) for t in times[-1:]]
    return [*checks, at_most(what, share, 0.0025), some(what, share), *work_of_gas(run.summary)]


def saturated(case) -> float:
    """Mass fraction of vapour of a gas of the case's density that is saturated by the linear law."""
    own, nozzle = case.parameters["evaporation"], case.nozzles["jet"]
    return own.saturation_pressure * case.vapour.molar_mass / (8314.46 * nozzle.temperature) / case.gas.density


def at_most(name: str, value: float, bound: float) -> dict:
    """A check that only counts above the bound."""
    return check(f"{name}, at most {bound:.4g}", max(value, bound), bound, 0.0) | {"value": float(value)}


def some(name: str, value: float) -> dict:
    """A check that a value is above 0."""
    return check(f"{name}, more than none", value, 0.0, 0.0) | {"ok": bool(value > 0.0)}


def evaporated(run, time: float) -> float:
    """Mass [kg] evaporated by `time` [s]."""
    ledger = run.ledger
    return float(ledger["evaporated_kg"][ledger["time_s"] <= time * (1.0 + 1e-9)].sum())


def evaporated_by(reference, case, time: float) -> float:
    """The same of the droplet solver: vapour in its gas (none has left yet)."""
    fields = reference.fields[reference.nearest(time)]
    return float((fields["vapour_mass_fraction"] * case.gas.density * reference.volumes).sum())


def heat(run, time: float) -> float:
    """Heat [J] that the droplets have above the nozzle's temperature."""
    _, particles, _ = run.fields(time)
    warmth = np.asarray(particles["temperature"]) - run.case.nozzles["jet"].temperature
    return float((np.asarray(particles["mass"]) * warmth).sum() * run.case.grains.heat_capacity)


def heat_of(reference, case, time: float) -> float:
    """The same of the droplet solver."""
    drops = reference.parcels[nearest(reference, time)]
    mass = drops["count"] * drops["density"] * math.pi / 6.0 * drops["diameter"] ** 3
    return float((mass * (drops["temperature"] - case.nozzles["jet"].temperature)).sum() * case.grains.heat_capacity)


def droplets(run, folder):
    """The droplet solver on a run's case, with its step and with twice of it."""
    return [_droplet_run(run.case, folder / f"dpm_{k}", k * COURANT) for k in (1, 2)]


def limit_by(reference, coarse, case, time: float) -> float:
    """Mass evaporated by the droplet solver in the limit of its step, which it is first order in (README.md), from runs
    with one step and twice of it."""
    return 2.0 * evaporated_by(reference, case, time) - evaporated_by(coarse, case, time)


def nearest(reference, time: float) -> float:
    return min(reference.parcels, key=lambda t: abs(t - time))


def _droplet_run(case, folder, courant: float = COURANT):
    from coupling.openfoam.comparators.run import run_droplets

    return run_droplets(case, folder, courant=courant)


def _figure(run, reference, number: int, what: str, label: str, times) -> None:
    """One figure of the paper: SDPH above, droplets below, a column a time."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    times = [t for t in times if t <= run.summary["time_s"] * (1.0 + 1e-9)]
    if not times:
        return
    figure, axes = pyplot.subplots(
        2, len(times), figsize=(6.0 * len(times), 7.0), squeeze=False, constrained_layout=True, sharex=True, sharey=True
    )
    panels = [[_sdph(run, what, t), _droplets(run, reference, what, t)] for t in times]
    both = np.concatenate([np.asarray(values).ravel() for pair in panels for _, values in pair])
    limits = {"vmin": float(both.min()), "vmax": float(both.max())}
    for column, (t, pair) in enumerate(zip(times, panels)):
        for row, (name, (places, values)) in enumerate(zip(("SDPH", "droplets (reactingParcelFoam)"), pair)):
            drawn = _draw(axes[row, column], what, places, values, limits)
            axes[row, column].set(title=f"{name}, t = {t:g} s", aspect="equal", xlim=(0.0, 3.2), ylim=(0.6, 3.4))
    for panel in axes[-1]:
        panel.set_xlabel("x [m]")
    for panel in axes[:, 0]:
        panel.set_ylabel("y [m]")
    figure.colorbar(drawn, ax=axes, label=label, shrink=0.8)
    figure.savefig(run.folder / f"figure_{number}.png", dpi=100)
    pyplot.close(figure)


def _draw(axes, what: str, places, values, limits):
    if what == "temperature":
        return axes.scatter(*places.T, c=values, s=2.0, cmap="inferno", **limits)
    if what == "contours":
        levels = np.linspace(0.1, 1.0, 8) * limits["vmax"]
        return axes.contour(*places, values, levels=levels, cmap="viridis")
    return axes.pcolormesh(
        *places, values, cmap="viridis" if what == "vapour_mass_fraction" else "inferno", shading="nearest", **limits
    )


def _sdph(run, what: str, time: float):
    _, particles, gas = run.fields(time)
    if what == "temperature":
        return np.asarray(particles.points)[:, :2], np.asarray(particles["temperature"])
    centres = np.asarray(gas.cell_centers().points)
    return _table(centres, np.asarray(gas.cell_data[OURS.get(what, "vapour_mass_fraction")]))


def _droplets(run, reference, what: str, time: float):
    if what == "temperature":
        drops = reference.parcels[nearest(reference, time)]
        return drops["position"][:, :2], drops["temperature"]
    fields = reference.fields[reference.nearest(time)]
    return _table(reference.centres, fields["vapour_mass_fraction" if what == "contours" else what])


def _table(centres, values):
    """((x, y), values) on the tensor grid of cell centres; vectors by their length."""
    values = np.linalg.norm(values, axis=1) if values.ndim == 2 else values
    x, y = (np.unique(np.round(centres[:, a], 9)) for a in (0, 1))
    table = np.empty((len(y), len(x)))
    table[np.searchsorted(y, np.round(centres[:, 1], 9)), np.searchsorted(x, np.round(centres[:, 0], 9))] = values
    return (x, y), table
