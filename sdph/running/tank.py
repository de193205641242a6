"""A tank of liquid for a spacecraft-dynamics loop that owns the time step, as the sloshing paper couples them.

    tank = Tank(case.load("case.toml"))
    force, moment = tank.advance(dt, acceleration, omega, omega_dot, fill)

All vectors are in axes fixed to the tank, its origin the origin of the case.
"""

from __future__ import annotations

import numpy as np
import scipy

from sdph.engine import state as particles
from sdph.methods.liquids.loads import loads
from sdph.methods.liquids.method import LiquidStepper
from sdph.methods.liquids.outlet import Outlet
from sdph.schema import CaseError

REST = (0.0, 0.0, 0.0)


class DrivenTank:
    """Liquid in a tank whose motion is given from outside."""

    def __init__(self, case):
        if case.liquid is None or "tank" not in case.effects:
            raise CaseError("a Tank needs a case with a [liquid] section and the effect tank")
        if case.incompressible:
            raise CaseError('a Tank is moved by weakly compressible SPH: leave method.name = "mps" out')
        case = case.only("liquid")
        if case.nozzles or "outflow" in case.effects:
            raise CaseError("a Tank is closed but for its drain: leave nozzles, inflow and outflow out")
        self.stepper = LiquidStepper(case)
        self.outlet = Outlet(self.stepper)
        self.time, self.wall_load = 0.0, np.zeros(6)

    def advance(self, dt: float, acceleration, omega=REST, omega_dot=REST, fill: float | None = None):
        """Takes the liquid through `dt` [s]; returns (force (3,) [N], moment (3,) [N m]) of the liquid on the craft.

        acceleration (3,) [m/s2] of the origin, gravity left out, held over `dt`; omega (3,) [rad/s] at the start,
        omega_dot (3,) [rad/s2] held; fill, commanded at the end. Force and moment are means over `dt` in the axes at
        its start, about the point where the origin was then (carried along with its velocity): what the momentum of the
        liquid has not gained (paper T, Eq. 16 and 17). `wall_load` holds the same summed over the pushes of the walls.
        """
        acceleration, omega, omega_dot = (np.asarray(v, float) for v in (acceleration, omega, omega_dot))
        stepper, before = self.stepper, self._momentum(np.eye(3), omega, np.zeros(3), np.zeros(3))
        gone, weight = self.outlet.gone.copy(), self._weight()
        stepper.move = lambda time: (acceleration, omega + omega_dot * (time - self.time), omega_dot)
        stepper.aim(self.time)
        stepper.forces()
        self._steps(dt, fill)
        rotation, gained = frame_step(acceleration, omega, omega_dot, dt)
        after = self._momentum(rotation, omega + omega_dot * dt, gained, 0.5 * dt * gained)
        left = self._left(self.outlet.gone - gone, rotation, omega, gained)
        self.time += dt
        impulse = before - after - left + 0.5 * dt * (weight + self._weight())
        return impulse[:3] / dt, impulse[3:] / dt

    def _steps(self, dt: float, fill) -> None:
        """Steps of the liquid through `dt`, the command met evenly on the way."""
        stepper, done, impulse = self.stepper, 0.0, np.zeros(6)
        filled = self.outlet.fill - self.outlet.gone[0] / stepper.capacity
        load = loads(stepper)
        while done < dt:
            step = stepper.step(dt - done)
            done = dt if step >= dt - done else done + step
            if fill is not None:
                self.outlet.command(filled + done / dt * (fill - filled))
            now = loads(stepper)
            impulse += 0.5 * step * (load + now)
            load = now
        stepper.time = self.time + dt
        self.wall_load = impulse / dt

    def _momentum(self, rotation, omega, velocity, moved) -> np.ndarray:
        """(6,) of the liquid in the axes at the start, `rotation` (3, 3) from the tank's, which has `velocity` and has
        `moved`."""
        s = self.stepper.state
        wet = particles.wet(s)
        r, v, m = particles.positions(s)[wet], particles.velocities(s)[wet], s.mass[wet, None]
        p = m * ((v + np.cross(omega, r)) @ rotation.T + velocity)
        return np.concatenate([p.sum(axis=0), np.cross(r @ rotation.T + moved, p).sum(axis=0)])

    def _left(self, gone, rotation, omega, gained) -> np.ndarray:
        """(6,) momentum that the mass `gone` (its momenta relative to the tank) took along, at the middle of the
        step."""
        mass, momentum, angular = gone[0], gone[1:4], gone[4:7]
        if mass == 0.0:
            return np.zeros(6)
        place = self.outlet.place
        p = rotation @ (momentum + mass * np.cross(omega, place)) + 0.5 * mass * gained
        return np.concatenate(
            [
                p,
                rotation @ (angular + mass * np.cross(place, np.cross(omega, place)))
                + np.cross(place, 0.5 * mass * gained),
            ]
        )

    def _weight(self) -> np.ndarray:
        """(6,) force and moment of gravity on the liquid, where the case has any."""
        gravity = np.array(self.stepper.p["gravity"] or (0.0, 0.0, 0.0))
        s = self.stepper.state
        wet = particles.wet(s)
        return np.concatenate([self.mass * gravity, np.cross(s.mass[wet] @ particles.positions(s)[wet], gravity)])

    @property
    def mass(self) -> float:
        """Mass of the liquid [kg]."""
        s = self.stepper.state
        return float(s.mass[particles.wet(s)].sum())

    def momentum(self, rotation, omega, velocity, place) -> np.ndarray:
        """(6,) momentum and angular momentum of the liquid in inertial axes, about their origin: `rotation` (3, 3) from
        the tank's axes, omega (3,) in the tank's, velocity and place (3,) of the tank's origin."""
        return self._momentum(rotation, omega, velocity, place)


def frame_step(acceleration, omega, omega_dot, dt: float) -> tuple[np.ndarray, np.ndarray]:
    """(rotation (3, 3) from the axes at the end to those at the start, gain of velocity (3,) in those at the start) of
    a frame whose acceleration and omega_dot are held over `dt` [s] in its own axes; second order in time."""
    turn = (np.asarray(omega) + 0.5 * dt * np.asarray(omega_dot)) * dt
    halfway = scipy.spatial.transform.Rotation.from_rotvec(0.5 * turn).as_matrix()
    return scipy.spatial.transform.Rotation.from_rotvec(turn).as_matrix(), halfway @ (np.asarray(acceleration) * dt)
