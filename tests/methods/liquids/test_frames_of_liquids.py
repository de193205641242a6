"""The same motion seen from an inertial frame and from one that moves along."""

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from sdph.case import read as cases
from sdph.engine import state as particles
from sdph.methods.liquids.loads import loads
from sdph.methods.liquids.method import LiquidStepper
from sdph.methods.liquids.walls import WallP

G = 9.81  # m/s2
SHAKE, OMEGA = 0.02, 5.0  # m, rad/s


class MovingWalls(LiquidStepper):
    """A tank that goes along x by SHAKE (1 - cos(OMEGA t)), seen from outside."""

    def aim(self, time: float) -> None:
        super().aim(time)
        self._walls_at(time)

    def _drift(self, dt: float) -> None:
        super()._drift(dt)
        before, self.moved = self.moved, self.moved + dt
        self.state.x[self.state.kind == particles.WALL] += SHAKE * (
            math.cos(OMEGA * before) - math.cos(OMEGA * self.moved)
        )
        self._walls_at(self.moved)

    def _walls_at(self, time: float) -> None:
        velocity, acceleration = SHAKE * OMEGA * math.sin(OMEGA * time), SHAKE * OMEGA**2 * math.cos(OMEGA * time)
        self.wall = WallP(velocity, 0.0, 0.0, acceleration, 0.0, 0.0, *self.wall[6:])

    moved = 0.0


def box(kind, *effects, **sections) -> LiquidStepper:
    own = kind(cases.from_table({
        "dimensions": 2, "effects": ["gravity", "density_diffusion", "liquid_damping", "tank", *effects],
        "run": {"end_time_s": 1.0, "output_interval_s": 1.0},
        "domain": {"size_m": [0.6, 0.5], "gravity_m_s2": [0.0, -G]}, "resolution": {"spacing_mm": 20.0},
        "liquid": {"density_kg_m3": 1000.0, "sound_speed_m_s": 18.0},
        "tank": {"slip": "free_slip", "open_sides": ["top"]},
        "pools": {"water": {"shape": "box", "lower_m": [0.0, 0.0], "upper_m": [0.6, 0.3]}},
    } | sections))  # fmt: skip
    return own


def test_forces_are_the_same_from_outside_and_from_the_tank():
    shake = [[0, -SHAKE, OMEGA, 0.5 * math.pi]]  # less SHAKE cos, whose acceleration is that of MovingWalls
    inside, outside = box(LiquidStepper, "frame", frame={"shake": shake}), box(MovingWalls)
    history = []
    for k in range(1, 81):
        row = []
        for own in (inside, outside):
            impulse, before = np.zeros(3), loads(own)[:3]
            while own.time < 0.01 * k - 1e-12:
                dt = own.step(0.01 * k - own.time)
                now = loads(own)[:3]
                impulse, before = impulse + 0.5 * dt * (before + now), now
            row.append(impulse / 0.01)
        history.append(row)
    from_tank, from_outside = np.array(history).transpose(1, 0, 2)
    assert np.abs(from_tank[:, 0]).max() > 50.0  # N per metre of depth
    for axis in (0, 1):
        size = np.sqrt((from_tank[:, axis] ** 2).mean())
        assert np.sqrt(((from_tank - from_outside)[:, axis] ** 2).mean()) < 0.01 * size


@pytest.mark.parametrize("turn", [(0.0, 0.0, 1.5), (0.6, -0.9, 0.4)])
@pytest.mark.parametrize(
    ("gravity", "turns"), [((0.0, 0.0, 0.0), "space"), ((2.0, -9.81, 1.0), "space"), ((2.0, -9.81, 1.0), "tank")]
)
def test_free_liquid_flies_the_same_way_seen_from_a_turning_frame(turn, gravity, turns):
    """Omega, Coriolis and the centrifugal force are what makes a straight flight one; gravity keeps its direction in
    space, or turns along as thrust does: the same flight then only if the other one's gravity turns with it."""
    effects = ["density_diffusion", "liquid_damping", "gravity"]
    table = {
        "dimensions": 3, "effects": effects,
        "run": {"end_time_s": 1.0, "output_interval_s": 1.0},
        "domain": {"size_m": [1.0, 1.0, 1.0], "gravity_m_s2": list(gravity)}, "resolution": {"spacing_mm": 50.0},
        "liquid": {"density_kg_m3": 1000.0, "sound_speed_m_s": 10.0},
        "pools": {"drop": {"shape": "box", "lower_m": [0.2, 0.3, 0.1], "upper_m": [0.45, 0.55, 0.35],
        "velocity_m_s": [1.0, 0.5, -0.3]}},
    }  # fmt: skip
    turning = table | {"effects": [*effects, "frame"], "frame": {"spin_rad_s": list(turn), "gravity": turns}}
    still, turned = (LiquidStepper(cases.from_table(t)) for t in (table, turning))
    omega, end = np.array(turn), 0.2
    for axis, column in zip(
        (turned.state.u, turned.state.v, turned.state.w), np.cross(omega, particles.positions(turned.state)).T
    ):
        axis -= column
    turned.forces()
    for own in (still, turned):
        while own.time < end:
            own.step(min(5e-4, end - own.time))
    place = [particles.positions(own.state)[np.argsort(own.state.ident)] for own in (still, turned)]
    back = Rotation.from_rotvec(omega * end).apply(place[1])
    off = np.linalg.norm(place[0] - back, axis=1).max() / np.linalg.norm(place[1] - place[0], axis=1).max()
    assert off > 0.01 if turns == "tank" else off < 1e-5


def test_the_pressure_of_a_wall_knows_no_coriolis_force():
    """A wall stands still in its frame: what velocity it takes over from the liquid presses nothing on it."""
    own = box(LiquidStepper, "frame", frame={"spin_rad_s": [0.0, 0.0, 3.0]})
    wall, pressed = own.state.kind == particles.WALL, []
    for speed in (0.0, 2.0):
        own.state.u[wall], own.state.v[wall] = speed, -speed
        own.forces()
        pressed.append(own.pressure[wall].copy())
    assert pressed[0].max() > 1000.0
    np.testing.assert_array_equal(*pressed)
