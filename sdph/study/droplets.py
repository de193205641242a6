"""Any case of droplets in a gas beside reactingParcelFoam: same mesh, boundaries, nozzles, gas, liquid and start.

A scene with a comparison of its own (validation/<scene>/compare.py) takes that. What came in, what evaporated and how
far it got is taken at the end; how warm, fast and fine the droplets are, and what they made of the gas, as means over
the second half of the run. OpenFOAM's evaporated mass is of first order in its step: a second run with twice the step
tells its limit. The bars are ours.
"""

from __future__ import annotations

import itertools
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from coupling.openfoam.comparators import droplet_cloud, droplet_liquid, known
from coupling.openfoam.comparators.droplet_sources import Drops
from coupling.openfoam.comparators.run import run_droplets
from sdph.effects.around.streams import layers_of, streams_of, unit
from sdph.engine.state import GRAIN
from sdph.schema import CaseError
from sdph.study import cuts
from sdph.study.compare import check, times_of_both, too_short

STEP = 0.1  # Courant number of the droplets; with twice of it the limit of the evaporated mass (docs/howto/spray.md)
EVAPORATED, FRONT, SPEED, SIZE, RICHEST = 0.15, 0.05, 0.10, 0.05, 0.20  # relative
CAME_IN = 0.01  # relative, and half a layer of particles
WARMTH, COLDEST = 0.05, 0.10  # of the temperatures between which all happens
AHEAD = 0.95  # of the mass in the air, that has not come further than the front
PICTURE, DOTS = "compare_dpm.png", 2000  # most droplets that are drawn
FIELDS = ("temperature", "vapour_mass_fraction", "density")  # of the gas; OpenFOAM's temperature has another name
OPENFOAM = {"temperature": "gas_temperature"}


class Air(NamedTuple):
    """Droplets in the air at a time, and the gas: places (P, D) [m], masses (P,) [kg], speeds (P,) [m/s], temperatures
    (P,) [K], Sauter mean [m] (nan: none, or not told); fields of the gas, name -> (C,)."""

    place: np.ndarray
    mass: np.ndarray
    speed: np.ndarray
    temperature: np.ndarray
    sauter: float
    gas: dict[str, np.ndarray]


class Way(NamedTuple):
    """A direction (D,) in which droplets fly, from a place (D,) [m]."""

    direction: np.ndarray
    origin: np.ndarray


class Side(NamedTuple):
    """One of the two: liquid that came in [kg] since the start and with it, liquid that evaporated [kg], what is in the
    air at T times, the last of them the end, and volumes of the cells (C,) [m3]."""

    came: float
    evaporated: float
    air: list[Air]
    volumes: np.ndarray


def dpm(run) -> list[dict]:
    """Checks of a run against OpenFOAM's droplets, and `compare_dpm.png`."""
    known.refuse(droplet_cloud.lacks(run.case))
    first = run.fields(0.0)
    if first.gas is None:
        raise CaseError(f"{run.folder} has no gas; OpenFOAM's droplets are compared with droplets in a gas")
    if too_short(run):
        return []
    drops, box = _start(run.case, first.particles), first.gas.GetClassName() == "vtkRectilinearGrid"
    mesh = None if box else run.folder / "gas"
    reference, coarse = (
        run_droplets(run.case, run.folder / name, drops, courant=courant, mesh=mesh)
        for name, courant in (("dpm", STEP), ("dpm_coarse", 2.0 * STEP))
    )
    times = times_of_both(run, reference)
    own, other = _own(run, drops, times, reference), _other(run.case, times, reference, coarse)
    picture(run, times, own, other)
    return checks(run.case, ways(run.case, drops), own, other)


def _start(case, particles) -> Drops:
    """Droplets that are there at the start."""
    if not particles.n_points:
        return Drops(*(np.zeros((0, case.dimensions)),) * 2, *(np.zeros(0),) * 4)
    inside = np.asarray(particles["kind"]) == GRAIN
    place, velocity = (
        np.asarray(values, float)[inside, : case.dimensions] for values in (particles.points, particles["velocity"])
    )
    warmth = _temperature(case, particles)[inside]
    size = np.full(len(place), case.grains.diameter), np.full(len(place), case.grains.diameter_std**2)
    return Drops(place, velocity, warmth, np.asarray(particles["mass"], float)[inside], *size)


def _temperature(case, particles) -> np.ndarray:
    """Temperature [K] of the particles; where the case follows none, that of its gas."""
    if "temperature" not in particles.array_names:
        return np.full(particles.n_points, case.gas.temperature)
    return np.asarray(particles["temperature"], float)


