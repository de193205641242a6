"""Grains through a window: forces that hold over it, and sums of its sub-steps."""

from __future__ import annotations

import numpy as np

from sdph import effects
from sdph.engine import arrays
from sdph.engine import state as particles
from sdph.engine.walls import parts
from sdph.methods.grains import account


class Windowed:
    """The part of the grains' stepper that begins and ends windows."""

    def force(self, warmth, push, damping) -> None:
        """Take what holds over the next window: heat (N,) [J] from the gas, push (N, 3) [m/s2] from outside, damping
        (N,) [1/s] of theta, of own particles; begin its account."""
        self.rows_before = len(warmth)
        held = (self.domain.with_room(own, self.state) for own in (warmth, push, damping))
        self.state = self.domain.marked(particles.followed(particles.forced(self.state, *held)))
        self.domain.refresh(*particles.pushes(self.state), *self._arrays())  # the exchange may have changed them
        self.account, self.touched = self._opened(), 0

    def _opened(self) -> account.Account:
        faces = len(self.hot.faces.x) if self.hot else 0
        return account.opened(len(self.boundary.dummies.x) if self.parts else 0, faces)

    def pushed(self) -> np.ndarray:
        """(n, 3, 3) of what has pushed the named parts of the walls since the window began
        (sdph.engine.walls.parts.gathered)."""
        if not self.parts:
            return np.zeros((0, 3, 3))
        felt, shares = self.world.sum(self.account.felt[0]), np.array(list(self.parts.values()))
        feet = self.boundary.feet
        return parts.gathered(feet, shares * felt[:, :3], feet, shares * felt[:, 3:])

    def release(self) -> tuple[np.ndarray, np.ndarray]:
        """End the window: way (N, 3) [m] of the particles in it, and what their theta lost to the gas (N,) [J], in the
        rows that they had when it began; 0 for those that were taken out since."""
        s = self.own
        damped = s.damped if len(s.damped) else arrays.zeros(len(s.x), s.x)
        moved = np.column_stack((particles.vectors(s.way_x, s.way_y, s.way_z), damped))
        before = arrays.zeros((self.rows_before, moved.shape[1]), s.x)
        for rows, back in self.domain.home(s.row, moved):
            before[rows] = back
        self.state = particles.released(self.state)
        self.contacts += self.world.sum(self.touched)
        return before[:, :3], before[:, 3]

    def tell(self) -> None:
        """See what limiters hold now, before rows are made anew."""
        self.domain.refresh(*self._arrays(self.MOVING))
        self.held = effects.held(self.parameters, self.case, self)
