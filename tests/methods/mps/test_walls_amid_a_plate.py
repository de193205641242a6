"""Walls of moving particles as far from one face of a plate as from the other, and equations that hold no numbers."""

import math
import warnings

import numpy as np
import pytest
from moving import case, joined

from sdph.engine.guard import Unstable
from sdph.engine.state import LIQUID
from sdph.engine.walls.outline import outline
from sdph.methods.mps import tanks
from sdph.methods.mps.method import MpsStepper

UNIT = 0.02
# a plate three spacings thick stands on the floor, dry on its right: walls stand in its middle
BAFFLE = [[0.2, 0.2], [0.48, 0.2], [0.48, 0.4], [0.54, 0.4], [0.54, 0.2], [0.8, 0.2], [0.8, 0.7], [0.2, 0.7]]
TANK = {
    "effects": ["gravity", "tank"], "dimensions": 2, "resolution": {"spacing_mm": 1e3 * UNIT},
    "domain": {"size_m": [1.0, 0.9], "gravity_m_s2": [0.0, -9.81]}, "liquid": {"density_kg_m3": 800.0},
    "tank": {"shape": "outline", "corners_m": BAFFLE},
    "pools": {"drop": {"shape": "box", "centre_m": None, "radius_m": None, "lower_m": [0.2, 0.2],
                       "upper_m": [0.48, 0.36]}},
}  # fmt: skip


def stepper(sections=None):
    return MpsStepper(case(tuple(TANK["effects"]), joined(TANK, sections or {}), 2))


@pytest.mark.parametrize("turned", [0.0, 0.3, math.pi / 4.0, 1.2])
def test_amid_a_plate_the_normal_is_that_of_its_faces(turned):
    """Before a face, amid the plate, and under the middle of its edge, whose own it is."""
    cosine, sine = math.cos(turned), math.sin(turned)
    turn = np.array([[cosine, -sine], [sine, cosine]])
    shape = outline("tank.corners_m", [tuple(turn @ corner) for corner in BAFFLE])
    places = np.array([[0.49, 0.3], [0.51, 0.3], [0.51, 0.25], [0.51, 0.39]]) @ turn.T
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # 0/0
        found = tanks.normals(shape, places, tanks.NUDGE * UNIT)
    expected = np.array([[1.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 1.0]]) @ turn.T
    np.testing.assert_allclose(np.abs((found * expected).sum(axis=1)), 1.0, rtol=1e-6)


def test_water_beside_a_plate_of_three_spacings_rests():
    """Its load is its weight; it came to no step before, as P was 0/0 amid the plate."""
    own = stepper()
    for _ in range(20):
        own.step(2e-3)
    s = own.state
    wet = s.kind == LIQUID
    assert s.x[wet].max() < 0.48 and np.hypot(s.u[wet], s.v[wet]).max() < 0.1
    assert own.load[1] == pytest.approx(-800.0 * 9.81 * 0.28 * 0.16, rel=0.1)


def test_equations_without_numbers_are_told_with_their_place():
    own = stepper()
    first = int(np.flatnonzero(own.state.kind == LIQUID)[0])
    own.state.u[first] = np.nan
    with pytest.raises(
        Unstable, match=r"no number, the first is particle \d+ at \(0\.\d+, 0\.\d+\) m; more iterations do"
    ) as told:
        own.step(1e-3)
    assert "raise method.iterations" not in str(told.value) and "\n" not in str(told.value)


def test_too_few_iterations_are_told_as_before():
    own = stepper({"method": {"iterations": 1, "tolerance": 1e-9}})
    with pytest.raises(Unstable, match=r"raise method.iterations \(now 1\)"):
        own.step(1e-3)
