"""Drops of a table that come in through a nozzle: some of them become one particle of droplets (swirl-sheet.md, 9).

The table has a row for each drop that crossed a plane: time, place and velocity with z along the nozzle's axis from the
middle of its mouth, x along `across`; mass and diameter. It is played again and again, each time turned about the axis
by an angle of its own, and scaled to the mean flow `rate_kg_s`.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import NamedTuple

import numpy as np

from sdph.effects.around.streams import chance, frame_of
from sdph.engine import state as particles
from sdph.engine import table
from sdph.engine.state import GRAIN
from sdph.laws import grain_sizes
from sdph.schema import CaseError

PLACE, VELOCITY = tuple(f"{a}_m" for a in "xyz"), tuple(f"velocity_{a}_m_s" for a in "xyz")
COLUMNS = ("time_s", *PLACE, *VELOCITY, "mass_kg", "diameter_m")
ROUND = 0.01  # of the mass: by so much it may differ from that of spheres of the grains' density; our choice


class Drops(NamedTuple):
    """N drops in the order of their times [s]: place (N, 3) [m], velocity (N, 3) [m/s], mass [kg], diameter [m]."""

    time: np.ndarray
    place: np.ndarray
    velocity: np.ndarray
    mass: np.ndarray
    diameter: np.ndarray


class Parcels(NamedTuple):
    """M particles in the order of their times [s]: place and velocity of their middle (M, 3), mass [kg], theta [m2/s2]
    of the drops' motion within, number mean [m] and variance [m2] of their diameters."""

    time: np.ndarray
    place: np.ndarray
    velocity: np.ndarray
    mass: np.ndarray
    theta: np.ndarray
    diameter: np.ndarray
    variance: np.ndarray


def _numbers(path: str) -> dict[str, np.ndarray]:
    """Columns of a table of drops; ValueError where it has no rows or drops of no size."""
    lines, found = table.numbers(Path(path), COLUMNS)
    if not lines:
        raise ValueError("it has no rows")
    for name in ("mass_kg", "diameter_m"):
        wrong = np.flatnonzero(found[name] <= 0.0)
        if len(wrong):
            raise ValueError(f"line {lines[wrong[0]]}: {name} = {found[name][wrong[0]]:g}; it must be above 0")
    return found


def read(path: str) -> Drops:
    """The drops of a table; `CaseError` where it is none."""
    try:
        found = _numbers(path)
    except ValueError as error:
        needed = f"give a CSV file with the columns {', '.join(COLUMNS)}"
        raise CaseError(f"a nozzle's table = {path!r}: {error}; {needed}") from None
    order = np.argsort(found["time_s"], kind="stable")
    place, velocity = (np.stack([found[name][order] for name in names], axis=1) for names in (PLACE, VELOCITY))
    return Drops(found["time_s"][order], place, velocity, found["mass_kg"][order], found["diameter_m"][order])


def gathered(drops: Drops, interval: float, spacing: float, seed=0) -> Parcels:
    """One particle for the drops of each `interval` [s] and each square of `spacing` [m] across the axis.

    The squares of each interval are turned by an angle of their own, drawn by a seed, a number or several, or the
    particles would fly in strings.

    Mass, momentum, energy (with theta), number, surface and volume of the drops are those of the particles.
    """
    when = np.floor((drops.time - drops.time[0]) / interval).astype(np.int64)
    angle = np.random.default_rng(seed).uniform(0.0, 2.0 * math.pi, when[-1] + 1)[when]
    x, y = drops.place[:, 0], drops.place[:, 1]
    across = x * np.cos(angle) - y * np.sin(angle), x * np.sin(angle) + y * np.cos(angle)
    bins = np.column_stack([when, *(np.floor(a / spacing).astype(np.int64) for a in across)])
    _, own = np.unique(bins, axis=0, return_inverse=True)
    own, count = own.ravel(), np.bincount(own.ravel())
    mass = np.bincount(own, drops.mass)

    def mean(values):  # (M, 3) by mass
        return np.stack([np.bincount(own, drops.mass * column) for column in values.T], axis=1) / mass[:, None]

    velocity, time = mean(drops.velocity), mean(drops.time[:, None])[:, 0]
    place = mean(drops.place + (time[own] - drops.time)[:, None] * drops.velocity)
    apart = ((drops.velocity - velocity[own]) ** 2).sum(axis=1)
    theta = np.bincount(own, drops.mass * apart) / (3.0 * mass)
    moments = (np.bincount(own, drops.diameter**power) / count for power in (2, 3))
    sizes = np.array([grain_sizes.of_moments(*pair) for pair in zip(*moments)])
    order = np.argsort(time, kind="stable")
    return Parcels(*(part[order] for part in (time, place, velocity, mass, theta, *sizes.T)))


