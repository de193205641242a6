"""One instant of a run as pictures take it: particles, gas, walls, the box that is shown, and the view on it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from sdph.case import read as cases
from sdph.engine.state import GAS
from sdph.running import fields, output
from sdph.schema import CaseError
from sdph.show import style, timeline

SLAB = 0.25  # of the next longer side: a gas box so thin is looked at across, as a picture of two dimensions
THIN, DOT = (
    0.01,
    0.3,
)  # alpha_p below which droplets of a nozzle are dots, so large over what else they would be; our choice
MARGIN = 0.04  # of its longest side, around particles that have neither gas nor walls around them; our choice


@dataclass(frozen=True)
class Shot:
    """Particles and gas (None: there is none) at a time [s] and what surrounds them.

    box (6,) [m] as pyvista has it; axes: those that a flat picture shows, right and up, None in space; level [m]: of
    that picture along the third; spacing [m] of the particles; kernel dimensions 2 or 3; up (3,).
    """

    time: float
    particles: object
    gas: object
    walls: object
    title: str
    case: object
    box: np.ndarray
    up: tuple
    axes: tuple[int, int] | None
    level: float
    spacing: float
    dimensions: int

    @property
    def across(self) -> int:
        """The axis that a flat picture looks along."""
        return 3 - sum(self.axes)

    def named(self) -> list[str]:
        """Fields that can be shown."""
        return sorted({*self.particles.point_data, *(self.gas.cell_data if self.gas is not None else ())})

    def values(self, field: str, over: str = "") -> list[np.ndarray]:
        """Values of the field on particles, those that have the field `over` left out, and on gas, where they have it;
        of vectors their length."""
        found, own = [], self.particles.point_data
        if field in own:
            found.append(numbers(own[field])[~self.has(over)])
        if self.gas is not None and field in self.gas.cell_data:
            found.append(numbers(self.gas.cell_data[field]))
        return found

    def has(self, field: str) -> np.ndarray:
        """(N,) mask of the particles that have a field."""
        own, count = self.particles.point_data, self.particles.n_points
        return np.isfinite(numbers(own[field])) if field in own else np.zeros(count, bool)

    def words(self, field: str) -> tuple[str, ...]:
        """Names that the numbers of a field stand for, from 0 on; none of others."""
        return tuple(self.case.materials) if field == "material" and self.case else ()

    def sizes(self) -> np.ndarray:
        """(N,) edge [m] of the square or cube that each particle stands for, at most a spacing: in a spray particles
        have moved apart, and the sum of the density knows but one."""
        data = self.particles.point_data
        if "mass" not in data or "density" not in data:
            return np.full(self.particles.n_points, self.spacing)
        edge = (np.asarray(data["mass"]) / np.asarray(data["density"])) ** (1.0 / self.dimensions)
        return np.minimum(edge, self.spacing)

    def drawn(self) -> np.ndarray:
        """The same as pictures draw it: of a thin spray dots, between which the gas is seen."""
        sizes, own = self.sizes(), self.case.grains if self.case else None
        if not own or not self.case.nozzles or "density" not in self.particles.point_data:
            return sizes
        return np.where(np.asarray(self.particles.point_data["density"]) < THIN * own.density, DOT, 1.0) * sizes

    def light(self) -> np.ndarray:
        """(N,) mask of the particles of a gas beside a liquid."""
        data, count = self.particles.point_data, self.particles.n_points
        own = np.asarray(data["kind"]) == GAS if "kind" in data else np.zeros(count, bool)
        return own if not own.all() else np.zeros(count, bool)


def numbers(values) -> np.ndarray:
    """Values (N,), of vectors (N, k) their length."""
    values = np.asarray(values)
    return np.linalg.norm(values, axis=1) if values.ndim == 2 else values.astype(float)


def of_folder(folder: Path, time: float | None = None) -> Shot:
    """The instant of a run nearest to `time` [s]; the last without one."""
    case, file = case_of(folder), folder / output.WALLS
    walls = fields.load(file) if file.exists() else None
    return of_state(timeline.state_at(timeline.read(folder), time), case, walls)


def all_of_folder(folder: Path) -> list[Shot]:
    """All instants of a run, in one box."""
    reader = timeline.read(folder)
    shots = [of_folder(folder, time) for time in reader.time_values]
    boxes = np.array([shot.box for shot in shots]).reshape(-1, 3, 2)
    box = np.stack((boxes[:, :, 0].min(axis=0), boxes[:, :, 1].max(axis=0)), axis=1).ravel()
    return [replace(shot, box=box) for shot in shots]


def case_of(folder: Path):
    """The case of a run folder; None in one of fields alone."""
    file = folder / output.MARK
    return cases.load(file) if file.exists() else None


def of_state(instant: timeline.Instant, case, walls) -> Shot:
    """The same from what is at hand."""
    time, particles, gas = instant
    box = _box(particles, gas, walls, case)
    gravity = case.domain.gravity if case else ()
    up, lengths = upwards(gravity), box[1::2] - box[::2]
    axes = _axes(lengths, up, gas is not None)
    level = 0.0 if axes is None else float(box[::2][3 - sum(axes)] + 0.5 * lengths[3 - sum(axes)])
    dimensions = case.dimensions if case else 2 + bool(lengths[2])
    spacing = case.resolution.spacing if case else _spacing(particles, dimensions)
    title = case.title if case else ""
    return Shot(time, particles, gas, walls, title, case, box, up, axes, level, spacing, dimensions)


def _box(particles, gas, walls, case) -> np.ndarray:
    """Box of gas and walls; of particles with a margin where these are all there is; without any, the domain."""
    around = [mesh for mesh in (gas, walls) if mesh is not None and mesh.n_points]
    found = [mesh.bounds for mesh in around or [particles] if mesh.n_points]
    if not found and case:
        found = [np.stack([[*end, 0.0][:3] for end in (case.domain.corner, case.domain.upper)], axis=1).ravel()]
    found = np.reshape(found or [np.zeros(6)], (-1, 3, 2))
    box = np.stack((found[:, :, 0].min(axis=0), found[:, :, 1].max(axis=0)), axis=1)
    if not around and particles.n_points:
        thick = (box[:, 1] - box[:, 0]) > 0.0
        box[thick] += np.array([-1.0, 1.0]) * MARGIN * np.ptp(box, axis=1).max()
    return box.ravel()


def _axes(lengths: np.ndarray, up: tuple, gas: bool) -> tuple[int, int] | None:
    """Axes of a flat picture; None where the box is to be seen in space."""
    if not lengths[2]:
        return 0, 1
    across = int(np.argmin(lengths))
    if not gas or lengths[across] >= SLAB * np.median(lengths):
        return None
    vertical = int(np.argmax(up))
    if vertical == across:
        vertical = 1 if across != 1 else 2
    return 3 - across - vertical, vertical


def _spacing(particles, dimensions: int) -> float:
    """Median of the edges [m] that particles stand for."""
    data = particles.point_data
    if not particles.n_points:
        return 1.0
    return float(np.median((np.asarray(data["mass"]) / np.asarray(data["density"])) ** (1.0 / dimensions)))


def upwards(gravity) -> tuple:
    """The axis, as a vector (3,), against which gravity (d,) [m/s2] pulls most; z in two dimensions and where nothing
    falls."""
    falls = len(gravity) == 3 and min(gravity) < 0.0
    return tuple(float(a == (np.argmin(gravity) if falls else 2)) for a in range(3))


def chosen(shots: list[Shot], field: str | None) -> str:
    """The field to show: `field`, or that whose label it is (speed); `CaseError` where the shots have none of that
    name; else what the scene is about. Shots with nothing in them have no fields."""
    known = sorted({name for own in shots for name in own.named()} & style.QUANTITIES.keys())
    field = next((name for name in known if style.QUANTITIES[name].label == field), field)
    if field and field not in known:
        there = f"this run has {', '.join(known)}" if known else "nothing is there to show then; leave it out"
        raise CaseError(f"--field {field}: {there}")
    return field or _subject([own for own in shots if own.named()] or shots, known)


def all_chosen(shots: list[Shot], field: str | None) -> tuple[str, ...]:
    """The fields to show: the one `chosen`, or two of "A,B": B of the particles that have it, as those of a shell have
    damage, A of all else."""
    if not field or "," not in field:
        return (chosen(shots, field),)
    names = field.split(",")
    if len(names) > 2 or any(own.axes is None for own in shots):
        raise CaseError(f"--field {field}: two fields at most, and those in pictures of two dimensions; name one")
    first, over = (chosen(shots, name.strip()) for name in names)
    if not any(np.isfinite(part).any() for own in shots for part in own.values(first, over)):
        raise CaseError(f"--field {field}: all that has {first} has {over} too; name another first, or one")
    return first, over


# metrics of a case -> what it is about
TOLD_BY = {"bubble": "alpha_p", "agitation": "theta", "segregation": "material"}
WARM = 1.0  # K that temperatures must differ by to be a subject; our choice
SLOW = 1e-3  # of the speed of sound: a liquid that moves no faster than that is about its pressure; our choice


def _subject(shots: list[Shot], known: list[str]) -> str:
    """Subject of a scene: what its metrics measure in the picture; how warm it is, where that differs; what solids
    bear; how dense grains lie, in a column or at rest; how fast it is; and of a liquid at rest its pressure."""
    last, case = shots[-1], shots[-1].case
    told = [TOLD_BY[name] for name in (case.run.metrics if case else ()) if TOLD_BY.get(name) in known]
    if told:
        return told[0]
    cold = case is not None and case.grains and "heat" not in case.effects  # grains keep theirs
    for field, least in (("temperature", WARM), ("plastic_strain", 1e-3), ("equivalent_stress", 1.0))[bool(cold) :]:
        values = [own[np.isfinite(own)] for own in last.values(field)]
        if (spread := [own for own in values if len(own)]) and np.ptp(np.concatenate(spread)) > least:
            return field
    column = case is not None and "column" in case.run.metrics
    if "alpha_p" in known and (column or (last.gas is not None and not _moves(last))):
        return "alpha_p"
    return "velocity" if _moves(last) or "pressure" not in known else "pressure"


def _moves(shot: Shot) -> bool:
    sound = shot.case.fastest_sound if shot.case and shot.case.liquid else 0.0
    return max((float(own.max(initial=0.0)) for own in shot.values("velocity")), default=0.0) > SLOW * sound
