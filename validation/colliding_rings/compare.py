"""Two elastic rings that collide: they bounce without a crack, and keep momentum and energy."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from sdph.show import timeline
from sdph.study.compare import check

ENERGY = 0.1  # that may be lost: the bar
NEXT = 1.5  # spacings to a neighbour, across the square of four too
MOMENTUM = 1e-12  # of that of one ring
# stretch of a link over its length at the start, half way to where one more particle fits in; our choice. A kernel
# reaches over 2.6 spacings: a crack is open long before its two sides no longer feel each other
APART = 1.5


def metrics(run) -> dict:
    """Values for `sdph cost`: (value, reference, scale)."""
    bounced = -run.history["left_velocity_x_m_s"][-1] / run.history["left_velocity_x_m_s"][0]
    return {"velocity after over before": (bounced, 1.0, 1.0), "energy lost": (lost(run), 0.0, 1.0)}


def lost(run) -> float:
    """Share of the energy that is neither motion nor strain at the end."""
    whole = run.history["kinetic_energy_J"] + run.history["elastic_energy_J"]
    return 1.0 - whole[-1] / whole[0]


def momentum(run) -> float:
    """Largest sum of both rings' momentum over that of one."""
    ledger = run.ledger
    own = 0.5 * ledger["mass_kg"][0] * abs(run.history["left_velocity_x_m_s"][0])
    return float(np.hypot(ledger["momentum_x_kg_m_s"], ledger["momentum_y_kg_m_s"]).max() / own)


def furthest(run) -> float:
    """Largest distance at any output between two that are neighbours at the start, within 1.5 spacings of each other in
    whatever direction, over that at the start."""
    first, *later = (_places(run.fields(time)[1]) for time in timeline.read(run.folder).time_values)
    pairs = cKDTree(first).query_pairs(NEXT * run.case.resolution.spacing, output_type="ndarray")
    before, *after = (np.linalg.norm(np.subtract(*own[pairs.T]), axis=1) for own in (first, *later))
    return float(np.max([own / before for own in after]))


def _places(cloud) -> np.ndarray:
    """(N, 3) places [m] in the order of the particles' numbers."""
    return np.asarray(cloud.points)[np.argsort(np.asarray(cloud["ident"]))]


def exact(run) -> list[dict]:
    left = run.history["left_velocity_x_m_s"]
    return [
        check("left ring flies back", float(left[-1] < 0.0 < left[0]), 1.0, 0.0),
        check("largest stretch between neighbours", furthest(run), 1.0, APART - 1.0),
        check("momentum over that of one ring, largest", momentum(run), 0.0, MOMENTUM),
        check("energy lost", lost(run), 0.0, ENERGY),
    ]
