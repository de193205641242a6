"""Measures by which a hard case of a liquid is judged."""

from __future__ import annotations

import numpy as np

from sdph.effects.around import tank
from sdph.engine import state as particles
from sdph.study.stress.measures import Extremes

LOST = 1.0  # spacings behind the surface of a wall: past the first of its layers, half a spacing deep; our choice


class LiquidMeasures(Extremes):
    """Measures of a liquid and its tank."""

    def window(self, simulation) -> None:
        """Take the figures after a window."""
        stepper, own = simulation.stepper, simulation.stepper.active
        s = particles.take(stepper.state, own)
        speed2 = (particles.velocities(s) ** 2).sum(axis=1)
        self._take("speed_m_s", np.sqrt(speed2))
        self._take("density_ratio", self._density(stepper, own))
        self._take("pressure_Pa", stepper.pressure[own])
        energy = float(0.5 * (s.mass * speed2).sum())
        self._take("kinetic_energy_J", np.array([energy]))
        self.last = {
            "particles": len(own),
            "kinetic_energy_end_J": energy,
            "speed_end_m_s": float(np.sqrt(speed2.max(initial=0.0))),
        }
        self.last |= {"windows": simulation.windows, "particle_mass_kg": float(s.mass.sum())}
        depth = self._behind_walls(s) / self.case.resolution.spacing
        self._take("spacings_into_walls", depth)
        self.lost = max(self.lost, int((depth > LOST).sum()))

    def _density(self, stepper, own) -> np.ndarray:
        """(N,) density over that at rest; of moving particles the number density over the lattice's."""
        if self.case.incompressible:
            return stepper.number[own] / stepper.cloud.number
        return stepper.state.density[own] / stepper.fluids[0, stepper.state.kind[own]]

    def _behind_walls(self, s) -> np.ndarray:
        """Depth [m] behind its surface of each particle that is out of the tank, but not through an open side."""
        if "tank" not in self.case.effects:
            return np.zeros(0)
        shape, points = tank.shape_of(self.case), particles.positions(s)[:, : self.case.dimensions]
        depth = shape.distance(points)
        held = depth > 0.0
        for axis, end in getattr(shape, "open", ()):
            held &= points[:, axis] <= shape.upper[axis] if end else points[:, axis] >= shape.lower[axis]
        return depth[held]
