"""Grains that begin so dense that lasting contacts press harder than their weight: a bed that bursts open."""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

from sdph.effects.grains import friction
from sdph.laws.granular import PACKING_MARGIN
from sdph.methods.grains import start

HALF_WEIGHT = 0.5  # of the weight on the floor: what contacts bear half-way up a bed at rest


def warnings(case) -> list[str]:
    """A line where grains of a region press harder at the start than all that may be above its floor does; none without
    lasting contacts or gravity."""
    gravity = np.array(case.domain.gravity)
    if "friction" not in case.effects or not gravity.any() or not case.particles:
        return []
    up = {name: np.sort(-gravity * start.extents(case, own), axis=0) for name, own in case.particles.items()}
    top = max(float(high.sum()) for _, high in up.values())  # J/kg
    own = {name: _calm(case, region, top - float(up[name][0].sum())) for name, region in case.particles.items()}
    told = {name: found for name, found in own.items() if found}
    if not told:
        return []
    name, (pressure, weight, calm) = next(iter(told.items()))
    more = f" (and {len(told) - 1} more regions)" if len(told) > 1 else ""
    return [
        f"particles.{name}{more} begins at volume_fraction = {case.particles[name].volume_fraction:g}, where lasting "
        f"contacts press with {pressure:.3g} Pa, and {weight:.3g} Pa weigh on its floor at most: it bursts open; begin "
        f"at {calm:.3f}, or set a higher friction.onset"
    ]


def _calm(case, region, potential: float) -> tuple[float, float, float] | None:
    """Pressure of contacts and of the weight on its floor [Pa], and the volume fraction at which they bear half of it,
    where a region begins denser than its weight holds it; `potential` [J/kg] of the highest grain over its floor."""
    p, density, given = friction.kernel(case), case.of(region.material).density, region.volume_fraction

    def excess(alpha_p: float, share: float) -> float:
        return friction.pressure(p, alpha_p)[0] - share * alpha_p * density * potential

    if excess(given, 1.0) <= 0.0:
        return None
    calm = brentq(excess, p.onset, p.packing - PACKING_MARGIN, args=(HALF_WEIGHT,))
    return friction.pressure(p, given)[0], given * density * potential, calm
