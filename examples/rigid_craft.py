"""A rigid craft with a tank of liquid, free in space: the craft's loop owns the time step and asks the tank for its
loads.

    python examples/rigid_craft.py

What the liquid gives in one step the craft takes in the next: an impulse is `owed` between them. Momentum and angular
momentum of craft, liquid and what is owed stay as they were to round-off.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from scipy.spatial.transform import Rotation

from sdph.case import read as cases
from sdph.running.tank import DrivenTank

CASE = {
    "title": "Tank of a rigid craft",
    "dimensions": 3,
    "effects": ["density_diffusion", "liquid_damping", "frame", "tank"],
    "run": {"end_time_s": 1.0, "output_interval_s": 1.0},
    "domain": {"size_m": [1.0, 1.0, 1.0], "gravity_m_s2": [0.0, 0.0, 0.0]},
    "resolution": {"spacing_mm": 60.0},
    "liquid": {"density_kg_m3": 1000.0, "sound_speed_m_s": 10.0},
    "tank": {"shape": "sphere", "centre_m": [0.2, 0.0, 0.5], "radius_m": 0.3, "slip": "free_slip"},
    "pools": {"propellant": {"shape": "tank", "fill": 0.4}},
}


@dataclass
class Craft:
    """Mass [kg], tensor of inertia [kg m2] in its own axes; place, velocity, attitude (quaternion), angular
    velocity."""

    mass: float
    inertia: np.ndarray
    place: np.ndarray = field(default_factory=lambda: np.zeros(3))
    velocity: np.ndarray = field(default_factory=lambda: np.zeros(3))
    attitude: Rotation = field(default_factory=Rotation.identity)
    omega: np.ndarray = field(default_factory=lambda: np.zeros(3))  # in its own axes

    def momentum(self) -> np.ndarray:
        """(6,) momentum and angular momentum about the inertial origin."""
        p = self.mass * self.velocity
        return np.concatenate([p, np.cross(self.place, p) + self.attitude.apply(self.inertia @ self.omega)])

    def step(self, dt: float, impulse: np.ndarray):
        """Takes an impulse (6,), about the inertial origin, in the course of `dt`; returns the acceleration and
        omega_dot (3,) in its own axes by which the frame goes the same way."""
        change = impulse[:3] / self.mass
        place = self.place + dt * (self.velocity + 0.5 * change)
        orbital = np.cross(place, self.mass * (self.velocity + change)) - np.cross(
            self.place, self.mass * self.velocity
        )
        spin = self.attitude.apply(self.inertia @ self.omega) + impulse[3:] - orbital
        omega = self.omega
        for _ in range(30):  # the attitude at the end depends on omega at the end: a fixed point
            attitude = self.attitude * Rotation.from_rotvec(0.5 * dt * (self.omega + omega))
            omega = np.linalg.solve(self.inertia, attitude.inv().apply(spin))
        omega_dot = (omega - self.omega) / dt
        halfway = self.attitude * Rotation.from_rotvec(0.25 * dt * (self.omega + omega))
        acceleration = halfway.inv().apply(change / dt)
        before, self.place, self.velocity, self.attitude, self.omega = (
            self.omega,
            place,
            self.velocity + change,
            attitude,
            omega,
        )
        return acceleration, before, omega_dot


def coupled(craft: Craft, tank: DrivenTank, dt: float, steps: int, thrust=None):
    """Yields (time, craft, total (6,)) after each step; thrust (3,) [N] in the craft's axes, at its centre."""
    owed = np.zeros(6)
    liquid = liquid_momentum(craft, tank)
    for n in range(steps):
        given = np.zeros(6)
        if thrust is not None:
            given[:3] = craft.attitude.apply(thrust) * dt
            given[3:] = np.cross(craft.place, given[:3])
        start, before = craft.attitude, liquid
        acceleration, omega, omega_dot = craft.step(dt, owed + given)
        force, _ = tank.advance(dt, acceleration, omega, omega_dot)
        liquid = liquid_momentum(craft, tank)
        owed = before - liquid  # its first half is dt * force; the second is the moment about the inertial origin
        assert np.allclose(owed[:3], start.apply(dt * force), rtol=0.0, atol=1e-9 * tank.mass * dt)
        yield (n + 1) * dt, craft, craft.momentum() + liquid + owed


def liquid_momentum(craft: Craft, tank: DrivenTank) -> np.ndarray:
    """(6,) momentum of the liquid and its angular momentum about the inertial origin."""
    return tank.momentum(craft.attitude.as_matrix(), craft.omega, craft.velocity, craft.place)


def main() -> None:
    case = cases.from_table(CASE)
    craft = Craft(mass=400.0, inertia=np.diag([90.0, 120.0, 100.0]), omega=np.array([0.02, 0.05, 0.3]))
    tank = DrivenTank(case)
    first = None
    for time, moved, total in coupled(craft, tank, 0.01, 200):
        first = total if first is None else first
        if round(time * 100) % 20 == 0:
            print(
                f"t = {time:5.2f} s  omega = {np.round(moved.omega, 5)} rad/s  total changed by "
                f"{np.abs(total - first).max():.2e}"
            )


if __name__ == "__main__":
    main()
