"""The front of the column that collapses in air against the measurements of the dam break, and what the air does."""

from __future__ import annotations

import numpy as np

from sdph.engine.state import GAS
from sdph.study import compare
from sdph.study.compare import check

FRONT = "liquid_largest_x_m"  # column of the history
LATTICE, VOID = 0.5**0.5, 1.0  # spacings from a place to the next particle: at most on a lattice; where one fits in
DENSITY = 0.01  # of the air's, what a sound speed of ten times the fastest flow allows (Monaghan 1994)


def metrics(run) -> dict:
    """Values for `sdph cost`: (value, reference, scale)."""
    return compare.scene_module("dam_break").metrics(run, FRONT)


def exact(run) -> list[dict]:
    dry = compare.scene_module("dam_break")
    spacing, size = run.case.resolution.spacing, np.array(run.case.domain.size)
    _, points, _ = run.fields(run.summary["time_s"])
    places, gas = points.points[:, :2], points["kind"] == GAS
    outside = ((places < 0.0) | (places > size)).any(axis=1).sum()
    widest, density = _widest(places, size, spacing), points["density"][gas] / run.case.gas_phase.density
    return [
        *dry.within_scatter(dry.fronts(run, FRONT)),
        check("particles that have left the channel", outside, 0.0, 0.0),
        check("density of the air over that at rest, least", density.min(), 1.0, DENSITY),
        check("voids: largest distance to the next particle, spacings", widest, LATTICE, VOID - LATTICE),
    ]


def _widest(places, size, spacing: float) -> float:
    """Largest distance [spacings] from a point of the channel to the nearest particle; 0.7 on a lattice."""
    from scipy.spatial import cKDTree

    ticks = [np.arange(0.5 * spacing, length, 0.5 * spacing) for length in size]
    nodes = np.stack(np.meshgrid(*ticks), axis=-1).reshape(-1, 2)
    return float(cKDTree(places).query(nodes)[0].max() / spacing)
