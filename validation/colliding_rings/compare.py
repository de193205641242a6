"""Two elastic rings that collide: they bounce without a crack, and keep momentum and energy."""

from __future__ import annotations

import numpy as np

from sdph.study.compare import check

ENERGY = 0.1  # that may be lost: the bar
MOMENTUM = 1e-12  # of that of one ring
APART = 3.0  # stretch of a link, over that at the start, that none reaches without a crack; our choice


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
    """Largest distance of a particle at the end from the one next to it along its ring, over that at the start."""
    first, last = (run.fields(time)[1] for time in (0.0, run.case.run.end_time))
    places = [np.asarray(cloud.points)[np.argsort(np.asarray(cloud["ident"]))] for cloud in (first, last)]
    near = np.linalg.norm(np.diff(places[0], axis=0), axis=1) < 1.5 * run.case.resolution.spacing
    steps = [np.linalg.norm(np.diff(own, axis=0), axis=1)[near] for own in places]
    return float((steps[1] / steps[0]).max())


def exact(run) -> list[dict]:
    left = run.history["left_velocity_x_m_s"]
    return [
        check("left ring flies back", float(left[-1] < 0.0 < left[0]), 1.0, 0.0),
        check("largest stretch between neighbours", furthest(run), 1.0, APART - 1.0),
        check("momentum over that of one ring, largest", momentum(run), 0.0, MOMENTUM),
        check("energy lost", lost(run), 0.0, ENERGY),
    ]
