"""What history.csv holds of each phase, where there are two."""

from __future__ import annotations

import numpy as np

from sdph.engine import state as particles
from sdph.engine.state import GAS, LIQUID


def columns(stepper) -> dict[str, float]:
    """Centre [m], velocity [m/s], variance of places [m2] and furthest place [m] of each phase along each axis; means by mass."""
    s, values = stepper.state, {}
    if stepper.case.gas_phase is None:
        return values
    for phase, kind in (("liquid", LIQUID), ("gas", GAS)):
        own = s.kind == kind
        if not own.any():
            continue
        mass, places, velocities = s.mass[own], particles.positions(s)[own], particles.velocities(s)[own]
        centre = mass @ places / mass.sum()
        for a, axis in enumerate("xyz"[: stepper.case.dimensions]):
            values[f"{phase}_centre_{axis}_m"] = float(centre[a])
            values[f"{phase}_velocity_{axis}_m_s"] = float(mass @ velocities[:, a] / mass.sum())
            values[f"{phase}_spread_{axis}_m2"] = float(mass @ (places[:, a] - centre[a]) ** 2 / mass.sum())
            values[f"{phase}_largest_{axis}_m"] = float(places[:, a].max())
        values[f"{phase}_fastest_m_s"] = float(np.sqrt((velocities**2).sum(axis=1).max()))
    return values
