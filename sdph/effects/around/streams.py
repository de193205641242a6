"""The streams of a nozzle: where in its mouth particles pass, how fast, how much mass each is."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from sdph.effects.around import rates
from sdph.engine.rows import entry, place
from sdph.laws.compiled import serial
from sdph.laws.constants import ROUND_OFF, TINY
from sdph.schema import CaseError

JITTER = 0.02  # of a spacing: places in an annulus, so that no row lines up; swirl-sheet.md, section 2, 10


def unit(vector_) -> np.ndarray:
    """A vector of length 1."""
    a = np.asarray(vector_, float)
    return a / np.linalg.norm(a)


class Streams(NamedTuple):
    """S streams of one nozzle: places in the mouth (S, d) [m], axis (d,), speed along it (S,) [m/s], velocity at the
    mouth (S, d), mass [kg] at a place, which particles of several sizes share, layer pitch [m], volume fraction, which
    is 1 of liquid; mass and volume fraction are those at the largest rate."""

    mouth: np.ndarray
    axis: np.ndarray
    speed: np.ndarray
    velocity: np.ndarray
    mass: float
    pitch: float
    alpha_p: float


def matter_of(case, nozzle):
    """The grains, or the liquid, that a nozzle gives."""
    return case.of(nozzle.material) if case.grains else case.liquid


def streams_of(case, nozzle) -> Streams:
    """The streams of a nozzle, on a lattice of the case's spacing that is fitted to the area of the mouth."""
    spacing, axis = case.resolution.spacing, unit(nozzle.direction)
    if nozzle.shape == "table":
        nothing, alpha_p = (
            np.zeros((0, 3)),
            nozzle.rate / (case.grains.density * math.pi * nozzle.radius**2 * nozzle.speed),
        )
        return Streams(nothing, axis, nothing[:, 0], nothing, 0.0, spacing, alpha_p)
    offsets, area, reach = _mouth(case, nozzle, axis)
    distance = np.linalg.norm(offsets, axis=1)
    speed = np.full(len(offsets), nozzle.speed)
    if nozzle.profile == "parabolic":
        along = np.abs(offsets @ _tangents(nozzle, axis)[0]) if nozzle.shape == "slot" else distance
        speed = 1.0 - (along / reach) ** 2
        speed *= nozzle.speed / speed.mean()
    angle = nozzle.half_angle * distance / reach
    outward = offsets / np.maximum(distance, TINY)[:, None]
    velocity = speed[:, None] * (np.cos(angle)[:, None] * axis + np.sin(angle)[:, None] * outward)
    if nozzle.shape == "annulus":
        velocity = velocity + nozzle.swirl * nozzle.speed * np.cross(axis, outward)
    speed = speed * np.cos(angle)
    density = matter_of(case, nozzle).density
    alpha_p = 1.0
    if case.grains:
        alpha_p = nozzle.volume_fraction or rates.largest(nozzle) / (density * area * speed.mean())
    mass = alpha_p * density * area / len(offsets) * spacing
    return Streams(np.array(nozzle.centre) + offsets, axis, speed, velocity, mass, spacing, alpha_p)


def layers_of(nozzle, streams: Streams) -> np.ndarray:
    """Layers (S,) that each stream gives until the nozzle closes; without end more than any run takes."""
    if nozzle.end is None:
        return np.full(len(streams.speed), np.iinfo(np.int64).max)
    return np.round(streams.speed * (nozzle.end - nozzle.start) / streams.pitch).astype(np.int64)


def frame_of(nozzle) -> np.ndarray:
    """(3, 3) unit vectors of a nozzle in space: two in its mouth, the first along its width, and its axis."""
    axis = unit(nozzle.direction)
    return np.stack([*_tangents(nozzle, axis), axis])


def _tangents(nozzle, axis) -> list[np.ndarray]:
    """Unit vectors in the plane of the mouth; the first along the width."""
    if len(axis) == 2:
        return [np.array([-axis[1], axis[0]])]
    given = nozzle.across or np.eye(3)[np.argmin(np.abs(axis))]
    first = unit(given - (np.asarray(given) @ axis) * axis)
    return [first, np.cross(axis, first)]


def _mouth(case, nozzle, axis) -> tuple[np.ndarray, float, float]:
    """Offsets (S, d) [m] of the streams from the centre, area of the mouth [m2 or m], distance of its rim [m]."""
    spacing, tangents = case.resolution.spacing, _tangents(nozzle, axis)
    if nozzle.shape == "slot" or case.dimensions == 2:
        sizes = _sizes(nozzle, len(tangents))
        ticks = [_ticks(size, spacing) for size in sizes]
        grid = np.stack([m.ravel() for m in np.meshgrid(*ticks, indexing="ij")], axis=1)
        return grid @ np.stack(tangents), math.prod(sizes), 0.5 * sizes[0]
    if nozzle.shape == "annulus":
        return _rings(nozzle, spacing) @ np.stack(tangents), _area(nozzle), nozzle.radius
    n = math.ceil(nozzle.radius / spacing) + 1
    ticks = (np.arange(-n, n) + 0.5) * spacing
    grid = np.stack([m.ravel() for m in np.meshgrid(ticks, ticks, indexing="ij")], axis=1)
    grid = grid[(grid**2).sum(axis=1) <= nozzle.radius**2]
    if not len(grid):
        raise CaseError(
            f"resolution.spacing_mm = {spacing * 1e3:g} is too coarse for a nozzle of radius {nozzle.radius * 1e3:g} "
            "mm; give it less"
        )
    area = math.pi * nozzle.radius**2
    return grid * math.sqrt(area / len(grid)) / spacing @ np.stack(tangents), area, nozzle.radius


