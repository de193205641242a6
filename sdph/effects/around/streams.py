"""The streams of a nozzle: where in its mouth particles pass, how fast, how much mass each is."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numba import njit

from sdph.engine.rows import entry, place
from sdph.schema import CaseError

ROUND_OFF = 1e-9  # of a spacing


def unit(vector_) -> np.ndarray:
    """A vector of length 1."""
    a = np.asarray(vector_, float)
    return a / np.linalg.norm(a)


class Streams(NamedTuple):
    """S streams of one nozzle: places in the mouth (S, d) [m], axis (d,), speed along it (S,) [m/s], velocity at the
    mouth (S, d), mass of a particle [kg], layer pitch [m], volume fraction."""

    mouth: np.ndarray
    axis: np.ndarray
    speed: np.ndarray
    velocity: np.ndarray
    mass: float
    pitch: float
    alpha_p: float


def streams_of(case, nozzle) -> Streams:
    """The streams of a nozzle, on a lattice of the case's spacing that is fitted to the area of the mouth."""
    spacing, axis = case.resolution.spacing, unit(nozzle.direction)
    offsets, area, reach = _mouth(case, nozzle, axis)
    distance = np.linalg.norm(offsets, axis=1)
    speed = np.full(len(offsets), nozzle.speed)
    if nozzle.profile == "parabolic":
        along = np.abs(offsets @ _tangents(nozzle, axis)[0]) if nozzle.shape == "slot" else distance
        speed = 1.0 - (along / reach) ** 2
        speed *= nozzle.speed / speed.mean()
    angle = nozzle.half_angle * distance / reach
    outward = offsets / np.maximum(distance, 1e-300)[:, None]
    velocity = speed[:, None] * (np.cos(angle)[:, None] * axis + np.sin(angle)[:, None] * outward)
    speed = speed * np.cos(angle)
    alpha_p = nozzle.volume_fraction or nozzle.rate / (case.grains.density * area * speed.mean())
    mass = alpha_p * case.grains.density * area / len(offsets) * spacing
    return Streams(np.array(nozzle.centre) + offsets, axis, speed, velocity, mass, spacing, alpha_p)


def layers_of(nozzle, streams: Streams) -> np.ndarray:
    """Layers (S,) that each stream gives until the nozzle closes; without end more than any run takes."""
    if nozzle.end is None:
        return np.full(len(streams.speed), np.iinfo(np.int64).max)
    return np.round(streams.speed * (nozzle.end - nozzle.start) / streams.pitch).astype(np.int64)


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
        sizes = (nozzle.width, nozzle.length) if nozzle.shape == "slot" else (2.0 * nozzle.radius,)
        sizes = sizes[: len(tangents)]
        ticks = [_ticks(size, spacing) for size in sizes]
        grid = np.stack([m.ravel() for m in np.meshgrid(*ticks, indexing="ij")], axis=1)
        return grid @ np.stack(tangents), math.prod(sizes), 0.5 * sizes[0]
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


def _ticks(size: float, spacing: float) -> np.ndarray:
    count = max(1, round(size / spacing))
    return size * ((np.arange(count) + 0.5) / count - 0.5)


def cell_radius(pitch: float, dimensions: int) -> float:
    """Radius [m] of a stream's part of the mouth: in space that of a circle as large as a cell of the lattice."""
    return 0.5 * pitch * (1.0 + ROUND_OFF) if dimensions == 2 else pitch / math.sqrt(math.pi)


@njit(cache=True, error_model="numpy")
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
    angle [rad] that their paths spread up to on each side."""

    alpha_p: float
    temperature: float
    velocity: tuple
    lower: tuple
    upper: tuple
    half_angle: float = 0.0
