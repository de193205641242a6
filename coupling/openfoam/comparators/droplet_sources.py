"""Sources of reactingParcelFoam's parcels: tables of injectors, one for all rows of the same mass.

Each place of a nozzle's mouth that gives particles gives parcels, one a step, with the velocity that particles leave it
with: so slots, discs and cones are the same to OpenFOAM. Droplets that are there at the start come in before anything
else moves. OpenFOAM gives every parcel of a table the same mass, so that rows of another mass are another table. A
distribution of sizes is cut into parts of equal mass, each parcel with the Sauter mean of its part: mass and surface of
the drops are those of the distribution.
"""

from __future__ import annotations

import itertools
import math
from typing import NamedTuple

import numpy as np

from sdph.case.sections import Case
from sdph.effects.around import sizes
from sdph.effects.around.streams import streams_of, unit
from sdph.laws import size_classes
from sdph.schema import CaseError

PARTS = 5  # of equal mass that a distribution of sizes is cut into; our choice
INSIDE = 1e-6  # m, from the mouth along its axis: the wall that it is in is not in the gas
AT_ONCE = 1e-3  # of a step, in which all that is there at the start comes in
SURE = 1e-9  # relative: OpenFOAM rounds the number of parcels down, and compares times
DIGITS = 9  # in which two masses are the same


class Drops(NamedTuple):
    """Droplets at the start, N particles of them: place (N, d) [m], velocity (N, d) [m/s], temperature (N,) [K],
    mass (N,) [kg, in two dimensions by the metre], number mean [m] and variance [m2] of the diameters (N,)."""

    place: np.ndarray
    velocity: np.ndarray
    temperature: np.ndarray
    mass: np.ndarray
    diameter: np.ndarray
    variance: np.ndarray


class Parcels(NamedTuple):
    """R parcels of a step: place (R, d) [m], velocity (R, d) [m/s], temperature (R,) [K], diameter (R,) [m], flow
    (R,) [kg/s] or, of droplets at the start, mass [kg]."""

    place: np.ndarray
    velocity: np.ndarray
    temperature: np.ndarray
    diameter: np.ndarray
    mass: np.ndarray


class Injector(NamedTuple):
    """A table of OpenFOAM's: name, rows, start and duration [s], mass of all that it gives [kg]."""

    name: str
    rows: Parcels
    start: float
    duration: float
    mass: float


def none(dimensions: int) -> Drops:
    """No droplets at the start."""
    nothing = np.zeros((0, dimensions))
    return Drops(nothing, nothing, *(np.zeros(0),) * 4)


def velocities(case: Case, drops: Drops) -> list[float]:
    """Largest speed [m/s] that each nozzle gives, and that droplets have at the start."""
    found = [np.linalg.norm(streams_of(case, nozzle).velocity, axis=1).max() for nozzle in case.nozzles.values()]
    return [float(speed) for speed in (*found, np.linalg.norm(drops.velocity, axis=1).max(initial=0.0))]


def injectors(case: Case, drops: Drops, step: float) -> list[Injector]:
    """All tables of a case whose steps are `step` [s]; `CaseError` where a mouth is outside of the gas."""
    found = []
    if len(drops.mass):
        started, taken = _divided(drops), AT_ONCE * step
        found += [
            Injector(f"start{k}", rows, 0.0, taken, AT_ONCE * float(rows.mass.sum()))
            for k, rows in enumerate(_alike(started))
        ]
    for number, (name, nozzle) in enumerate(case.nozzles.items(), 1):
        rows = _of_nozzle(case, name, nozzle)
        found += _open(f"nozzle{number}", nozzle, _alike(rows), step, case.run.end_time)
    return found


def _open(name: str, nozzle, alike: list[Parcels], step: float, last: float) -> list[Injector]:
    """Tables of a nozzle as long as it is open, in whole steps, until `last` [s]: the mass is that of its own times."""
    end = last if nozzle.end is None else min(nozzle.end, last)
    opened = end - nozzle.start
    first, steps = round(nozzle.start / step), max(1, round(end / step) - round(nozzle.start / step))
    times = max(0.0, (first - SURE) * step), (steps - SURE) * step
    return [
        Injector(f"{name}_{k}", rows, *times, opened * float(rows.mass.sum()))
        for k, rows in enumerate(alike if opened > 0.0 else ())
    ]


