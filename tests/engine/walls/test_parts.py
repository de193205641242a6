"""Shares of named parts in forces on walls: sides have all of it once, moments are about the origin."""

import math

import numpy as np
import pytest

from sdph.case.sections import Part
from sdph.engine.walls import parts


@pytest.mark.parametrize("dimensions", [2, 3])
def test_sides_of_a_box_have_all_of_every_force_once(dimensions):
    ticks = np.arange(-2, 6) + 0.5
    places = np.stack([own.ravel() for own in np.meshgrid(*[ticks] * dimensions, indexing="ij")], axis=1)
    shares = parts.sides(places, np.zeros(dimensions), np.full(dimensions, 4.0))
    outside = ((places < 0.0) | (places > 4.0)).any(axis=1)
    total = sum(shares.values())[:, :dimensions]
    assert len(shares) == 2 * dimensions
    np.testing.assert_allclose(total[outside], 1.0, rtol=1e-15)
    assert not total[~outside].any()


def test_a_corner_gives_each_side_what_is_along_its_normal_and_shares_its_edge():
    shares = parts.sides(np.array([[-0.5, -0.5, 2.0], [-0.5, 2.0, 2.0]]), np.zeros(3), np.full(3, 4.0))
    np.testing.assert_array_equal(shares["left"], [[1.0, 0.0, 0.5], [1.0, 1.0, 1.0]])
    np.testing.assert_array_equal(shares["bottom"], [[0.0, 1.0, 0.5], [0.0, 0.0, 0.0]])
    assert not any(shares[side].any() for side in ("right", "top", "back", "front"))


def test_in_a_corner_of_a_mesh_each_facet_has_what_is_along_its_normal():
    east, north, up = np.eye(3)
    low = np.array([0.6, 0.8, 0.0])
    facing = np.array([[east, north, north], [east, north, up], [low, east, east], np.zeros((3, 3))])
    one, other = (parts.of_facets(np.array(own, bool), facing) for own in (
        [[1, 0, 0], [1, 0, 0], [1, 0, 0], [1, 1, 1]], [[0, 1, 1], [0, 1, 1], [0, 1, 1], [0, 0, 0]]))  # fmt: skip
    np.testing.assert_allclose(one, [[1.0, 0.0, 0.5], [1.0, 0.0, 0.0], [0.36 / 1.36, 1.0, 0.5], [1.0] * 3], rtol=1e-15)
    np.testing.assert_allclose(one + other, 1.0, rtol=1e-15)


def test_a_part_holds_surfaces_that_lie_in_its_faces():
    part = Part(lower=(1.0, 0.0), upper=(2.0, 0.0))
    places = np.array([[1.0, 1e-9], [2.0, -1e-9], [1.5, 0.3], [0.7, 0.0]])
    np.testing.assert_array_equal(parts.within(part, places, 0.25), [True, True, False, False])


def test_moments_are_of_pressure_and_friction_about_the_origin():
    shares = np.array([[[1.0, 1.0, 1.0], [0.0, 1.0, 0.0]]])
    places = np.array([[0.0, 2.0, 0.0], [3.0, 0.0, 0.0]])
    pressed = np.array([[5.0, 0.0, 0.0], [7.0, 1.0, 0.0]])
    rubbed = np.array([[0.0, 4.0, 1.0], [0.0, 2.0, 0.0]])
    found = parts.gathered(places, shares * pressed, places, shares * rubbed)
    np.testing.assert_array_equal(found, [[[5.0, 1.0, 0.0], [0.0, 6.0, 1.0], [2.0, 0.0, -10.0 + 3.0 * 3.0]]])


def test_means_are_since_the_last_row_and_since_the_start():
    own = parts.Pushed("grain", "friction", ["floor", "tube"], 2)
    assert all(math.isnan(value) for value in own.row().values()) and len(own.row()) == 10
    force = np.zeros((2, 3, 3))
    force[1, 0, 1], force[1, 2, 2] = -6.0, 2.0
    own.add(2.0 * force, 0.0, 2.0)
    own.new_row()
    own.add(force, 2.0, 2.5)
    assert own.row()["tube_grain_pressure_force_y_N"] == -12.0 and own.row()["tube_grain_moment_z_Nm"] == 4.0
    assert own.summary()["mean_tube_grain_pressure_force_y_N"] == pytest.approx(-18.0 / 2.5, rel=1e-15)
    assert own.row()["floor_grain_friction_force_x_N"] == 0.0  # nothing touches it
    late = parts.Pushed("grain", "friction", ["tube"], 2, start=2.0)
    late.add(2.0 * force[1:], 0.0, 2.0 + 1e-12)
    assert math.isnan(late.summary()["mean_tube_grain_moment_z_Nm"]) and late.row()["tube_grain_moment_z_Nm"] > 1.9
    late.add(force[1:], 2.0 + 1e-12, 2.5)
    assert late.summary()["mean_tube_grain_moment_z_Nm"] == pytest.approx(4.0, rel=1e-9)
    names = [key for key in parts.told("a", "gas", "viscous", np.zeros((3, 3)), 3)]
    assert names[-3:] == ["a_gas_moment_x_Nm", "a_gas_moment_y_Nm", "a_gas_moment_z_Nm"] and len(names) == 9
