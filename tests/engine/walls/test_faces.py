"""Faces of walls with a temperature: their areas, where they stand, whose they are, and what is refused."""

import numpy as np
import pytest
from grain_boxes import box
from test_wall_parts import tubes

from sdph.engine.walls import facets, sides
from sdph.engine.walls.faces import Heated, temperatures
from sdph.engine.walls.sides import Boundary
from sdph.schema import CaseError

EFFECTS = ("conduction", "walls", "wall_heat")


def heated(size=(0.03, 0.06), boundaries=None, **more):
    case = box(EFFECTS, size=size, periodic=(), boundaries=boundaries or {}, gravity=[0.0] * len(size), **more)
    return Heated(case, Boundary(case))


def wall(side, temperature=400.0, **more):
    return {"kind": "wall", "side": side, "temperature_K": temperature} | more


@pytest.mark.parametrize(
    ("size", "areas"), [((0.03, 0.06), (0.03, 0.06)), ((0.03, 0.06, 0.02), (0.03 * 0.02, 0.06 * 0.02))]
)
def test_sides_have_their_areas_and_temperatures(size, areas):
    own = heated(size, {"floor": wall("bottom"), "left": wall("left", 350.0), "rest": {"kind": "wall"}})
    assert own.names == ("floor", "left")
    np.testing.assert_allclose(own.areas, areas, rtol=1e-12)
    for n, (axis, temperature) in enumerate(((1, 400.0), (0, 350.0))):
        mine = own.owners[n]
        assert (own.faces[axis][mine] == 0.0).all() and (own.faces[3 + axis][mine] == 1.0).all()
        assert (own.faces.temperature[mine] == temperature).all()


def test_a_side_goes_on_beyond_its_corners_without_more_area():
    """Three spacings on both sides of 0.03 m, in which six stand: 12 faces, 6 of them of its area."""
    own = heated(boundaries={"lid": wall("top"), "rest": {"kind": "wall"}})
    assert sorted(own.faces.x) == pytest.approx(5e-3 * (np.arange(12) - 2.5))
    assert (own.faces.y == 0.06).all() and (own.faces.normal_y == -1.0).all()
    assert own.areas == pytest.approx([0.03], rel=1e-12)


def test_where_grains_get_out_nothing_goes_on():
    own = heated(boundaries={"floor": wall("bottom"), "out": {"kind": "pressure_outlet", "side": "left"},
                             "rest": {"kind": "wall"}})  # fmt: skip
    assert len(own.faces.x) == 9 and own.faces.x.min() > 0.0


def test_part_of_a_side_has_its_part_of_the_area():
    own = heated(boundaries={"hot": wall("left", span_m=[0.02, 0.04]), "rest": {"kind": "wall"}})
    assert own.areas == pytest.approx([0.02], rel=1e-12)


def test_a_tube_has_the_length_of_its_lines(tmp_path):
    parts = {"first": {"lower_m": [0.018, 0.018], "upper_m": [0.042, 0.042], "temperature_K": 400.0}}
    mesh = {"walls": {"source": "mesh", "mesh": tubes(tmp_path / "tubes.vtk")}}
    own = heated((0.12, 0.06), parts=parts, **mesh)
    assert own.names == ("first",) and own.areas == pytest.approx([24 * 2.0 * 0.012 * np.sin(np.pi / 24)], rel=1e-12)
    outwards = (own.faces.x - 0.03) * own.faces.normal_x + (own.faces.y - 0.03) * own.faces.normal_y
    np.testing.assert_allclose(outwards, 0.012, rtol=0.02)


def test_temperatures_of_gas_that_comes_in_are_of_no_wall():
    given = {"in": {"kind": "velocity_inlet", "side": "bottom", "velocity_m_s": [0.0, 1.0], "temperature_K": 500.0},
             "slips": wall("left", kind="slip_wall"), "rest": {"kind": "wall"}}  # fmt: skip
    case = box(EFFECTS, periodic=(), boundaries=given)
    assert temperatures(case) == {"slips": 400.0}


def test_two_temperatures_of_one_wall_are_refused():
    part = {"strip": {"lower_m": [0.0, 0.0], "upper_m": [0.01, 0.0], "temperature_K": 350.0}}
    with pytest.raises(CaseError, match="floor and strip have a temperature each, and share a wall; leave one out"):
        heated(boundaries={"floor": wall("bottom"), "rest": {"kind": "wall"}}, parts=part)


def test_patches_have_the_area_that_is_their_own():
    """Two tubes alike, 11.6 spacings round, have 12 and 11 points; a facet too small for one is not lost."""
    turn, case = 2.0 * np.pi * np.arange(25) / 24, box(EFFECTS, size=(0.12, 0.06), periodic=())
    ring = 11.6 * case.resolution.spacing / (2.0 * np.pi) * np.stack((np.cos(turn), np.sin(turn)), axis=1)
    tube = np.stack((ring[:-1], ring[1:]), axis=1)
    tiny = 0.1 * case.resolution.spacing * np.array([[[0.0, 0.0], [1.0, 0.0]]])
    whose = np.repeat([2, 3, 4], [24, 24, 1])
    corners = np.concatenate((tube + 0.02, tube + 0.05, tiny))
    found = sides._behind_facets(corners, whose, case, False)
    own = [found.area[found.whose[:, 0] == n] for n in (2, 3, 4)]
    assert [np.count_nonzero(area) for area in own] == [12, 11, 0]
    assert own[0].sum() == pytest.approx(own[1].sum(), rel=1e-12)
    assert found.area.sum() == pytest.approx(facets.sizes(corners).sum(), rel=1e-12)
