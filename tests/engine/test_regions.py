"""Regions that grains fill: how much lies in them, in front of walls, up to a level."""

import dataclasses
import math

import meshio
import numpy as np
import pytest
import pyvista
from hypothesis import given
from hypothesis import strategies as st

from sdph.case.sections import Region
from sdph.engine import regions
from sdph.engine.walls import facets
from sdph.schema import CaseError

SPACING = 0.01


def region(shape, **keys):
    return Region(shape=shape, volume_fraction=0.5, temperature=300.0, **keys)


ROUND = region("cylinder", centre=(0.1, 0.2, 0.3), radius=0.08, length=0.2, axis="y")


def stl(tmp_path, surface, name="a.stl"):
    path = str(tmp_path / name)
    surface.triangulate().save(path)
    return path


@pytest.mark.parametrize(
    ("own", "volume"),
    [
        (ROUND, math.pi * 0.08**2 * 0.2),
        (dataclasses.replace(ROUND, shape="cone", end_radius=0.02), math.pi * 0.2 * (0.0064 + 0.0016 + 0.0004) / 3.0),
        (dataclasses.replace(ROUND, shape="cone", radius=0.0, end_radius=0.08), math.pi * 0.2 * 0.0064 / 3.0),
    ],
)
def test_a_round_region_holds_its_volume(own, volume):
    points = regions.points(own, SPACING, 3, None)
    assert len(points) * SPACING**3 == pytest.approx(volume, rel=0.04)  # a lattice in eight spacings
    low, high = regions.bounds(own, "", 3)
    assert (points > low).all() and (points < high).all()
    assert regions.volume(own, SPACING, 3, 10) == pytest.approx(0.1 * volume)  # exact, whatever the lattice makes of it


def test_the_wide_end_of_a_cone_is_the_upper_one_where_it_is_given_so():
    cone = dataclasses.replace(ROUND, shape="cone", radius=0.01, end_radius=0.08)
    points = regions.points(cone, SPACING, 3, None)
    assert points[:, 1].mean() > 0.2 + 0.03


def test_the_inside_of_a_mesh_is_that_of_its_ball(tmp_path):
    ball = stl(tmp_path, pyvista.Sphere(radius=0.1, center=(0.2, 0.2, 0.2), theta_resolution=40, phi_resolution=40))
    points = regions.points(region("mesh", mesh=ball), SPACING, 3, None)
    assert len(points) * SPACING**3 == pytest.approx(4.0 / 3.0 * math.pi * 1e-3, rel=0.02)
    assert (((points - 0.2) ** 2).sum(axis=1) < 0.01).all()


@given(
    low=st.floats(0.02, 0.1), high=st.floats(0.02, 0.3), tall=st.floats(0.05, 0.3), lean=st.floats(-0.1, 0.1),
    turned=st.booleans(),
)  # fmt: skip
def test_an_outline_is_filled_between_its_sides(low, high, tall, lean, turned):
    """A trapezoid, whichever way its corners go round: its area exactly, up to any level too, and nothing beside it."""
    corners = ((0.0, 0.0), (low, 0.0), (lean + high, tall), (lean, tall))
    own = region("outline", corners=corners[::-1] if turned else corners)
    area = 0.5 * (low + high) * tall
    assert regions.closed_form(own, 2) == pytest.approx(area) == 7.0 * regions.volume(own, SPACING, 2, 7)
    x, y = regions.points(own, 0.002, 2, None).T
    share, same = y / tall, 1e-12  # of a side that points lie on
    assert (y > 0.0).all() and (y < tall).all()
    assert (x > share * lean - same).all() and (x < low + share * (lean + high - low) + same).all()
    assert len(x) * 0.002**2 == pytest.approx(area, rel=0.1)
    lower, upper = regions.bounds(own, None, 2)
    half = np.array([upper[0], 0.5 * tall])
    least = regions.counted(own, lower, half, None, 3.0, SPACING)
    assert least == pytest.approx(0.5 * tall * (0.75 * low + 0.25 * high), rel=0.02)


@pytest.mark.parametrize("capping", [True, False])
def test_what_walls_enclose_stands_where_contact_holds_it(tmp_path, capping):
    """Closed or open above and below: of an open one the box around its mesh ends what is filled."""
    vessel = pyvista.Cylinder(
        center=(0.1, 0.1, 0.1), direction=(0, 0, 1), radius=0.1, height=0.2, resolution=64, capping=capping
    ).triangulate()
    walls = facets.read(stl(tmp_path, vessel.flip_faces()), 3)  # normals inwards
    points = regions.points(region("walls"), SPACING, 3, walls)
    points = points[regions.in_front(points, walls, SPACING, 3)]
    off = 0.1 - np.hypot(*(points[:, :2] - 0.1).T)
    assert off.min() > 0.249 * SPACING and len(points) * SPACING**3 == pytest.approx(math.pi * 0.01 * 0.2, rel=0.08)
    assert facets.Surface(walls).closed is capping


