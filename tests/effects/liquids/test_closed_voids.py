"""A closed void pushes the liquid around it nowhere: whatever its shape, and whatever drifts in it."""

import math

import numpy as np
import pytest
from test_restart import Cut, Reporter

from sdph.case import read as cases
from sdph.engine import state as particles
from sdph.methods.liquids import closed, rooms
from sdph.running import balances, driver
from sdph.running.alone import Alone

MIDDLE, SPACING, END = 1e-3, 2e-5, 2e-6  # m, s
LARGE, SMALL, EXCESS = 1.6e-4, 1.2e-4, 1e3  # m, Pa
SIDE = 4e-5  # m from the place where they touch to the middle of the droplet


def case_of(gap: float = 0.0):
    """Two bubbles of gas, a `gap` [m] between them, in a disc of gel."""
    middles = [[MIDDLE + SIDE - LARGE, MIDDLE], [MIDDLE + SIDE + SMALL + gap, MIDDLE]]
    return cases.from_table({
        "dimensions": 2, "effects": ["density_diffusion", "bubble"],
        "run": {"end_time_s": END, "output_interval_s": END, "checkpoint_windows": 1},
        "domain": {"size_m": [2e-3, 2e-3], "gravity_m_s2": [0.0, 0.0]},
        "resolution": {"spacing_mm": 1e3 * SPACING, "smoothing_ratio": 1.3},
        "liquid": {"density_kg_m3": 1500.0, "sound_speed_m_s": 100.0, "history_interval_s": 0.1 * END},
        "pools": {"gel": {"shape": "disc", "centre_m": [MIDDLE, MIDDLE], "radius_m": 5e-4}},
        "bubble": {"centres_m": middles, "radii_m": [LARGE, SMALL], "around_Pa": 1e5, "excess_Pa": EXCESS},
    })  # fmt: skip


def merged(shreds: int) -> Alone:
    """A droplet whose bubbles are one void, in which shreds of the film between them drift: particles taken from the
    middle of the gel, one from each place."""
    run = Alone(case_of(), None)
    run.start()
    run.window()
    s, at = run.method.stepper.state, []
    for turn in np.linspace(2.0, 4.2, shreds):
        place = MIDDLE + 4.2e-4 * np.cos(turn), MIDDLE + 4.2e-4 * np.sin(turn)
        at.append(int(np.argmin(np.hypot(s.x - place[0], s.y - place[1]))))
    s.x[at] = MIDDLE + SIDE - 3.0 * SPACING
    s.y[at] = MIDDLE + SPACING * (np.arange(shreds) - 0.5)
    return run


def pushed(run) -> tuple[np.ndarray, np.ndarray]:
    """Places and forces (N, 2) by which bubbles push now."""
    stepper = run.method.stepper
    stepper.void.unclosed, stepper.void.pushed = np.zeros(2), 0.0
    stepper.forces(1.0)
    s = stepper.state
    return particles.positions(s)[:, :2], s.mass[:, None] * stepper.inflating[:, :2]


@pytest.mark.parametrize("shreds", [0, 4])
def test_a_void_of_any_shape_pushes_the_droplet_nowhere(shreds):
    """As rays told the face, shreds hid what is behind them: of 0.8 of the push, 0.09 were net."""
    run = merged(shreds)
    place, force = pushed(run)
    size = np.hypot(*force.T).sum()
    turning = (place[:, 0] * force[:, 1] - place[:, 1] * force[:, 0]).sum()
    assert np.hypot(*force.sum(axis=0)) < 1e-12 * size and abs(turning) < 1e-12 * size * LARGE
    void = run.method.stepper.void
    assert void.summary()["bubble_impulse_rel"] < balances.BARS["bubble_impulse_rel"]
    assert size == pytest.approx(void.pressure * 2.0 * math.pi * (LARGE + SMALL), rel=0.2)
    assert size == pytest.approx(np.hypot(*pushed(merged(0))[1].T).sum(), rel=0.05)