def _of_nozzle(case: Case, name: str, nozzle) -> Parcels:
    """Parcels of a step from a nozzle: every place of its mouth, every size."""
    streams, own = streams_of(case, nozzle), sizes.of_nozzle(case, nozzle)
    place = _within(case, name, streams.mouth + INSIDE * unit(nozzle.direction))
    parts = max(1, math.ceil(PARTS / len(own.share)))
    kinds = [(s / parts if v else s, d, v) for s, d, v in zip(*own)]
    kinds = [(s, part) for s, d, v in kinds for part in _parts(d, v, parts)]
    share, diameter = np.array(kinds).T
    flow = streams.mass * streams.speed / streams.pitch
    at, which = (index.ravel() for index in np.meshgrid(np.arange(len(flow)), np.arange(len(share)), indexing="ij"))
    temperature = np.full(len(at), nozzle.temperature)
    return Parcels(place[at], streams.velocity[at], temperature, diameter[which], flow[at] * share[which])


def _within(case: Case, name: str, place) -> np.ndarray:
    """The places (R, d) [m] of a mouth; `CaseError` where one is outside of the box of the gas."""
    if ((place < np.array(case.domain.corner)) | (place > np.array(case.domain.upper))).any():
        raise CaseError(
            f"nozzles.{name}: a part of its mouth is outside of the gas, where the droplet reference has no cells; "
            "move it in, or make it smaller"
        )
    return place


def _divided(drops: Drops) -> Parcels:
    """Parcels of the droplets at the start, every size."""
    kinds = {pair: _parts(*pair, PARTS) for pair in set(zip(drops.diameter.tolist(), drops.variance.tolist()))}
    own = [kinds[pair] for pair in zip(drops.diameter.tolist(), drops.variance.tolist())]
    number = np.array([len(parts) for parts in own])
    at = np.repeat(np.arange(len(number)), number)
    diameter = np.array(list(itertools.chain.from_iterable(own)))
    return Parcels(drops.place[at], drops.velocity[at], drops.temperature[at], diameter, (drops.mass / number)[at])


def _parts(diameter: float, variance: float, parts: int) -> list[float]:
    """Sauter means [m] of `parts` of equal mass of a log-normal; one of equal drops."""
    if not variance:
        return [diameter]
    return [m * (1.0 + v / m**2) ** 2 for m, v in size_classes.log_normal(diameter, math.sqrt(variance), parts)]


def _alike(rows: Parcels) -> list[Parcels]:
    """The rows, by their mass: those of the same together."""
    same = np.array([f"{mass:.{DIGITS}e}" for mass in rows.mass])
    return [Parcels(*(column[same == mass] for column in rows)) for mass in dict.fromkeys(same.tolist())]


def table(case: Case, injector: Injector, middle: float, depth: float) -> str:
    """OpenFOAM's table of an injector; in two dimensions at `middle` [m] of a mesh of `depth` [m]."""
    grains, rows = case.grains, injector.rows
    flow = depth * injector.mass / injector.duration / len(rows.mass)
    beyond = [middle] if case.dimensions == 2 else []
    lines = [
        f"({_words([*place, *beyond])}) ({_words([*velocity, *[0.0] * len(beyond)])}) {d!r} {grains.density!r} "
        f"{flow!r} {warmth!r} {grains.heat_capacity!r} (0 1 0) () (1) ()\n"
        for place, velocity, warmth, d in zip(*(column.tolist() for column in rows[:4]))
    ]
    return f"(\n{''.join(lines)})\n"


def _words(values) -> str:
    return " ".join(map(repr, values))


def entry(injector: Injector, step: float, depth: float) -> str:
    """Entry of an injector among OpenFOAM's injectionModels."""
    return (
        f"    {injector.name}\n    {{\n        type reactingMultiphaseLookupTableInjection;\n"
        f"        inputFile \"{injector.name}\";\n        massTotal {depth * injector.mass!r};\n"
        f"        parcelBasisType mass;\n        minParticlesPerParcel 0;\n"
        f"        SOI {injector.start!r};\n        duration {injector.duration!r};\n"
        f"        parcelsPerSecond {(1.0 + SURE) / step!r};\n        randomise false;\n    }}\n"
    )  # fmt: skip