def line(tmp_path, points, *, loop):
    count = len(points)
    cells = [[n, (n + 1) % count] for n in range(count if loop else count - 1)]
    path = str(tmp_path / "line.vtk")
    meshio.write_points_cells(path, np.pad(np.array(points, float), ((0, 0), (0, 1))), {"line": np.array(cells)})
    return facets.read(path, 2)


def test_a_plane_vessel_is_closed_and_holds_what_is_in_it(tmp_path):
    corners = [(0.0, 0.0), (0.1, 0.0), (0.2, 0.3), (-0.1, 0.3)]  # counterclockwise: normals to the left are inwards
    walls = line(tmp_path, corners, loop=True)
    points = regions.points(region("walls"), SPACING, 2, walls)
    points = points[regions.in_front(points, walls, SPACING, 3)]
    assert facets.Surface(walls).closed
    assert len(points) * SPACING**2 == pytest.approx(0.3 * 0.2, rel=0.06)
    assert points[:, 0].min() < 0.0 and points[:, 1].min() > 0.249 * SPACING


def test_an_open_plate_clears_what_stands_in_it_alone(tmp_path):
    walls = line(tmp_path, [(1.0, 0.5), (0.0, 0.5)], loop=False)  # its normal is down
    places = np.array([[0.5, y] for y in (0.2, 0.497, 0.498, 0.51, 0.529, 0.54, 0.9)])
    assert not facets.Surface(walls).closed
    assert regions.in_front(places, walls, SPACING, 3).tolist() == [True, True, False, False, False, True, True]


def test_a_level_is_that_of_its_height_or_its_mass():
    box = region("box", lower=(0.0, 0.0), upper=(0.1, 0.2))
    points, up = regions.points(box, SPACING, 2, None), np.array([0.0, 1.0])
    to_height = regions.below("a", dataclasses.replace(box, height=0.05), points, up, SPACING, 1.0)
    assert to_height.sum() == 50 and points[to_height][:, 1].max() < 0.05
    with pytest.raises(CaseError, match=r"a\.height_m = 9; its region is .* m high: give less"):
        regions.below("a", dataclasses.replace(box, height=9.0), points, up, SPACING, 1.0)
    to_mass = regions.below("a", dataclasses.replace(box, mass=54.0), points, up, SPACING, 1.0)
    layer = points[to_mass][points[to_mass][:, 1] > 0.05]
    assert to_mass.sum() == 54 and sorted(layer[:, 0].round(3)) == [0.035, 0.045, 0.055, 0.065]
    sideways = regions.below("a", dataclasses.replace(box, height=0.05), points, np.array([-1.0, 0.0]), SPACING, 1.0)
    assert points[sideways][:, 0].min() > 0.05 and sideways.sum() == 100


@pytest.mark.parametrize("tall", [0.204, 0.196])
def test_a_level_above_its_vessel_is_told_with_the_height_of_that(tmp_path, tall):
    """Rows of its lattice are 0.2 m high, whatever it is."""
    walls = line(tmp_path, [(0.0, 0.0), (0.1, 0.0), (0.1, tall), (0.0, tall)], loop=True)
    own = region("walls", height=9.0)
    points, told = regions.points(own, SPACING, 2, walls), rf"its region is {tall:g} m high: give less"
    with pytest.raises(CaseError, match=told):
        regions.below("a", own, points, np.array([0.0, 1.0]), SPACING, 1.0, walls=walls)
    with pytest.raises(CaseError, match=r"its region is .* m high"):  # along no axis, that of its places
        regions.below("a", own, points, np.array([0.6, 0.8]), SPACING, 1.0, walls=walls)


def test_disorder_is_that_of_its_seed():
    points = np.zeros((100, 2))
    first, second = (regions.disordered(points, 0.2, seed, SPACING) for seed in (1, 2))
    assert (regions.disordered(points, 0.2, 1, SPACING) == first).all() and (first != second).all()
    assert 0.0018 < np.abs(first).max() <= 0.002 and regions.disordered(points, 0.0, 1, SPACING) is points
