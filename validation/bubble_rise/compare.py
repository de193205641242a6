"""The rising bubble against the finest of Hysing et al.'s grids: hysing_case1.csv, from the source that it names.

Weakly compressible: sound that the start sets off goes to and fro in the column, and the bubble's speed with it, by
1 to 5 %. Speeds are means over one period of that sound, 2 H/c; the reference is averaged likewise.
"""

from __future__ import annotations

from pathlib import Path

import contourpy
import numpy as np
from scipy.interpolate import CubicSpline
from scipy.spatial import cKDTree

from sdph.engine.state import GAS
from sdph.study.compare import check

SPEED, CENTRE, ROUND = 0.02, 0.02, 0.01  # liquids.md
FINE = 2  # grid points of the colour a spacing
NODES = 1024  # of the contour, evenly spaced


def reference() -> np.ndarray:
    """(P, 5) case, time [s], circularity, y of the centre [m], rise velocity [m/s]."""
    return np.loadtxt(Path(__file__).parent / "hysing_case1.csv", delimiter=",", comments="#", skiprows=3)


def circularity(points, case) -> tuple[float, float]:
    """(perimeter of the disc of the same area over that of the bubble, area [m2]) of the half contour of its colour.

    Waves shorter than the kernel is wide, 4 h, are single particles and are taken out.
    """
    spacing = case.resolution.spacing
    h = case.smoothing_length
    places, gas = points.points[:, :2], (points["kind"] == GAS).astype(float)
    low, high = places[gas > 0.0].min(axis=0) - 4.0 * spacing, places[gas > 0.0].max(axis=0) + 4.0 * spacing
    ticks = [np.arange(a, b, spacing / FINE) for a, b in zip(low, high)]
    nodes = np.stack(np.meshgrid(*ticks), axis=-1).reshape(-1, 2)
    pairs = cKDTree(nodes).sparse_distance_matrix(cKDTree(places), 2.0 * h, output_type="coo_matrix")
    q = pairs.data / h
    weight = np.maximum(0.0, 1.0 - 0.5 * q) ** 4 * (1.0 + 2.0 * q)  # Wendland C2
    total = np.bincount(pairs.row, weight, len(nodes))
    colour = np.bincount(pairs.row, weight * gas[pairs.col], len(nodes)) / np.maximum(total, 1e-300)
    lines = contourpy.contour_generator(*ticks, colour.reshape(len(ticks[1]), len(ticks[0]))).lines(0.5)
    x, y = _smooth(max(lines, key=len), 4.0 * h).T
    perimeter = np.hypot(np.diff(x), np.diff(y)).sum()
    area = 0.5 * abs(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]))
    return 2.0 * np.sqrt(np.pi * area) / perimeter, area


def _smooth(line, shortest: float) -> np.ndarray:
    """(P, 2) closed line (P, 2) [m] without its waves shorter than `shortest` [m]."""
    along = np.concatenate([[0.0], np.hypot(*np.diff(line, axis=0).T).cumsum()])
    even = np.arange(NODES) * along[-1] / NODES
    waves = np.fft.fft(np.interp(even, along, line[:, 0]) + 1j * np.interp(even, along, line[:, 1]))
    waves[np.abs(np.fft.fftfreq(NODES, 1.0 / NODES)) > along[-1] / shortest] = 0.0
    kept = np.fft.ifft(waves)
    return np.stack([kept.real, kept.imag], axis=1)[np.arange(NODES + 1) % NODES]


def metrics(run) -> dict:
    """Values for `sdph cost`: (value, reference, scale)."""
    rise, _, centre, _, roundness, _ = exact(run)
    chosen = {"largest rise velocity": rise, "height of the centre": centre, "smallest circularity": roundness}
    return {name: (row["value"], row["reference"], row["reference"]) for name, row in chosen.items()}


def exact(run) -> list[dict]:
    case, h, known = run.case, run.history, reference()
    period = 2.0 * case.domain.size[1] / case.liquid.sound_speed
    times = np.arange(period, min(h["time_s"][-1], known[-1, 1]) - 0.5 * period, 0.01)
    rise, expected = (
        _mean_speed(times, period, t, y) for t, y in ((h["time_s"], h["gas_centre_y_m"]), (known[:, 1], known[:, 3]))
    )
    shapes = [circularity(points, case) for points in (run.fields(t)[1] for t in _outputs(case, known))]
    roundness = np.array([shape[0] for shape in shapes])
    round_known = np.interp(_outputs(case, known), known[:, 1], known[:, 2])
    end = min(h["time_s"][-1], known[-1, 1])
    centre, centre_known = (
        np.interp(end, t, y) for t, y in ((h["time_s"], h["gas_centre_y_m"]), (known[:, 1], known[:, 3]))
    )
    return [
        check("largest rise velocity [m/s]", rise.max(), expected.max(), SPEED, True),
        check("rise velocity, worst of the run [m/s]", *_worst(rise, expected), SPEED * expected.max()),
        check("height of the centre in the end [m]", centre, centre_known, CENTRE, True),
        check("circularity, worst of the run", *_worst(roundness, round_known), ROUND),
        check("smallest circularity", roundness.min(), round_known.min(), ROUND),
        check("area in the end over that at the start", shapes[-1][1] / shapes[0][1], 1.0, 0.01),
    ]


def _outputs(case, known) -> np.ndarray:
    """Times at which there are fields, the start left out: a disc on a lattice is not round yet."""
    return (
        np.arange(1, round(min(case.run.end_time, known[-1, 1]) / case.run.output_interval) + 1)
        * case.run.output_interval
    )


def _mean_speed(times, period: float, t, y) -> np.ndarray:
    """Mean of dy/dt over `period` around each of `times`."""
    height = CubicSpline(t, y)
    return (height(times + 0.5 * period) - height(times - 0.5 * period)) / period


def _worst(values, expected) -> tuple[float, float]:
    """Places where the two are furthest apart."""
    k = np.argmax(np.abs(values - expected))
    return values[k], expected[k]
