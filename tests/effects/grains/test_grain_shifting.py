"""Grains that come too close are parted; nothing else is moved."""

import numpy as np
import pytest
from grain_boxes import box, started

from sdph.effects.grains import grain_shifting


@pytest.fixture
def crowd(tmp_path):
    """Grains thrown about in a periodic box, some of them nearly on top of each other."""
    case = box(
        ["granular_pressure", "grain_shifting"],
        size=(0.1, 0.1),
        alpha_p=0.5,
        grains={"granular_temperature_m2_s2": 0.0},
    )
    stepper = started(case, tmp_path).stepper
    rng, s = np.random.default_rng(4), stepper.state
    for values, width in ((s.x, 3e-3), (s.y, 3e-3), (s.u, 0.5), (s.v, 0.5)):
        values += rng.uniform(-width, width, len(values))
    stepper.neighbours.built = ()
    stepper.prepare()
    return stepper


def moved(stepper, dt):
    out = np.empty((len(stepper.state.x), 3))
    grain_shifting.shift(
        stepper.parameters["grain_shifting"], stepper.state, stepper.rows, stepper.neighbours.box, dt, out
    )
    return out


def nearest(stepper):
    """Distance [m] of every particle to its nearest neighbour."""
    s, length = stepper.state, 0.1
    apart = np.stack([axis[:, None] - axis[None] for axis in (s.x, s.y)])
    apart -= length * np.rint(apart / length)
    return np.sort(np.sqrt((apart**2).sum(axis=0)), axis=1)[:, 1]


def test_the_centre_of_mass_stays(crowd):
    crowd.state.mass[:] *= np.linspace(0.5, 2.0, len(crowd.state.x))
    out = crowd.state.mass[:, None] * moved(crowd, 1e-3)
    assert np.abs(out).sum() > 0.0
    assert np.abs(out.sum(axis=0)).max() < 1e-14 * np.abs(out).sum()


def test_those_that_are_close_are_parted(crowd):
    before = nearest(crowd)
    out = moved(crowd, 2e-4)
    crowd.state.x[:] += out[:, 0]
    crowd.state.y[:] += out[:, 1]
    close = before < 2e-3
    assert close.any()
    assert (nearest(crowd)[close] > before[close]).mean() > 0.9


def test_grains_that_move_together_are_left(crowd):
    crowd.state.u[:], crowd.state.v[:] = 3.0, -1.0
    assert np.abs(moved(crowd, 1e-3)).max() == 0.0


def test_speed_counts_along_z_as_along_x(tmp_path):
    own = {"size": (0.05, 0.05, 0.05), "periodic": ("x", "y", "z"), "gravity": (0.0, 0.0, 0.0)}
    case = box(["granular_pressure", "grain_shifting"], **own)
    stepper, rng = started(case, tmp_path).stepper, np.random.default_rng(4)
    s = stepper.state
    for axis in (s.x, s.y, s.z):
        axis += rng.uniform(-3e-3, 3e-3, len(axis))
    stepper.neighbours.built = ()
    stepper.prepare()
    s, found = stepper.state, []
    for along in ("u", "w"):
        for axis in ("u", "v", "w"):
            getattr(s, axis)[:] = np.random.default_rng(5).uniform(-0.5, 0.5, len(s.x)) * (axis == along)
        found.append(moved(stepper, 1e-3))
    assert np.abs(found[0]).max() > 0.0
    np.testing.assert_allclose(found[1], found[0], rtol=1e-12)