def ways(case, drops: Drops) -> list[Way]:
    """A way for each direction of a nozzle, from the middle of all with that direction; without nozzles that of the
    droplets at the start, or else of gravity, from their middle. None where nothing moves them."""
    if case.nozzles:
        own = [(tuple(np.round(unit(nozzle.direction), 9)), nozzle.centre) for nozzle in case.nozzles.values()]
        groups = itertools.groupby(sorted(own), lambda pair: pair[0])
        return [Way(np.array(way), np.mean([place for _, place in pairs], axis=0)) for way, pairs in groups]
    mean = np.average(drops.velocity, weights=drops.mass, axis=0)
    along = mean if np.linalg.norm(mean) > 0.0 else np.array(case.domain.gravity)
    return [Way(unit(along), np.average(drops.place, weights=drops.mass, axis=0))] if any(along) else []


def checks(case, along: list[Way], own: Side, other: Side) -> list[dict]:
    """Checks of both sides."""
    within = CAME_IN * other.came + half_layer(case)
    found = [check("liquid that came in, or was there [kg]", own.came, other.came, within)]
    if "evaporation" in case.effects:
        fit = droplet_liquid.fitted(case)
        name = f"largest error of OpenFOAM's pressure of saturation, {fit.low:.0f} to {fit.high:.0f} K"
        found.append(check(name, fit.error, 0.0, droplet_liquid.LARGEST))
        found.append(check("evaporated mass [kg]", own.evaporated, other.evaporated, EVAPORATED, True))
    for way in along:
        name = f"front of {AHEAD:.0%} of the droplets, along ({', '.join(f'{a:.3g}' for a in way.direction)}) [m]"
        found.append(check(name, *(front(side.air[-1], way) for side in (own, other)), FRONT, True))
    found += _of_droplets(case, own, other) + _of_gas(case, own, other)
    return [row for row in found if not np.isnan([row["value"], row["reference"]]).all()]  # neither has any


def half_layer(case) -> float:
    """Mass [kg] of half a layer of particles of every nozzle: what came in is the rate times time to within that."""
    streams = [(nozzle, streams_of(case, nozzle)) for nozzle in case.nozzles.values()]
    return 0.5 * sum(float(own.mass * np.sum(layers_of(nozzle, own) > 0)) for nozzle, own in streams)


def front(air: Air, way: Way) -> float:
    """Place [m] along a way that AHEAD of the mass has not passed, particles as points; nan without any."""
    if not len(air.mass):
        return np.nan
    along = (air.place - way.origin) @ way.direction
    order = np.argsort(along)
    mass = air.mass[order]
    return float(np.interp(AHEAD, (np.cumsum(mass) - 0.5 * mass) / mass.sum(), along[order]))


def _of_droplets(case, own: Side, other: Side) -> list[dict]:
    """Means by mass of the droplets in the air."""
    found = []
    if "heat" in case.effects:
        values = [_mean(side, lambda air: np.average(air.temperature, weights=air.mass)) for side in (own, other)]
        found.append(check("droplets in the air, mean [K]", *values, WARMTH * _between(case, values)))
    values = [_mean(side, lambda air: np.average(air.speed, weights=air.mass)) for side in (own, other)]
    found.append(check("speed of the droplets in the air, mean [m/s]", *values, SPEED, True))
    if droplet_cloud.sized(case):
        values = [_mean(side, lambda air: air.sauter) for side in (own, other)]
        found.append(check("D32 of the droplets in the air [m]", *values, SIZE, True))
    return found


def _mean(side: Side, what) -> float:
    """Mean over the times at which droplets are in the air; nan without."""
    values = [what(air) for air in side.air if len(air.mass)]
    return float(np.mean(values)) if values else np.nan


def _between(case, values) -> float:
    """Kelvin between the highest and the lowest temperature, of what the case gives and of what came out."""
    return max(*case.temperatures, *values) - min(*case.temperatures, *values)


def _of_gas(case, own: Side, other: Side) -> list[dict]:
    """Gas where the vapour is, and the extremes of single cells."""
    found = []
    if "heat" in case.effects:
        values = [np.mean([air.gas["temperature"].min() for air in side.air]) for side in (own, other)]
        found.append(check("coldest cell of the gas [K]", *values, COLDEST * _between(case, values)))
    if "evaporation" not in case.effects:
        return found
    values = [np.mean([air.gas["vapour_mass_fraction"].max() for air in side.air]) for side in (own, other)]
    found.append(check("largest mass fraction of vapour in a cell", *values, RICHEST, True))
    if "heat" in case.effects:
        values = [_among_vapour(side) for side in (own, other)]
        name = "temperature of the gas where the vapour is, mean by its mass [K]"
        found.append(check(name, *values, WARMTH * _between(case, values)))
    return found


def _among_vapour(side: Side) -> float:
    """Mean temperature [K] of the gas by the mass of its vapour; nan without any."""
    found = []
    for air in side.air:
        vapour = air.gas["vapour_mass_fraction"] * air.gas["density"] * side.volumes
        found += [np.average(air.gas["temperature"], weights=vapour)] if vapour.sum() > 0.0 else []
    return float(np.mean(found)) if found else np.nan


