"""The attitude of a frame that turns, from its angular velocity."""

from __future__ import annotations

import math

import numpy as np
from scipy.spatial.transform import Rotation

GAUSS = 0.5 / math.sqrt(3.0)  # of a step, from its middle: where two values are taken (Gauss & Legendre)


class Attitude:
    """Rotation (3, 3) from the axes of a frame to those that it had at t = 0.

    dR/dt = R [omega x], omega (3,) [rad/s] in the frame's own axes, in even steps by the expansion of Magnus with two
    values (Blanes et al. 2009, Phys. Rep. 470, 151, Eq. 253: fourth order, a rotation always). Steps begin at 0, so
    that the answer does not depend on who asked before: a run that goes on finds the same.
    """

    def __init__(self, omega, step: float):
        self.omega, self.step = omega, step
        self.known = [Rotation.identity()]

    def at(self, time: float) -> np.ndarray:
        """R at `time` [s]."""
        number = int(time / self.step)
        while len(self.known) <= number:
            begun = (len(self.known) - 1) * self.step
            self.known.append(self.known[-1] * self._turn(begun, self.step))
        begun = number * self.step
        return (self.known[number] * self._turn(begun, time - begun)).as_matrix()

    def _turn(self, begun: float, dt: float) -> Rotation:
        middle, apart = begun + 0.5 * dt, GAUSS * dt
        first, second = self.omega(middle - apart), self.omega(middle + apart)
        return Rotation.from_rotvec(
            0.5 * dt * (first + second) + math.sqrt(3.0) / 12.0 * dt**2 * np.cross(first, second)
        )
