"""The outlet of a tank as it works: which particles lose mass, and what leaves with them."""

from __future__ import annotations

import numpy as np

from sdph import particles
from sdph.effects import drain

ROUND_OFF = 1e-12  # of a particle's mass: less than that is nothing


class Outlet:
    """Takes from a stepper's liquid what is commanded; sums up what has gone: mass, momentum, angular momentum."""

    KEPT = ("place", "gone")  # see sdph.restart

    def __init__(self, stepper):
        case = stepper.case
        self.stepper, self.form = stepper, drain.FORMS[stepper.p["drain"].form] if stepper.p["drain"] else drain.FORMS[0]
        self.particle = float(stepper.state.mass[stepper.active].max())
        self.fill = next((pool.fill for pool in case.pools.values() if pool.fill), 1.0)
        self.place = np.zeros(3)  # where the last of it went [m]
        self.gone = np.zeros(7)  # mass [kg], momentum (3) [kg m/s], angular momentum (3) [kg m2/s], in the frame

    def command(self, fill: float) -> None:
        """Takes out what is left of the command that the tank be filled to `fill`, as far as there is liquid."""
        owed = (self.fill - fill) * self.stepper.capacity - self.gone[0]
        if self.form == "paper":
            owed = self.particle * np.floor(owed / self.particle + 0.5)
        while owed > ROUND_OFF * self.particle and len(self.stepper.active):
            owed -= self._take(owed)

    def _take(self, owed: float) -> float:
        """Mass [kg] taken out of the lowest particle, `owed` at most."""
        st = self.stepper
        s = st.state
        i = st.active[np.argmin(particles.axes(s)[-1][st.active])]
        taken = min(owed, float(s.mass[i]))
        velocity, place = particles.velocities(s)[i], particles.positions(s)[i]
        self.place = place
        self.gone += np.concatenate(([taken], taken * velocity, taken * np.cross(place, velocity)))
        if s.mass[i] - taken <= ROUND_OFF * self.particle:
            st.remove(i)
        else:
            s.mass[i] -= taken
        return taken
