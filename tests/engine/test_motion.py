"""Motion of particles: what a loop may read and write."""

import numpy as np

from sdph.engine import motion


def test_a_plane_drift_touches_no_third_axis():
    """Bodies in a plane liquid have a velocity of three parts (sdph.methods.liquids.forces.Moving), places of two."""
    active = np.array([0, 2], np.int32)
    u, v, w = np.full(3, 1.0), np.full(3, 2.0), np.full(3, 3.0)
    x, y, z = np.zeros(3), np.zeros(3), np.zeros(0)
    motion.drift.py_func(active, u, v, w, 0.5, x, y, z)  # as Python it raises where it is out of bounds
    assert x.tolist() == [0.5, 0.0, 0.5] and y.tolist() == [1.0, 0.0, 1.0]