def _late(times: list[float]) -> list[float]:
    return [t for t in times if t >= 0.5 * times[-1]]


def _own(run, drops: Drops, times: list[float], reference) -> Side:
    """The run, its gas on the cells of the reference."""
    ledger, metrics, end, dimensions = run.ledger, run.metrics, times[-1], run.case.dimensions
    rows = ledger["time_s"] <= end * (1.0 + 1e-9)
    came = drops.mass.sum() + ledger["injected_kg"][rows].sum()
    air = []
    for t in _late(times):
        _, particles, gas = run.fields(t)
        same = cKDTree(np.asarray(gas.cell_centers().points)[:, :dimensions]).query(reference.centres[:, :dimensions])[
            1
        ]
        cells = {name: np.asarray(gas[name])[same] for name in FIELDS if name in gas.array_names}
        sauter = metrics["D32_m"][np.argmin(np.abs(metrics["time_s"] - t))] if "D32_m" in metrics else None
        air.append(_particles(run.case, particles, sauter, cells))
    return Side(float(came), float(ledger["evaporated_kg"][rows].sum()), air, reference.volumes)


def _particles(case, particles, sauter: float | None, cells: dict) -> Air:
    """The run's droplets at a time; where no `sauter` [m] was told all of a particle are alike."""
    if not particles.n_points:
        return Air(np.zeros((0, case.dimensions)), *(np.zeros(0),) * 3, np.nan, cells)
    place, speed = np.asarray(particles.points)[:, : case.dimensions], np.linalg.norm(particles["velocity"], axis=1)
    mass = np.asarray(particles["mass"])
    if sauter is None and "diameter" in particles.array_names:
        sauter = mass.sum() / (mass / particles["diameter"]).sum()
    return Air(place, mass, speed, _temperature(case, particles), np.nan if sauter is None else float(sauter), cells)


def _other(case, times: list[float], reference, coarse) -> Side:
    """OpenFOAM's, the evaporated mass in the limit of its step."""
    end = times[-1]
    evaporated = [np.interp(end, of.history["time_s"], of.history["evaporated_kg"]) for of in (reference, coarse)]
    air = []
    for t in _late(times):
        fields = reference.fields[t]
        cells = {name: fields[key] for name in FIELDS if (key := OPENFOAM.get(name, name)) in fields}
        air.append(_parcels(case, reference.parcels.get(t), cells))
    came = float(np.interp(end, reference.history["time_s"], reference.history["injected_kg"]))
    return Side(came, 2.0 * evaporated[0] - evaporated[1], air, reference.volumes)


def _parcels(case, drops: dict | None, cells: dict) -> Air:
    """OpenFOAM's droplets at a time."""
    if drops is None or not len(drops["diameter"]):
        return Air(np.zeros((0, case.dimensions)), *(np.zeros(0),) * 3, np.nan, cells)
    mass = drops["count"] * drops["density"] * np.pi / 6.0 * drops["diameter"] ** 3
    sauter = float(mass.sum() / (mass / drops["diameter"]).sum())
    speed = np.linalg.norm(drops["velocity"], axis=1)
    return Air(drops["position"][:, : case.dimensions], mass, speed, drops["temperature"], sauter, cells)


def picture(run, times: list[float], own: Side, other: Side) -> None:
    """Vapour, or where nothing evaporates temperature of the gas in a cut, and the droplets: both sides at the end."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    grid = run.fields(times[-1]).gas
    pieces, middles = cuts.cut(run.case, grid)
    numbers = cKDTree(np.asarray(grid.cell_centers().points)[:, : run.case.dimensions]).query(middles)[1]
    seen = cuts.axes(run.case)
    field = "vapour_mass_fraction" if "evaporation" in run.case.effects else "temperature"
    values = [side.air[-1].gas[field] for side in (own, other)]
    limits = min(v.min() for v in values), max(v.max() for v in values)
    width, height = np.ptp(np.concatenate(pieces), axis=0)
    size = (9.0, max(2.0, min(9.0, 3.8 * height / width)) + 0.8)
    figure, axes = pyplot.subplots(1, 2, figsize=size, layout="constrained")
    for axis, side, shown, name in zip(axes, (own, other), values, ("SDPH", "OpenFOAM's droplets")):
        image = cuts.painted(axis, pieces, shown[numbers], limits, field)
        place = side.air[-1].place[:, seen]
        some = np.random.default_rng(0).permutation(len(place))[:DOTS]  # any, or rows of parcels would be left out
        axis.plot(*place[some].T, ".", color="tab:cyan", markersize=1.5)
        axis.set_title(f"{name}, {times[-1]:.3g} s")
    figure.colorbar(image, ax=axes, label=field.replace("_", " "))
    figure.savefig(run.folder / PICTURE, dpi=120)
    pyplot.close(figure)
