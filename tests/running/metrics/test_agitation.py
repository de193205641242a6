"""Metrics of agitated grains: sums over particles or cells, written out by hand."""

import numpy as np
import pytest

from sdph.running.metrics import agitation

PLACES = np.array([[0.0, 1.0, 0.0], [4.0, 1.0, 0.0]])  # m
MASSES = np.array([3.0, 1.0])  # kg
VELOCITIES = np.array([[1.0, 0.0, 0.0], [0.0, 2.0, 0.0]])  # m/s
THETA = np.array([0.5, 2.0])  # m2/s2


def test_sums_by_hand():
    found = agitation.metrics(PLACES, MASSES, VELOCITIES, THETA)
    assert found["motion_J"] == pytest.approx(0.5 * (3.0 * 1.0 + 1.0 * 4.0), rel=1e-15)
    assert found["agitation_J"] == pytest.approx(1.5 * (3.0 * 0.5 + 1.0 * 2.0), rel=1e-15)
    assert (found["centre_x_m"], found["centre_y_m"]) == pytest.approx((1.0, 1.0), rel=1e-15)
    assert found["spread_x_m"] == pytest.approx(np.sqrt((3.0 * 1.0 + 1.0 * 9.0) / 4.0), rel=1e-15)
    assert found["spread_y_m"] == 0.0
