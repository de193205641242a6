"""Thin walls: a plate of 1 mm between particles 20 mm apart parts them, and each sees the face before it alone."""

import numpy as np
from builders import simulation

from sdph.engine.rows import length
from sdph.study.stress import suite


def test_no_pair_and_no_dummy_reaches_through_a_plate(tmp_path):
    (hard,) = suite.chosen(["thin_wall"], False)
    stepper = simulation(suite.case_of(hard), tmp_path).stepper
    stepper.prepare()
    left, dummies = stepper.state.x < 0.25, stepper.boundary.dummies
    for i, own in enumerate(left):
        near = stepper.rows.index[i, : stepper.rows.count[i]]
        assert len(near) and np.all(left[near] == own)
        assert np.all(stepper.rows.index[i, len(near) : length(stepper.rows, i)] == i)
        seen = stepper.wall_rows.index[i, : stepper.wall_rows.count[i]]
        facing = dummies.normal_x[seen[stepper.boundary.of_mesh[seen]]]
        assert np.all(facing == (-1.0 if own else 1.0))
    beside = np.flatnonzero(np.abs(stepper.state.x - 0.25) < 0.03)
    assert len(beside) and all(
        stepper.boundary.of_mesh[stepper.wall_rows.index[i, : stepper.wall_rows.count[i]]].any() for i in beside
    )
