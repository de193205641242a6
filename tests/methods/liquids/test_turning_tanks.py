"""A tank that turns ever faster about an axis beside it: forces on liquid and walls in its frame are those that an
observer at rest finds, before whom the walls move."""

import numpy as np
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from sdph.case import read as cases
from sdph.engine import state as particles
from sdph.methods.liquids import walls
from sdph.methods.liquids.method import LiquidStepper
from sdph.methods.liquids.walls import WallP, feel

GRAVITY, TIME, HARDEST = np.array([1.5, -2.0, -9.0]), 0.7, 1e-6  # m/s2, s, of the largest force: issue 17
FRAME = {
    "shake": [[0, 0.3, 2.0, 0.4], [1, 0.2, 3.0, 1.1], [2, 0.25, 1.5, 2.0]],
    "turn": [[0, 0.7, 1.3, 0.2], [1, 0.5, 2.1, 0.9], [2, 0.8, 1.7, 2.3]],
    "spin_rad_s": [0.4, -0.3, 1.5],
}
PLACE = np.array([3.0, -1.0, 2.0])  # m, of the frame's origin
SPEED = np.array([0.7, 0.2, -0.4])  # m/s, of it


def stepper(gravity, *effects, **sections) -> LiquidStepper:
    return LiquidStepper(cases.from_table({
        "dimensions": 3, "effects": ["gravity", "density_diffusion", "liquid_damping", "tank", *effects],
        "run": {"end_time_s": 1.0, "output_interval_s": 1.0},
        "domain": {"size_m": [0.4, 0.3, 0.4], "gravity_m_s2": list(gravity)}, "resolution": {"spacing_mm": 50.0},
        "liquid": {"density_kg_m3": 1000.0, "sound_speed_m_s": 20.0},
        "tank": {"slip": "free_slip", "suction": "full"},
        "pools": {"water": {"shape": "box", "lower_m": [0.0, 0.0, 0.0], "upper_m": [0.4, 0.3, 0.3]}},
    } | sections))  # fmt: skip


def columns(own, *names) -> np.ndarray:
    """(N, 3) of the state, in the order of the particles' numbers."""
    return np.stack([getattr(own.state, name) for name in names], axis=1)[np.argsort(own.state.ident)]


def put(own, values, *names) -> None:
    """The other way."""
    for name, column in zip(names, values.T):
        getattr(own.state, name)[np.argsort(own.state.ident)] = column


def shaken(own) -> None:
    """Velocities up to 2 m/s and densities that give pressures up to some kPa, of either sign."""
    rng, count = np.random.default_rng(3), len(own.state.x)
    wet = (own.state.kind != particles.WALL)[np.argsort(own.state.ident)]
    put(own, np.where(wet[:, None], rng.uniform(-1.0, 1.0, (count, 3)), 0.0), *"uvw")
    put(own, np.where(wet, 1000.0 * (1.0 + rng.uniform(-5e-3, 1e-2, count)), 1000.0)[:, None], "density")


def attitude(move) -> np.ndarray:
    """(3, 3) axes of the frame at TIME as columns, seen from rest: by their rates, apart from sdph.engine.attitude."""

    def rates(t, axes):
        return (axes.reshape(3, 3) @ np.cross(np.eye(3), move(t)[1])).ravel()

    found = solve_ivp(rates, (0.0, TIME), np.eye(3).ravel(), rtol=1e-12, atol=1e-13).y[:, -1].reshape(3, 3)
    return Rotation.from_matrix(found).as_matrix()


def seen_from_rest(own, motion, axes, monkeypatch) -> LiquidStepper:
    """The same liquid and walls as an observer at rest has them; each wall particle has its own motion there."""
    acceleration, omega, rate = motion
    other, r, u = stepper(GRAVITY), columns(own, *"xyz"), columns(own, *"uvw")
    u[columns(own, "kind")[:, 0] == particles.WALL] = 0.0  # as in its frame, not what it takes over from the liquid
    turned = np.cross(omega, r)
    pulled = acceleration + np.cross(rate, r) + np.cross(omega, turned)
    speed, pulled = SPEED + (u + turned) @ axes.T, pulled @ axes.T
    put(other, PLACE + r @ axes.T, *"xyz")
    put(other, speed, *"uvw")
    put(other, columns(own, "density"), "density")
    loop = walls.extrapolate

    def by_wall(kernel, s, rows, box, chosen, wall_p, *rest):
        for n in range(len(chosen)):
            k = np.searchsorted(np.sort(s.ident), s.ident[chosen[n]])
            loop(kernel, s, rows, box, chosen[n : n + 1], WallP(*speed[k], *pulled[k], *wall_p[6:]), *rest)

    monkeypatch.setattr(walls, "extrapolate", by_wall)
    other.forces()
    return other


def by_number(own, values) -> np.ndarray:
    """Rows of all particles in the order of their numbers."""
    return values[np.argsort(own.state.ident)]


def motion_of(own) -> tuple:
    """Acceleration of the frame's origin, angular velocity and its rate at TIME, along its axes; the axes."""
    axes = attitude(own.move)
    acceleration, omega, rate = own.move(TIME)
    return (acceleration + axes.T @ GRAVITY - GRAVITY, omega, rate), axes  # less what gravity has turned by


def alike(ours, theirs) -> None:
    np.testing.assert_allclose(ours, theirs, rtol=0.0, atol=HARDEST * np.abs(theirs).max())


def test_forces_in_a_frame_that_turns_faster_are_those_seen_from_rest(monkeypatch):
    """Accelerations of the liquid, by pressure of liquid and walls, damping, gravity and the frame; forces on walls."""
    own = stepper(GRAVITY, "frame", frame=FRAME)
    shaken(own)
    own.aim(TIME)
    own.forces()
    motion, axes = motion_of(own)
    felt = feel(own, own.walls, 0.0)[np.argsort(own.state.ident[own.walls]), :3]
    other = seen_from_rest(own, motion, axes, monkeypatch)
    theirs = feel(other, other.walls, 0.0)[np.argsort(other.state.ident[other.walls]), :3] @ axes
    wet, r, u = columns(own, "kind")[:, 0] != particles.WALL, columns(own, *"xyz"), columns(own, *"uvw")
    acceleration, omega, rate = motion
    euler = np.cross(rate, r)
    carried = acceleration + euler + np.cross(omega, np.cross(omega, r)) + 2.0 * np.cross(omega, u)
    ours, expected = by_number(own, own.acceleration)[wet], (by_number(other, other.acceleration) @ axes - carried)[wet]
    assert np.abs(axes - np.eye(3)).max() > 0.5 and np.abs(euler[wet]).max() > 0.005 * np.abs(ours).max()
    alike(ours, expected)
    alike(felt, theirs)
