"""The front of the column that collapses in air against the measurements of the dam break, and what the air does."""

from __future__ import annotations

import numpy as np

from sdph.engine.state import GAS
from sdph.study import compare
from sdph.study.compare import check

FRONT = "liquid_largest_x_m"  # column of the history


def metrics(run) -> dict:
    """Values for `sdph cost`: (value, reference, scale)."""
    return compare.scene_module("dam_break").metrics(run, FRONT)


def exact(run) -> list[dict]:
    dry = compare.scene_module("dam_break")
    spacing, size = run.case.resolution.spacing, np.array(run.case.domain.size)
    _, points, _ = run.fields(run.summary["time_s"])
    places, gas = points.points[:, :2], points["kind"] == GAS
    outside = ((places < 0.0) | (places > size)).any(axis=1).sum()
    density = points["density"][gas] / run.case.gas_phase.density
    return [
        *dry.within_scatter(dry.fronts(run, FRONT)),
        check("particles that have left the channel", outside, 0.0, 0.0),
        check("density of the air over that at rest, least", density.min(), 1.0, 0.1),
        check("voids: largest distance to the next particle, spacings", _widest(places, size, spacing), 1.0, 1.0),
    ]


def _widest(places, size, spacing: float) -> float:
    """Largest distance [spacings] from a point of the channel to the nearest particle; 0.7 on a lattice."""
    from scipy.spatial import cKDTree

    ticks = [np.arange(0.5 * spacing, length, 0.5 * spacing) for length in size]
    nodes = np.stack(np.meshgrid(*ticks), axis=-1).reshape(-1, 2)
    return float(cKDTree(places).query(nodes)[0].max() / spacing)
