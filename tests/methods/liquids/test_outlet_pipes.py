"""Outlets of tanks: full at the start, tight, and within what they are outlets of."""

import math

import numpy as np
import pytest
from scipy.spatial import cKDTree
from test_filling import MIDDLE, RADIUS, RHO, ROUND, SHAPES, G, filled, first_peak, nearest, of_kind

from sdph.effects.around import tank
from sdph.engine.state import WALL
from sdph.engine.walls import layers
from sdph.schema import CaseError


@pytest.mark.parametrize("name", ["box", "sphere", "cylinder", "capsule"])
def test_an_outlet_pipe_is_full_and_holds(name):
    """A pipe 2.5 spacings in radius."""
    spacing, radius, length = 0.06, 0.15, 0.3
    own = filled(SHAPES[name] | {"outlet_radius_m": radius, "outlet_length_m": length}, spacing)
    joined = tank.shape_of(own.case)
    count = len(of_kind(own))
    sagitta = RADIUS - math.sqrt(RADIUS**2 - radius**2) if name in ("sphere", "capsule") else 0.0
    lens = math.pi * sagitta * (3.0 * radius**2 + sagitta**2) / 6.0
    assert count * spacing**3 == pytest.approx(
        0.5 * joined.volume + math.pi * radius**2 * (length + sagitta) - lens, abs=2.5 * spacing**3
    )
    walls = of_kind(own, WALL)
    assert nearest(of_kind(own), walls) > 0.85 * spacing
    if name == "box":
        assert cKDTree(walls).query(walls, k=2)[0][:, 1].min() > 0.49 * spacing  # none twice where the pipe begins
    assert of_kind(own)[:, 2].max() + 0.5 * spacing == pytest.approx(MIDDLE[2], abs=0.1 * spacing)
    assert 0.9 < first_peak(own, 0.15) < 1.35  # single particles in a pipe so narrow; 4 to 7 where it was half empty
    assert (joined.distance(of_kind(own)) < 0.0).all()


def test_a_slot_in_the_floor_of_a_box_is_full_and_holds():
    """In two dimensions, aside of the middle; walls of both parts stand for their own lattice."""
    spacing, radius, length, at = 0.04, 0.1, 0.2, 0.3
    outlet = {"outlet_radius_m": radius, "outlet_length_m": length, "outlet_centre_m": [at]}
    box = {"shape": "box", "lower_m": [0.1, 0.0], "upper_m": [0.93, 1.6]}
    own = filled(box | outlet, spacing, gravity=(0.0, -G))
    places, joined = of_kind(own), tank.shape_of(own.case)
    assert len(places) * spacing**2 == pytest.approx(0.5 * joined.volume + 2.0 * radius * length, abs=1.5 * spacing**2)
    below = places[places[:, 1] < 0.0]
    assert (
        len(below) == pytest.approx(2.0 * radius * length / spacing**2, abs=2) and abs(below[:, 0] - at).max() < radius
    )
    parts = layers.wall_points(joined, spacing, tank.layers(own.case))
    steps = own.state.mass[own.state.kind == WALL] / RHO
    assert set(np.round(steps / spacing**2, 9)) == {round(0.83 / 21 / spacing, 9), 1.0}
    assert (
        own.own_walls.stop - own.own_walls.start == len(parts[0])
        and len(parts[1]) == len(own.state.x) - own.own_walls.stop
    )
    assert first_peak(own, 0.15) == pytest.approx(1.0, abs=0.15)


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"shape": "mesh"}, "a mesh has its pipe in its file"),
        ({"shape": "box", "outlet_centre_m": [0.05, 0.5]}, "within the floor"),
        ({"shape": "box", "outlet_centre_m": [0.5]}, "give 2 numbers"),
        ({"shape": "box", "open_sides": ["back"]}, "which is a wall"),
        ({"shape": "box", "outlet_length_m": 0.0}, "a spacing long at least"),
        ({"shape": "cylinder", "length_m": 1.0, **ROUND, "outlet_centre_m": [0.5, 0.5]}, "leave it out"),
        ({"shape": "sphere", **ROUND, "outlet_radius_m": 0.6}, "narrower than its tank"),
    ],
)
def test_outlets_that_cannot_be_are_refused(given, told):
    outlet = {"outlet_radius_m": 0.15, "outlet_length_m": 0.3}
    with pytest.raises(CaseError, match=told):
        filled(outlet | given, 0.06)
