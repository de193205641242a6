"""The tear of a shell: when it began, when the bubble got a way out, and what goes through it.

Vapour vents through the way that flooding finds (sdph.methods.liquids.pores), gel goes by its own motion.
"""

from __future__ import annotations

import numpy as np

from sdph.engine import polygons
from sdph.engine.kept import Maybe


class Tear:
    """Tear of the shell of a run: time [s] of the first cut (None: not yet), D/D0 and angle [deg] then, time [s] from
    which vapour got out, and at which there was no bubble left."""

    KEPT = ("time", "ratio", "angle", "opened", "gone")
    FORMS = {"time": Maybe(0.0), "opened": Maybe(0.0), "gone": Maybe(0.0)}

    def __init__(self, run):
        self.run, self.time, self.ratio, self.opened, self.gone = run, None, 0.0, None, None
        self.angle = 0.0

    def look(self, time: float) -> None:
        """See whether the shell has torn, and its bubble has got a way out."""
        run = self.run
        if not run.bodies.torn:
            return
        if self.time is None:
            self.time, self.ratio, self.angle = time, run.diameter_ratio(), run.bodies.angle_of_loose()
        void = run.stepper.void
        if self.opened is None and (void.width > 0.0 or not void.held):
            self.opened = time
        if self.gone is None and not void.held:
            self.gone = time

    def jet(self) -> tuple[float, float]:
        """Mass [kg] of gel outside the shell, and its fastest speed [m/s]."""
        run = self.run
        if self.time is None:
            return 0.0, 0.0
        s, own = run.state, run.stepper.active
        points = run.bodies.hull()
        out = own[~polygons.holds(points[:, 0], points[:, 1], s.x, s.y)[own]]
        return float(s.mass[out].sum()), float(np.hypot(s.u[out], s.v[out]).max(initial=0.0))

    def row(self) -> dict[str, float]:
        mass, speed = self.jet()
        return {"tear_width_m": self.run.stepper.void.width, "jet_kg": mass, "jet_fastest_m_s": speed}

    def summary(self) -> dict[str, float]:
        mass, speed = self.jet()
        if self.time is None:
            return {"torn": False}
        told = {
            "torn": True,
            "tear_angle_deg": self.angle,
            "rupture_time_s": self.time,
            "rupture_diameter_ratio": self.ratio,
            "jet_kg": mass,
            "jet_fastest_m_s": speed,
            "vent_opened_s": self.opened,
            "bubble_gone_s": self.gone,
        }
        return {name: value for name, value in told.items() if value is not None}