def _area(nozzle) -> float:
    return math.pi * (nozzle.radius**2 - nozzle.inner_radius**2)


def _rings(nozzle, spacing: float) -> np.ndarray:
    """Places (S, 2) [m] in an annulus: a ring for each spacing of its gap, of as many streams as its area asks for."""
    number = max(1, round((nozzle.radius - nozzle.inner_radius) / spacing))
    edges = np.linspace(nozzle.inner_radius, nozzle.radius, number + 1)
    rings = []
    for low, high in itertools.pairwise(edges):
        count = max(3, round(math.pi * (high**2 - low**2) / spacing**2))
        angle = 2.0 * math.pi * np.arange(count) / count
        rings.append(0.5 * (low + high) * np.stack([np.cos(angle), np.sin(angle)], axis=1))
    return np.concatenate(rings)


def turned(nozzle, own: Streams, stream, layer, place, nth: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Places (n, 3) [m] and velocities (n, 3) [m/s] of particles of an annulus in its streams (n,), layers (n,) and at
    places (n,) [m] along the axis.

    Each layer is turned by an angle of its own, drawn by the seed and by which of the nozzles it is, `nth` from 0, and
    strewn by JITTER; it comes along helices, so that nothing slips at the mouth.
    """
    offsets = own.mouth[stream] - nozzle.centre
    angle = nozzle.swirl * place / np.linalg.norm(offsets, axis=1)
    aside = np.zeros_like(offsets)
    for number in np.unique(layer):
        draw, rows = np.random.default_rng((nozzle.seed, int(number), *chance(nth))), layer == number
        angle[rows] += draw.uniform(0.0, 2.0 * math.pi)
        aside[rows] = JITTER * own.pitch * draw.uniform(-1.0, 1.0, (len(own.mouth), 3))[stream[rows]]
    places = nozzle.centre + about(own.axis, offsets, angle) + aside + place[:, None] * own.axis
    return places, swirling(nozzle, own, places)


def chance(nth: int) -> tuple[int, ...]:
    """Numbers that make the chance of a nozzle, the `nth` from 0, another than that of those before it with the same
    seed; none of the first."""
    return (nth,) if nth else ()


def swirling(nozzle, own: Streams, places) -> np.ndarray:
    """Velocities (n, 3) [m/s] that an annulus gives at places (n, 3) [m]: u along the axis, swirl u around it."""
    offsets = places - nozzle.centre
    offsets = offsets - (offsets @ own.axis)[:, None] * own.axis
    around = np.cross(own.axis, offsets) / np.linalg.norm(offsets, axis=1)[:, None]
    return nozzle.speed * (own.axis + nozzle.swirl * around)


def about(axis, offsets, angle) -> np.ndarray:
    """Offsets (n, 3) [m] from an axis turned about it by angles (n,) [rad]."""
    return np.cos(angle)[:, None] * offsets + np.sin(angle)[:, None] * np.cross(axis, offsets)


def _ticks(size: float, spacing: float) -> np.ndarray:
    count = max(1, round(size / spacing))
    return size * ((np.arange(count) + 0.5) / count - 0.5)


def in_mouth(nozzle, offsets) -> np.ndarray:
    """Tell which offsets (n, d) [m] from the centre lie, along the axis, in the mouth of a nozzle with streams."""
    axis, wide = unit(nozzle.direction), 1.0 + ROUND_OFF
    tangents = _tangents(nozzle, axis)
    across = offsets @ np.stack(tangents, axis=1)
    if nozzle.shape == "slot" or len(axis) == 2:
        return (np.abs(across) <= 0.5 * wide * np.array(_sizes(nozzle, len(tangents)))).all(axis=1)
    aside = np.linalg.norm(across, axis=1)
    return (aside <= nozzle.radius * wide) & (aside * wide >= (nozzle.inner_radius or 0.0))


def _sizes(nozzle, count: int) -> tuple[float, ...]:
    """Extents [m] of a slot, or of a disc in the plane, along the first so many tangents."""
    return ((nozzle.width, nozzle.length) if nozzle.shape == "slot" else (2.0 * nozzle.radius,))[:count]


@serial
def without(gone, rows):
    """Take the entries that are `gone` (W,) out of rows."""
    for i in range(len(rows.number)):
        kept = 0
        for k in range(rows.number[i]):
            if not gone[entry(rows, i, k)]:
                rows.entries[place(rows, i, kept)] = entry(rows, i, k)
                kept += 1
        rows.number[i] = kept


@dataclass(frozen=True)
class Patch:
    """Grains that are there at the start, or come in: volume fraction, temperature, velocity, corners of their box;
    angle [rad] that their paths spread up to on each side; Sauter mean diameter [m] where it is not that of the
    grains, and that of the particles with the largest drops."""

    alpha_p: float
    temperature: float
    velocity: tuple
    lower: tuple
    upper: tuple
    half_angle: float = 0.0
    diameter: float | None = None
    largest: float | None = None
