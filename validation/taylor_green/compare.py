"""Decay of the vortices against the exact exp(-2 nu k^2 t)."""

from __future__ import annotations

import numpy as np

from sdph.laws import liquids
from sdph.study.compare import check

RATE = 0.01  # liquids.md


def decay(run) -> tuple[float, float, float]:
    """Rate of the energy's decay [1/s], the exact one, and the worst of the velocity over the exact less 1."""
    case, pool, h = run.case, run.case.pools["square"], run.history
    nu = case.liquid.viscosity / case.liquid.density
    length = pool.upper[0] - pool.lower[0]
    energy = h["kinetic_energy_J"] / h["kinetic_energy_J"][0]
    later = h["time_s"] > 0.0
    rate = np.polyfit(h["time_s"], np.log(energy), 1)[0]
    expected = np.array([liquids.taylor_green_decay(t, length, nu) ** 2 for t in h["time_s"]])
    worst = np.abs(np.sqrt(energy[later] / expected[later]) - 1.0).max()
    return float(rate), -4.0 * nu * (2.0 * np.pi / length) ** 2, float(worst)


def metrics(run) -> dict:
    """Values for `sdph cost`: (value, reference, scale)."""
    rate, expected, worst = decay(run)
    return {"rate of decay": (rate, expected, expected), "velocity": (worst, 0.0, 1.0)}


def drift(run) -> float:
    """Largest momentum of all, over the sum of m |v| in the end, when that is smallest."""
    h, (_, liquid, _) = run.history, run.fields(run.summary["time_s"])
    moved = np.asarray(liquid["mass"]) @ np.linalg.norm(np.asarray(liquid["velocity"]), axis=1)
    return float(np.hypot(h["momentum_x_kg_m_s"], h["momentum_y_kg_m_s"]).max() / moved)


def exact(run) -> list[dict]:
    rate, expected, worst = decay(run)
    return [
        check("rate of the energy's decay [1/s]", rate, expected, RATE, True),
        check("velocity over the exact, worst", worst, 0.0, RATE),
        check("momentum over sum m |v|", drift(run), 0.0, 1e-3),
    ]
