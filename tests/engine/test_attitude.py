"""The attitude of a frame that turns: closed forms, order, and answers that do not depend on who asked before."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from sdph.engine.attitude import Attitude

OFF, ALONG, RATE = 0.7, 1.3, 2.1  # rad/s: a top whose axis goes round in its own axes


def coning(time):
    return np.array([OFF * np.cos(RATE * time), OFF * np.sin(RATE * time), ALONG])


def known(time):
    """omega that goes round about z at a constant rate: two turns, one after the other."""
    return (
        Rotation.from_rotvec([OFF * time, 0.0, (ALONG + RATE) * time]) * Rotation.from_rotvec([0.0, 0.0, -RATE * time])
    ).as_matrix()


@pytest.mark.parametrize("time", [0.0, 0.013, 1.0, 7.77])
def test_an_axis_that_goes_round_has_its_closed_form(time):
    np.testing.assert_allclose(Attitude(coning, 0.01).at(time), known(time), atol=3e-10)


def test_steps_err_by_their_fourth_power():
    errors = [np.abs(Attitude(coning, step).at(4.0) - known(4.0)).max() for step in (0.2, 0.1)]
    assert errors[0] / errors[1] == pytest.approx(16.0, rel=0.15)


def test_who_asked_before_does_not_matter():
    asked, fresh = Attitude(coning, 0.05), Attitude(coning, 0.05)
    for time in (3.0, 0.2, 1.71):
        asked.at(time)
    np.testing.assert_array_equal(asked.at(2.345), fresh.at(2.345))