def test_a_lone_bubble_off_the_middle_pushes_the_droplet_nowhere():
    """Taken to be in the middle its push was 0.36 net, and 0.69 of what it is."""
    own = cases.to_table(case_of())
    own["bubble"] |= {"centres_m": [[MIDDLE + 2e-4, MIDDLE]], "radii_m": [LARGE]}
    run = Alone(cases.from_table(own), None)
    _, force = pushed(run)
    void = run.method.stepper.void
    assert np.hypot(*force.T).sum() == pytest.approx(void.pressure * 2.0 * math.pi * LARGE, rel=0.2)
    assert void.summary()["bubble_impulse_rel"] < balances.BARS["bubble_impulse_rel"]


def test_what_leaves_by_a_way_out_pushes_the_droplet():
    run = merged(4)
    run.method.stepper.void.left[0].width = SPACING
    _, force = pushed(run)
    assert np.hypot(*force.sum(axis=0)) > 1e-5 * np.hypot(*force.T).sum()
    assert run.method.stepper.void.summary()["bubble_impulse_rel"] == 0.0


def test_what_is_closed_has_no_sum_and_no_moment():
    rng = np.random.default_rng(1)
    place, force = rng.random((50, 2)), rng.normal(0.3, 1.0, (50, 2))
    taken, net, whole = closed.close(place, force)
    left = force - taken
    assert left.sum(axis=0) == pytest.approx([0.0, 0.0], abs=1e-12)
    assert (place[:, 0] * left[:, 1] - place[:, 1] * left[:, 0]).sum() == pytest.approx(0.0, abs=1e-12)
    assert net == pytest.approx(force.sum(axis=0)) and whole == pytest.approx(np.hypot(*force.T).sum())
    again, *_ = closed.close(place, left)
    assert again == pytest.approx(np.zeros((50, 2)), abs=1e-12)
    nothing, _, none = closed.close(place, np.zeros((50, 2)))
    assert not nothing.any() and none == 0.0


def test_faces_of_a_room_are_near_it_whatever_is_in_it():
    """A bent void, with a lone particle in it: its middle is in the liquid."""
    x, y = (axis.ravel().astype(float) for axis in np.meshgrid(np.arange(40), np.arange(40)))
    r, turn = np.hypot(x - 19.5, y - 19.5), np.arctan2(y - 19.5, x - 19.5)
    kept = (np.abs(r - 10.0) > 4.0) | (np.abs(turn) > 2.0)
    points = np.append(np.stack([x, y], axis=1)[kept], [[29.5, 19.5]], axis=0)
    found = rooms.find(points, np.ones(len(points)), 1.0)
    room = int(found.label[tuple(axis[0] for axis in found.at(np.array([[28.0, 23.0]])))])
    assert room and rooms.of(found, rooms.measure(found, room)[1], 1.0) == room
    depth, nearest = rooms.behind(found, [room], points)
    beside = np.abs(turn[kept]) < 1.8
    assert (nearest == room).all() and depth[:-1].min() > -0.9
    assert depth[:-1][beside] == pytest.approx(np.abs(r[kept] - 10.0)[beside] - 4.5, abs=1.0)


def test_bubbles_that_merge_are_told_of_once(tmp_path):
    told = []

    class Tells(Reporter):
        def status(self, text):
            told.append(text)

    with pytest.raises(Cut):
        driver.run(case_of(), "", tmp_path / "run", None, Tells(2))
    driver.resume(tmp_path / "run", (), Tells())
    assert [line for line in told if "merged" in line] == [
        line for line in told if line.endswith("bubble 2 has merged into bubble 1, which goes on with what both held")
    ]
    assert sum("merged" in line for line in told) == 1


def test_a_push_that_does_not_close_is_told():
    line = balances.missed({"bubble_impulse_rel": 0.08})
    assert len(line) == 1 and "resolution.spacing_mm" in line[0]
    assert not balances.missed({"bubble_impulse_rel": 1e-4})