class Replay:
    """The table of a nozzle, the `nth` of its case from 0, as it is played: `parcels` of one period [s], their masses
    scaled to the nozzle's rate."""

    def __init__(self, case, nozzle, nth: int = 0):
        drops = read(nozzle.table)
        late = drops.time > nozzle.table_from
        if not late.any():
            raise CaseError(f"no drop of table = {nozzle.table!r} comes after table_from_s = {nozzle.table_from:g}")
        self.drops = Drops(*(part[late] for part in drops))
        self.nozzle, self.nth, self.spacing = nozzle, nth, case.resolution.spacing
        self.period = float(self.drops.time[-1]) - nozzle.table_from
        self.scale = nozzle.rate * self.period / float(self.drops.mass.sum())
        self._refuse_other_density(case.grains.density)
        seed = (nozzle.seed, 0, nth) if nth else nozzle.seed
        parcels = gathered(self.drops, self.spacing / nozzle.speed, self.spacing, seed)
        self.parcels = parcels._replace(time=parcels.time - nozzle.table_from, mass=self.scale * parcels.mass)

    def _refuse_other_density(self, density: float) -> None:
        found = float(self.drops.mass.sum() / (math.pi / 6.0 * (self.drops.diameter**3).sum()))
        if abs(found - density) > ROUND * density:
            raise CaseError(
                f"the drops of table = {self.nozzle.table!r} have {found:.4g} kg/m3, grains.density_kg_m3 = "
                f"{density:g}; give the one that they have"
            )

    def count(self, time: float) -> int:
        """Particles that have come in up to `time` [s]."""
        end = math.inf if self.nozzle.end is None else self.nozzle.end
        since = min(time, end) - self.nozzle.start
        if since < 0.0:
            return 0
        whole = math.floor(since / self.period)
        return whole * len(self.parcels.time) + int(
            np.searchsorted(self.parcels.time, since - whole * self.period, side="right")
        )

    def due(self, before: int, time: float) -> Parcels:
        """Particles that come in up to `time` [s] after the first `before` of them: where they are then, in the axes of
        the domain."""
        number = np.arange(before, self.count(time))
        period, row = np.divmod(number, len(self.parcels.time))
        own = Parcels(*(part[row] for part in self.parcels))
        crossed = self.nozzle.start + period * self.period + own.time
        place, velocity = own.place.copy(), own.velocity.copy()
        for k in np.unique(period):
            turn = self._turn(int(k))
            place[period == k], velocity[period == k] = (part[period == k] @ turn.T for part in (place, velocity))
        frame = frame_of(self.nozzle)
        place, velocity = np.array(self.nozzle.centre) + place @ frame, velocity @ frame
        return own._replace(time=crossed, place=place + (time - crossed)[:, None] * velocity, velocity=velocity)

    def _turn(self, period: int) -> np.ndarray:
        """(3, 3) by which a period is turned about the axis; the first is not."""
        seed = (self.nozzle.seed, period, *chance(self.nth))
        angle = np.random.default_rng(seed).uniform(0.0, 2.0 * math.pi) if period else 0.0
        return np.array([
            [math.cos(angle), -math.sin(angle), 0.0], [math.sin(angle), math.cos(angle), 0.0], [0.0, 0.0, 1.0]
        ])  # fmt: skip


class Replays:
    """The tables of a case's nozzles as they are played: how many particles each nozzle has `given`."""

    KEPT = ("given",)  # see sdph.engine.kept

    def __init__(self, case):
        own = enumerate(case.nozzles.values())
        self.of = [Replay(case, n, nth) if n.shape == "table" and n.table else None for nth, n in own]
        self.given = [0] * len(self.of)

    @property
    def heaviest(self) -> float:
        """Largest mass [kg] of a particle that they give."""
        return max((float(replay.parcels.mass.max()) for replay in self.of if replay), default=0.0)

    def due(self, time: float) -> list[int]:
        """Particles that the nozzles have given up to `time` [s]."""
        return [replay.count(time) if replay else 0 for replay in self.of]

    def come(self, source, time: float):
        """States of what has come in since the last call, up to `time` [s], in the gas at once."""
        for k, number in enumerate(self.due(time)):
            if number == self.given[k]:
                continue
            own = self.of[k].due(self.given[k], time)
            self.given[k] = number
            more = source.make(np.full(len(own.time), k), own.place, own.velocity)
            more.kind[:], more.entering[:] = GRAIN, 0
            more.mass[:], more.density[:] = own.mass, own.mass / source.pitch**3
            values = {
                "entered": own.time,
                "theta": own.theta,
                "diameter": own.diameter,
                "diameter_variance": own.variance,
            }
            for name, column in values.items():
                if len(getattr(more, name)):
                    getattr(more, name)[:] = column
            yield particles.born(more)
