"""The cavity of a ring: its area, and the forces of a pressure in it.

The inner circle's particles stand half a layer behind the surface. Points of the surface are theirs less half of the
thickness that their area has along the ring; the pressure acts on the polygon of these points, so that its forces on a
closed ring add up to nothing.
"""

from __future__ import annotations

import numpy as np

from sdph.effects.solids import inflation


class Cavity:
    """Cavity of a ring with a pressure [Pa], an area [m2], and the outermost particles of the ring."""

    KEPT = ("pressure", "area")  # see sdph.engine.kept

    def __init__(self, parameters, circles, made):
        self.p, place = parameters, np.argsort(made.state.ident)
        self.nodes, self.outer = (place[circle] for circle in circles)
        self.volume = made.volume[self.nodes]
        self.pressure = 0.0
        self.first = self.area = _area(self._surface(made.state, np.ones(len(self.nodes))))

    def push(self, state, gradient, time: float, pressed) -> None:
        """Accelerations (N, 3) [m/s2] of the nodes by the pressure of now."""
        F = gradient[self.nodes]
        around = self._surface(state, F[:, 0] * F[:, 4] - F[:, 1] * F[:, 3])
        self.area = _area(around)
        self.pressure = inflation.pressure(self.p, time, self.area, self.first)
        chord = np.roll(around, -1, axis=0) - np.roll(around, 1, axis=0)
        outward = 0.5 * self.pressure * np.stack([chord[:, 1], -chord[:, 0]], axis=1)
        pressed[self.nodes, :2] = outward / state.mass[self.nodes, None]

    def _surface(self, state, jacobian) -> np.ndarray:
        """Points (M, 2) [m] of the surface, counterclockwise."""
        here = np.stack([state.x[self.nodes], state.y[self.nodes]], axis=1)
        chord = np.roll(here, -1, axis=0) - np.roll(here, 1, axis=0)
        length = 0.5 * np.hypot(*chord.T)
        outward = np.stack([chord[:, 1], -chord[:, 0]], axis=1) / (2.0 * length[:, None])
        return here - (0.5 * self.volume * jacobian / length)[:, None] * outward

    def diameter_ratio(self, state, reference) -> float:
        """Mean distance of the outermost particles from their middle, over that at the start."""
        return _radius(np.stack([state.x, state.y], axis=1)[self.outer]) / _radius(reference[self.outer, :2])

    def row(self) -> dict[str, float]:
        """Columns of history.csv."""
        return {"cavity_pressure_Pa": self.pressure, "cavity_area_m2": self.area}


def _radius(points) -> float:
    return float(np.hypot(*(points - points.mean(axis=0)).T).mean())


def _area(points) -> float:
    """Area [m2] of a polygon (M, 2)."""
    x, y = points.T
    return 0.5 * float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum())
