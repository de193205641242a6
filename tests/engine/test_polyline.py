"""Contact with a polyline: nothing passes between ends far apart, what one gets the other gives, energy comes back."""

import math

import numpy as np
import pytest

from sdph.engine import polyline
from sdph.engine.contact import Contact

SPACING, DENSITY, SOUND = 1.0e-5, 1500.0, 100.0
STIFFNESS, DISTANCE, MASS = DENSITY * SOUND**2, 0.5 * SPACING, DENSITY * SPACING**2
FAR = 2.5 * SPACING  # between the ends of a segment
ONE = np.array([[1, 2]])


def pressed(places, segments=ONE, bears=None, pairs=None, count=1):
    """Forces (N, 3) and energy of `count` particles, the first of `places` (N, 2), and segments of the others."""
    x, y = np.ascontiguousarray(places.T)
    bears = np.ones(len(segments), bool) if bears is None else np.asarray(bears)
    if pairs is None:
        pairs = np.array([(i, s) for i in range(count) for s in range(len(segments))])
    force = np.zeros((len(x), 3))
    return force, polyline.press(STIFFNESS, DISTANCE, x, y, segments, bears, pairs, force)


def chain(seed, count=40, corners=12):
    """Places of particles about a crooked closed chain, the chain's corners behind them; its segments."""
    rng = np.random.default_rng(seed)
    turn = 2.0 * math.pi * np.arange(corners) / corners
    around = FAR * corners / 6.0 * np.stack([np.cos(turn), np.sin(turn)], axis=1) * rng.uniform(0.7, 1.3, (corners, 1))
    last = np.roll(around, -1, axis=0)
    own, share = rng.integers(corners, size=count), rng.uniform(size=(count, 1))
    near = around[own] + share * (last - around)[own] + DISTANCE * rng.uniform(-1.0, 1.0, (count, 2))
    number = count + np.arange(corners)
    return np.concatenate([near, around]), np.stack([number, np.roll(number, -1)], axis=1)


def test_momentum_and_moment_close_by_the_lever_rule():
    places, segments = chain(1)
    force, energy = pressed(places, segments, count=40)
    size = np.abs(force).sum()
    assert energy > 0.0 and (np.abs(force[:40]).sum(axis=1) > 0.0).sum() > 20
    assert np.abs(force.sum(axis=0)).max() < 1e-14 * size
    moment = places[:, 0] @ force[:, 1] - places[:, 1] @ force[:, 0]
    assert abs(moment) < 1e-14 * size * np.abs(places).max()


def test_the_force_is_what_the_energy_falls_by():
    """For particles and ends alike, at corners too: central differences over a millionth of a spacing."""
    places, segments = chain(2)
    force, _ = pressed(places, segments, count=40)
    by = 1e-6 * SPACING
    for n in range(len(places)):
        for axis in (0, 1):
            moved = [places.copy(), places.copy()]
            moved[0][n, axis] += by
            moved[1][n, axis] -= by
            more, less = (pressed(own, segments, count=40)[1] for own in moved)
            assert force[n, axis] == pytest.approx(-(more - less) / (2.0 * by), abs=2e-5 * STIFFNESS * DISTANCE)


def gone(steps, push, bears=(True,), share=1.0):
    """Heights [spacings] of a particle that is pressed at the middle of a segment with held ends, by a share of the
    longest steps; its energies."""
    dt = share * Contact(DISTANCE, STIFFNESS).limit(MASS)
    places = np.array([[0.0, SPACING], [0.5 * FAR, 0.0], [-0.5 * FAR, 0.0]])
    speed, heights, whole = 0.0, [], []
    force, energy = pressed(places, bears=bears)
    for _ in range(steps):
        speed += 0.5 * dt * (force[0, 1] - push) / MASS
        places[0, 1] += dt * speed
        force, energy = pressed(places, bears=bears)
        speed += 0.5 * dt * (force[0, 1] - push) / MASS
        heights.append(places[0, 1] / SPACING)
        whole.append(0.5 * MASS * speed**2 + energy + push * places[0, 1])
    return np.array(heights), np.array(whole)


def test_what_is_pressed_at_the_middle_of_a_long_segment_does_not_pass():
    push = 150e3 * SPACING  # N, of 150 kPa on a face
    heights, whole = gone(2000, push)
    assert heights.min() > 0.25 and heights.min() < 0.5
    assert np.ptp(whole) < 0.05 * push * SPACING
    assert heights.max() < 1.05  # it does not gain by bouncing
    _, whole = gone(20000, push, share=0.1)
    assert np.ptp(whole) < 1e-3 * push * SPACING


def test_a_segment_that_is_cut_lets_pass():
    heights, _ = gone(2000, 150e3 * SPACING, (False,))
    assert heights.min() < -1.0


def test_at_a_corner_one_push_and_no_jump():
    """A corner of 90 degrees, seen from within and from without: as far from the chain, as strong."""
    corner = np.array([[0.0, 0.0], [FAR, 0.0], [0.0, 0.0], [0.0, FAR]])
    segments = np.array([[3, 2], [2, 1]])
    for away in ([-1.0, -1.0], [0.3, 0.3], [0.3, 0.30001], [0.30001, 0.3]):
        places = corner.copy()
        places[0] = 0.25 * SPACING * np.array(away) / math.sqrt(2.0)
        r = min(places[0].max(), np.hypot(*places[0])) if min(away) > 0.0 else np.hypot(*places[0])
        r = min(places[0]) if min(away) > 0.0 else r
        force, energy = pressed(places, segments)
        assert np.hypot(*force[0, :2]) == pytest.approx(STIFFNESS * (DISTANCE - r), rel=1e-9)
        assert energy == pytest.approx(0.5 * STIFFNESS * (DISTANCE - r) ** 2, rel=1e-9)


def test_what_lies_on_a_segment_goes_inwards():
    force, _ = pressed(np.array([[0.5 * FAR, 0.0], [0.0, 0.0], [FAR, 0.0]]))
    assert force[0] == pytest.approx([0.0, STIFFNESS * DISTANCE, 0.0])
    assert force[1] == pytest.approx(-0.5 * force[0]) and force[2] == pytest.approx(force[1])


def test_all_that_are_near_are_found_whatever_the_segments_length():
    places, segments = chain(3, count=200)
    points, first, second = places[:200], places[segments[:, 0]], places[segments[:, 1]]
    found = {tuple(pair) for pair in polyline.near(points, first, second, SPACING)}
    share = np.linspace(0.0, 1.0, 2001)[:, None, None]
    way = first + share * (second - first)
    for i, point in enumerate(points):
        for s in np.flatnonzero(np.hypot(*(way - point).transpose(2, 0, 1)).min(axis=0) < SPACING):
            assert (i, s) in found
    pairs = polyline.near(points, first, second, SPACING)
    assert (np.lexsort(pairs.T[::-1]) == np.arange(len(pairs))).all()
    assert not len(polyline.near(points[:0], first, second, SPACING))
    assert not len(polyline.near(points, first[:0], second[:0], SPACING))
