"""Half angle of a swirling sheet, how far from its mouth light gets through it, and how much of it is holes.

The axis of the sheet is that of its nozzle; places (N, 3) [m] are about the middle of the mouth, z along the axis.
"""

from __future__ import annotations

import math
import re

import numpy as np

from sdph.effects.around.streams import streams_of, turned
from sdph.laws import sheets

RANGE = (0.25, 0.85)  # of the sheet's length, over which the slope is taken; swirl-sheet.md, section 7
PIXEL, MIDDLE, HALF, SMOOTHED = 2.0, 0.8, 0.5, 3  # l0; of the width; of the light; rows; the same
TENTH = 0.1  # of the surface empty, where holes are told to begin; our choice


def nozzle_of(case):
    """The annular nozzle of a case, whose sheet is all its liquid; None where there is none, or another nozzle."""
    found = list(case.nozzles.values())
    return found[0] if len(found) == 1 and found[0].shape == "annulus" else None


def untold(case) -> list[str]:
    """A line where there are sheets that are not measured, as they are of several nozzles."""
    many = len(case.nozzles)
    if many == 1 or "annulus" not in [nozzle.shape for nozzle in case.nozzles.values()]:
        return []
    return [
        f"half angle, break-up length and holes are about one axis: there are {many} nozzles, so that none of them is "
        "told; run each nozzle alone for them (droplets.csv says which nozzle each drop is from)"
    ]


def about_axis(nozzle, places) -> np.ndarray:
    """(N, 3) places with z along the axis of a nozzle, from the middle of its mouth."""
    axis = np.asarray(nozzle.direction, float) / np.linalg.norm(nozzle.direction)
    first = np.eye(3)[np.argmin(np.abs(axis))]
    first = first - (first @ axis) * axis
    first /= np.linalg.norm(first)
    return (places - np.array(nozzle.centre)) @ np.stack([first, np.cross(axis, first), axis]).T


def reach(places) -> float:
    """Length [m] of the sheet: where all but a hundredth of it is."""
    return float(np.quantile(places[:, 2], 0.99)) if len(places) else 0.0


def half_angle(places, length: float) -> float:
    """Half angle [rad] by the slope of the radius against z over RANGE of `length` [m]; nan of a short sheet."""
    z = places[:, 2]
    on = (z > RANGE[0] * length) & (z < RANGE[1] * length)
    if on.sum() < 3:
        return math.nan
    return float(np.arctan(np.polyfit(z[on], np.hypot(*places[on, :2].T), 1)[0]))


def half_angle_of_outline(places, length: float, spacing: float) -> float:
    """Half angle [rad] as one measures it on a picture from aside: slope of the furthest particle from the axis, in
    rows as high as a pixel, over the same range; nan of a short sheet."""
    z, out = places[:, 2], np.abs(places[:, 0])
    rows = np.arange(math.ceil(RANGE[0] * length / (PIXEL * spacing)), int(RANGE[1] * length / (PIXEL * spacing)))
    own = np.floor(z / (PIXEL * spacing)).astype(int)
    found = [(row, out[own == row].max()) for row in rows if (own == row).any()]
    if len(found) < 3:
        return math.nan
    height, edge = np.array(found).T
    return float(np.arctan(np.polyfit(height * PIXEL * spacing, edge, 1)[0]))


def half_angle_of_meridian(z, r, length: float) -> float:
    """The same of a curve r (n,) at z (n,) [m]; nan of no length."""
    if length <= 0.0:
        return math.nan
    ends = np.linspace(RANGE[0] * length, RANGE[1] * length, 400)
    return float(np.arctan(np.polyfit(ends, np.interp(ends, z, r), 1)[0]))


def transmission(places, spacing: float) -> tuple[np.ndarray, np.ndarray]:
    """Distances [m] from the mouth and the share of light that gets through the sheet there, seen from aside: the mean
    of exp(-depth) over the middle of its width, depth = sum l0^2/pixel area of the particles of a pixel."""
    pixel = PIXEL * spacing
    rows = np.floor(places[:, 2] / pixel).astype(int)
    found = []
    for row in range(max(0, rows.max(initial=-1) + 1)):
        own = places[rows == row]
        if not len(own):
            found.append(1.0)
            continue
        half = MIDDLE * float(np.hypot(*own[:, :2].T).mean())
        count = max(1, round(2.0 * half / pixel))
        number = np.histogram(own[:, 0], np.linspace(-half, half, count + 1))[0]
        found.append(float(np.exp(-number * spacing**2 / (2.0 * half / count * pixel)).mean()))
    return (np.arange(len(found)) + 0.5) * pixel, np.array(found)


def break_up(places, spacing: float) -> float:
    """Distance [m] from the mouth along the axis at which the sheet first lets half of the light through, three rows
    smoothed; nan where it nowhere does."""
    return first_past(*transmission(places, spacing), HALF)


