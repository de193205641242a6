"""The square patch against the exact pressure at its start, and its energy against itself."""

from __future__ import annotations

import numpy as np

from sdph.laws import liquids
from sdph.study.compare import check

PRESSURE, LOSS = 0.02, 0.02  # liquids.md
START = 0.1  # in units of 1/omega: the patch has turned by 6 degrees, sound has crossed it 0.7 times


def pressure(run) -> tuple[float, float]:
    """Pressure of the centre, mean of the start [Pa], and the exact."""
    case, pool, h = run.case, run.case.pools["patch"], run.history
    side = pool.upper[0] - pool.lower[0]
    omega = 2.0 * pool.speed / side
    middle = liquids.square_patch_pressure(np.array([[0.5 * side, 0.5 * side]]), side, omega, case.liquid.density)[0]
    early = (h["time_s"] > 0.0) & (h["time_s"] <= START / omega)
    return float(h["centre_pressure_Pa"][early].mean()), float(middle)


def metrics(run) -> dict:
    """Values for `sdph cost`: (value, reference, scale)."""
    energy = run.history["kinetic_energy_J"]
    return {
        "pressure of the centre": (*pressure(run), pressure(run)[1]),
        "energy kept": (energy[-1] / energy[0], 1.0, 1.0),
    }


def exact(run) -> list[dict]:
    pool, h, (found, middle) = run.case.pools["patch"], run.history, pressure(run)
    side = pool.upper[0] - pool.lower[0]
    omega = 2.0 * pool.speed / side
    energy = h["kinetic_energy_J"]
    momentum = np.hypot(h["momentum_x_kg_m_s"], h["momentum_y_kg_m_s"]).max()
    return [
        check("pressure of the centre, mean of the start [Pa]", found, middle, PRESSURE, True),
        check("kinetic energy in the end over its start", energy[-1] / energy[0], 1.0, LOSS),
        check("largest kinetic energy over its start", energy.max() / energy[0], 1.0, 0.005),
        check("momentum over m omega L", momentum / (h["mass_kg"][0] * omega * side), 0.0, 1e-3),
    ]
