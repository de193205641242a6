"""The tear of a shell: when it began, the way out of the bubble, and what goes through it.

The way out is looked for on a grid of half a spacing, by filling it from outside: where that reaches the void, the void
is open, and the way is as wide as the widest thing that gets through (a threshold of the distance to what is in the
way). Vapour vents through it, gel goes by its own motion.
"""

from __future__ import annotations

import numpy as np
import scipy

from sdph.engine import polygons
from sdph.engine.kept import Maybe

COVER = 0.75  # spacings around a particle that it fills: neighbours close a lattice; our choice
HALVINGS = 8  # of the width of a way; our choice
MARGIN = 4.0  # spacings of air around all in the grid


class Tear:
    """Tear of the shell of a run: time [s] of the first cut (None: not yet), D/D0 and angle [deg] then, time [s] from
    which vapour got out, width [m] of the way out."""

    KEPT, FORMS = ("time", "ratio", "angle", "opened", "width"), {"time": Maybe(0.0), "opened": Maybe(0.0)}

    def __init__(self, run):
        self.run, self.time, self.ratio, self.opened, self.width = run, None, 0.0, None, 0.0
        self.angle = 0.0

    def look(self, time: float, passed: float) -> None:
        """See whether the shell has torn, and let vapour out for the `passed` [s]."""
        run = self.run
        if not run.bodies.torn:
            return
        if self.time is None:
            self.time, self.ratio, self.angle = time, run.diameter_ratio(), run.bodies.angle_of_loose()
        self.width = way_out(run)
        if self.width > 0.0:
            self.opened = time if self.opened is None else self.opened
            run.stepper.void.vent(passed, self.width)

    def gone(self) -> tuple[float, float]:
        """Mass [kg] of gel outside the shell, and its fastest speed [m/s]."""
        run = self.run
        if self.time is None:
            return 0.0, 0.0
        s, own = run.state, run.stepper.active
        points = run.bodies.hull()
        out = own[~polygons.holds(points[:, 0], points[:, 1], s.x, s.y)[own]]
        return float(s.mass[out].sum()), float(np.hypot(s.u[out], s.v[out]).max(initial=0.0))

    def row(self) -> dict[str, float]:
        mass, speed = self.gone()
        return {"tear_width_m": self.width, "jet_kg": mass, "jet_fastest_m_s": speed}

    def summary(self) -> dict[str, float]:
        mass, speed = self.gone()
        if self.time is None:
            return {"torn": False}
        told = {
            "torn": True,
            "tear_angle_deg": self.angle,
            "rupture_time_s": self.time,
            "rupture_diameter_ratio": self.ratio,
        }
        opened = {} if self.opened is None else {"vent_opened_s": self.opened}
        return told | {"jet_kg": mass, "jet_fastest_m_s": speed} | opened


def way_out(run) -> float:
    """Width [m] of the widest way from the void to the outside; 0 where the void is closed."""
    cell = 0.5 * run.case.resolution.spacing
    s, own = run.state, run.stepper.active
    bodies = run.bodies.places()[~run.bodies.loose(), :2]
    points = np.concatenate([np.stack([s.x[own], s.y[own]], axis=1), bodies, run.bodies.links()])
    corner = points.min(axis=0) - 2.0 * MARGIN * cell
    shape = tuple(np.ceil((points.max(axis=0) - corner) / cell + 2.0 * MARGIN).astype(int))
    return widest(room_of(points, corner, shape, cell), run.bodies.lining()[0], corner, cell)


def room_of(points, corner, shape, cell: float) -> np.ndarray:
    """Distance [m] of the cells of a grid to the nearest of points (N, 2) [m]."""
    empty = np.ones(shape, bool)
    empty[tuple(((points - corner) / cell).astype(int).T)] = False
    return cell * scipy.ndimage.distance_transform_edt(empty)


def widest(room, lining, corner, cell: float) -> float:
    """Width [m] of the widest way from the roomiest place within the lining (N, 2) [m] to the corner of the grid, less
    a spacing, two cells, of particles on its sides."""
    x, y = (corner[a] + cell * (np.arange(room.shape[a]) + 0.5) for a in (0, 1))
    X, Y = (grid.ravel() for grid in np.meshgrid(x, y, indexing="ij"))
    within = polygons.holds(lining[:, 0], lining[:, 1], X, Y).reshape(room.shape)
    inside = np.where(within, room, 0.0)
    deep = np.unravel_index(int(inside.argmax()), room.shape)
    low, high = COVER * 2.0 * cell, float(inside.max())
    if not _leads(room, low, deep):
        return 0.0
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if _leads(room, middle, deep) else (low, middle)
    return 2.0 * (low - cell)


def _leads(room, least: float, start) -> bool:
    """Tell whether a way that keeps a distance leads from a cell to the corner of the grid."""
    parts, _ = scipy.ndimage.label(room > least)
    return parts[start] != 0 and parts[start] == parts[0, 0]