def first_past(z, share, most: float) -> float:
    """The first of the places z (n,) [m] where a share (n,) is above `most`, three rows smoothed; nan where none is."""
    if len(share) < SMOOTHED:
        return math.nan
    smooth = np.convolve(share, np.full(SMOOTHED, 1.0 / SMOOTHED), mode="valid")
    past = np.flatnonzero(smooth > most)
    return float(z[past[0] + SMOOTHED // 2]) if len(past) else math.nan


def empty(places, spacing: float, nozzle, length: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Ways s [m] along the path, up to `length` [m] along the axis, the share of the surface there that is empty, and
    its area [m2], rows (n,) of cells 2 l0 along the path and across it.

    The surface is that of straight flight, unrolled: a particle that left at the angle phi_0 has
    phi = phi_0 + atan(alpha z/r_0) and has gone s = z sqrt(1 + alpha^2), so that phi_0 stays what it was. Between paths
    that left d phi_0 apart there are w d phi_0, w = r sqrt(1 + (alpha^2 z/r)^2)/sqrt(1 + alpha^2) [m]: as the sheet
    thins by straight flight (sdph.laws.sheets.thickness), so they part. A cell is empty that has no particle in it.
    """
    cell, middle, alpha = PIXEL * spacing, 0.5 * (nozzle.inner_radius + nozzle.radius), nozzle.swirl
    ways = (np.arange(int(slant(nozzle) * length / cell)) + 0.5) * cell
    z = ways / slant(nozzle)
    radius = sheets.ballistic_radius(z, middle, alpha)
    apart = radius * np.hypot(1.0, alpha**2 * z / radius) / slant(nozzle)
    count = np.maximum(1, np.round(2.0 * math.pi * apart / cell).astype(int))
    row = np.floor(places[:, 2] * slant(nozzle) / cell).astype(int)
    own = (row >= 0) & (row < len(ways))
    row, x, y, high = row[own], *places[own].T
    left = (np.arctan2(y, x) - np.arctan(alpha * high / middle)) / (2.0 * math.pi) % 1.0
    place = np.minimum((left * count[row]).astype(int), count[row] - 1)
    start = np.cumsum(count) - count
    covered = np.bincount(np.searchsorted(start, np.unique(start[row] + place), side="right") - 1, minlength=len(ways))
    return ways, 1.0 - covered / count, 2.0 * math.pi * apart * cell


def holes(places, spacing: float, nozzle, length: float) -> dict[str, float]:
    """Summary of the empty cells of a sheet up to `length` [m] along the axis: their area, its share of the surface,
    and the ways along the path past which a tenth and half of the surface is empty; nan where it nowhere is."""
    ways, share, area = empty(places, spacing, nozzle, length)
    gone = float(share @ area) if len(ways) else math.nan
    return {
        "empty_area_m2": gone,
        "empty_share": gone / float(area.sum()) if len(ways) else math.nan,
        "tenth_empty_way_m": first_past(ways, share, TENTH),
        "half_empty_way_m": first_past(ways, share, HALF),
    }


def slant(nozzle) -> float:
    """Way along a particle's path over that along the axis: sqrt(1 + alpha^2)."""
    return math.hypot(1.0, nozzle.swirl)


def ballistic(case, length: float) -> np.ndarray:
    """(N, 3) places up to `length` [m] along the axis of what the nozzle gives, had it flown straight."""
    nozzle = nozzle_of(case)
    own = streams_of(case, nozzle)
    layers = math.ceil(length / own.pitch)
    stream = np.tile(np.arange(len(own.mouth)), layers)
    layer = np.repeat(np.arange(layers), len(own.mouth))
    places, velocities = turned(nozzle, own, stream, layer, np.zeros(len(layer)))
    way = (layer + 0.5) * own.pitch / nozzle.speed
    return about_axis(nozzle, places + way[:, None] * velocities)


def named(name: str, word: str) -> str:
    """Name of a number of the summary with a word before its unit: half_angle_deg, mean -> half_angle_mean_deg."""
    return re.sub(r"(_m2|_m|_deg)?$", rf"_{word}\1", name, count=1)


def way_out(case) -> float:
    """Length [m] of the domain along the axis of its sheet."""
    return case.domain.size[int(np.argmax(np.abs(nozzle_of(case).direction)))]


def seen_from(case, places) -> tuple[np.ndarray, float]:
    """(N, 3) places [m] about the axis of what has left the mouth, and the length [m] of the sheet in the domain."""
    seen = about_axis(nozzle_of(case), places)
    seen = seen[seen[:, 2] > 0.0]
    return seen, min(reach(seen), way_out(case))


def measured(case, seen, length: float) -> dict[str, float]:
    """Half angles [deg], break-up length along the path and holes of one instant, as `seen_from` gives it."""
    nozzle, spacing = nozzle_of(case), case.resolution.spacing
    return {
        "half_angle_deg": math.degrees(half_angle(seen, length)),
        "half_angle_of_outline_deg": math.degrees(half_angle_of_outline(seen, length, spacing)),
        "break_up_length_m": slant(nozzle) * break_up(seen, spacing),
    } | holes(seen, spacing, nozzle, length)


def told(case, places) -> dict[str, float]:
    """Summary of a sheet at one instant, beside what particles that fly straight give over the same range by the same
    rules."""
    nozzle, spacing = nozzle_of(case), case.resolution.spacing
    seen, length = seen_from(case, places)
    z = np.linspace(0.0, max(length, spacing), 400)
    middle = 0.5 * (nozzle.inner_radius + nozzle.radius)
    straight = half_angle_of_meridian(z, sheets.ballistic_radius(z, middle, nozzle.swirl), length)
    free = ballistic(case, length)
    other = holes(free, spacing, nozzle, length)
    return measured(case, seen, length) | {
        "half_angle_ballistic_deg": math.degrees(straight),
        "break_up_length_ballistic_m": slant(nozzle) * break_up(free, spacing),
        **{named(name, "ballistic"): value for name, value in other.items()},
    }


def torn(case, middles) -> dict[str, float]:
    """Summary of holes: mean way [m] along the path from the mouth to where they opened, middles (M, 3) [m]; nan of
    none."""
    nozzle = nozzle_of(case)
    found = slant(nozzle) * about_axis(nozzle, middles)[:, 2]
    return {"holes_way_m": float(found.mean()) if len(found) else math.nan}
