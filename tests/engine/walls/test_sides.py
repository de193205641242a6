"""Sides of a box and thin walls: corners push nobody; a plate of 1 mm between particles 20 mm apart parts them, and
each sees the face before it alone."""

import numpy as np
import pytest
from builders import simulation
from grain_boxes import box

from sdph.engine import state as particles
from sdph.engine.rows import length, place
from sdph.study.stress import suite


def of(rows, i):
    """Neighbours of particle i."""
    return rows.entries[rows.start[i] :][: rows.number[i]]


def test_no_pair_and_no_dummy_reaches_through_a_plate(tmp_path):
    (hard,) = suite.chosen(["thin_wall"], False)
    stepper = simulation(suite.case_of(hard), tmp_path).stepper
    stepper.prepare()
    left, dummies = stepper.state.x < 0.25, stepper.boundary.dummies
    for i, own in enumerate(left):
        near = of(stepper.rows, i)
        assert len(near) and np.all(left[near] == own)
        assert np.all(
            stepper.rows.entries[place(stepper.rows, i, len(near)) : place(stepper.rows, i, length(stepper.rows, i))]
            == i
        )
        seen = of(stepper.wall, i)
        facing = dummies.normal_x[seen[stepper.boundary.of_mesh[seen]]]
        assert np.all(facing == (-1.0 if own else 1.0))
    beside = np.flatnonzero(np.abs(stepper.state.x - 0.25) < 0.03)
    assert len(beside) and all(stepper.boundary.of_mesh[of(stepper.wall, i)].any() for i in beside)


@pytest.mark.parametrize("size", [(0.06, 0.04), (0.04, 0.04, 0.04)])
def test_grains_under_one_pressure_are_at_rest_in_corners(tmp_path, size):
    """Rows of dummies behind a side end in a corner: pressure along the normal leaves out what the corner adds."""
    own = {"granular_temperature_m2_s2": 1.0}, {"window_tolerance": 1e30, "window_largest_s": 1e-5, "courant": 1e30}
    still = (0.0,) * len(size)
    case = box(["granular_pressure", "walls"], size, 0.55, (), still, grains=own[0], coupling=own[1])
    run = simulation(case, tmp_path)
    run.window()
    assert np.abs(particles.velocities(run.grains.inside)).max() < 1e-9  # m/s; pushed out of corners they reach 0.02
