"""The void of a liquid, that of all its bubbles together.

Area within the outermost ring of the liquid, and half of that ring, less the area of the liquid, m/rho of all; in a
shell (`Carrier.shell`) within the shell's innermost ring, less half of that. What the polygon of the ring misses at the
start is taken off for good, so that the first void is that of the case.
"""

from __future__ import annotations

import numpy as np

from sdph.engine import polygons
from sdph.engine import state as particles
from sdph.laws.constants import SAME


class Hollow:
    """Area [m2] that the polygon misses, and its corners, where a shell's lining is the ring."""

    KEPT = ("missed", "corners")  # see sdph.engine.kept

    def __init__(self, state, centre, carrier, first: float):
        """Begin with a void [m2] in a liquid about a centre (2,) [m]; `carrier` is its shell, or None."""
        self.carrier = carrier
        x, y = state.x - centre[0], state.y - centre[1]
        r = np.where(particles.wet(state), np.hypot(x, y), 0.0)
        ring = np.flatnonzero((r > r.max() * (1.0 - SAME)) & (r > 0.0))
        self.loop = state.ident[ring][np.argsort(np.arctan2(y[ring], x[ring]))]  # counterclockwise
        self.missed, self.corners = 0.0, 0
        self.missed = self._measure(state) - first

    def area(self, state, before: float) -> float:
        """Void [m2] of the particles as they are; it was `before` when it was last measured."""
        corners, measured = self.corners, self._measure(state)
        if self.corners != corners:  # some broke off: another polygon, the same void
            self.missed = measured - before
        return measured - self.missed

    def _measure(self, state) -> float:
        """Area [m2] within the ring less that of the liquid; half of the ring's own stands outside the polygon."""
        volume = state.mass / state.density
        liquid = float(volume[particles.wet(state)].sum())
        if self.carrier:
            points, own = self.carrier.lining()
            self.corners = len(points)
            return polygons.area(*points.T) - 0.5 * own - liquid
        place = np.empty(int(state.ident.max()) + 1, np.int64)
        place[state.ident] = np.arange(len(state.ident))
        ring = place[self.loop]
        return polygons.area(state.x[ring], state.y[ring]) + 0.5 * float(volume[ring].sum()) - liquid
