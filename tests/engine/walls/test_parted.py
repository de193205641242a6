"""Pairs across a thin wall: parted where the way between them goes through a point of its surface."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sdph.engine.rows import LANES, Rows
from sdph.engine.walls import mesh
from sdph.engine.walls.dummies import Dummies

SPACING, DEPTH = 0.1, 0.08
EVERYWHERE = 1e3  # m: all see all here
AT = np.array([0.3, -0.2, 1.5])  # m, the point of the surface


def seen_by(walls, points):
    """What `parted` asks of particles at `points` (N, 3) [m] that see all points of a surface, each with its normal."""
    columns = [np.array([(*(at - DEPTH * np.array(n)), *n) for at, n in walls]).T]
    fixed = ([value] * len(walls) for value in (DEPTH, 1.0, 0.0, 0.0, 0.0, SPACING**3))
    wall = Dummies(*np.ascontiguousarray(columns[0]), *(np.array(row) for row in fixed))
    places = tuple(np.ascontiguousarray(column) for column in np.array(points).T)
    return wall, np.ones(len(walls), bool), SPACING, places, every(len(walls), len(points))


def every(columns, count):
    """Rows of `count` particles, each with all numbers up to `columns`."""
    room = columns + LANES  # rows end in the particle itself
    seen = np.repeat(np.arange(count, dtype=np.uint32)[:, None], room, axis=1)
    seen[:, :columns] = np.arange(columns)
    return Rows(seen.ravel(), room * np.arange(count), np.full(count, columns, np.int32))


def pair_of(walls, ends):
    """Whether a pair at `ends` (2, 3) [m] is parted by points of a surface, each with its normal."""
    return mesh.parted(*seen_by(walls, ends), 0, 1)


@settings(max_examples=60, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), apart=st.floats(0.2, 3.0), kind=st.sampled_from(("plate", "sheet", "edge")))
def test_rows_lose_those_pairs_that_are_parted_and_no_others(seed, apart, kind):
    """A plate of points with both faces, one face alone, or two at an angle, tilted, and particles about it: most pairs
    are too near to need a look, or see no face that another is turned against."""
    rng = np.random.default_rng(seed)
    normal = rng.normal(size=3)
    normal /= np.linalg.norm(normal)
    along = np.linalg.svd(normal[None])[2][1:]
    ticks = SPACING * np.array([(i, j) for i in range(-2, 3) for j in range(-2, 3)])
    walls = [(AT + 0.02 * normal + tick @ along, normal) for tick in ticks]
    if kind != "sheet":
        turn = np.pi if kind == "plate" else rng.uniform(0.0, np.pi)
        other, way = (
            c * normal + s * along[0] for c, s in ((np.cos(turn), np.sin(turn)), (-np.sin(turn), np.cos(turn)))
        )
        walls += [(AT - 0.02 * normal + tick @ np.array((way, along[1])), other) for tick in ticks]
    points = AT + SPACING * apart * rng.normal(size=(12, 3))
    asked = seen_by(walls, points)
    wall, of_mesh, *rest = asked
    rows = every(len(points), len(points))
    mesh.part(wall, of_mesh, mesh.faced(wall, of_mesh, SPACING, EVERYWHERE), *rest, rows)
    for i in range(len(points)):
        left = [j for j in range(len(points)) if not mesh.parted(*asked, i, j)]
        assert rows.entries[rows.start[i] : rows.start[i] + rows.number[i]].tolist() == left


def test_faces_are_faced_by_what_is_turned_against_them_within_reach():
    """Both faces of a plate, and of a channel that is narrower than the reach; not the sides of a block's edge."""
    up, aside = np.array((0.0, 0.0, 1.0)), np.array((1.0, 0.0, 0.0))
    walls = [(AT, up), (AT - 0.02 * up, -up), (AT + 5.0 * up, -up), (AT + 9.0 * aside, aside), (AT + 9.0 * aside, up)]
    wall, of_mesh, *_ = seen_by(walls, [AT])
    assert mesh.faced(wall, of_mesh, SPACING, 0.5).tolist() == [True, True, False, False, False]
    assert mesh.faced(wall, of_mesh, SPACING, 6.0).tolist() == [True, True, True, False, False]


def across(normal, aside):
    """Whether a pair is parted whose way goes straight through the surface, `aside` (3,) [m] of its point."""
    normal = np.array(normal) / np.linalg.norm(normal)
    return pair_of([(AT, normal)], [AT + aside + 0.05 * normal, AT + aside - 0.03 * normal])


@pytest.mark.parametrize(("angle", "parts"), [(180.0, True), (150.0, True), (120.0, False), (90.0, False)])
def test_a_plate_parts_and_an_edge_does_not(angle, parts):
    """Faces whose normals are at an angle, the way goes through both."""
    first, turn = np.array((1.0, 0.0, 0.0)), np.radians(angle)
    second = np.array((np.cos(turn), np.sin(turn), 0.0))
    ends = np.array([AT + 0.05 * first, AT - 0.02 * first + 0.05 * second])
    faces = [(AT, first), (AT - 0.02 * first, second)]
    assert pair_of(faces, ends) is parts and pair_of(faces, ends[::-1]) is parts


def test_a_pair_round_the_corner_of_a_block_goes_on_meeting():
    """A particle slides along one face past the corner: its neighbour beside the other face is there all the time."""
    ticks = np.arange(-0.45, 0.0, SPACING)
    faces = [((0.0, t, 0.0), (1.0, 0.0, 0.0)) for t in ticks] + [((t, 0.0, 0.0), (0.0, 1.0, 0.0)) for t in ticks]
    faces = [(np.array(at), np.array(normal)) for at, normal in faces]
    for up in np.linspace(-0.15, 0.1, 26):
        assert not pair_of(faces, [(0.04, up, 0.0), (-0.08, 0.03, 0.0)])


@pytest.mark.parametrize("normal", [(1, 0, 0), (0, 1, 0), (0, 0, 1), (3, 4, 12), (-2, 1, -2)])
def test_a_pair_is_parted_within_three_quarters_of_a_spacing_of_a_point(normal):
    along = [np.cross(normal, axis) for axis in np.eye(3) if np.linalg.norm(np.cross(normal, axis)) > 0.0]
    for way in along:
        way = way / np.linalg.norm(way)
        assert across(normal, 0.0 * way)
        assert across(normal, 0.74 * SPACING * way) and across(normal, -0.74 * SPACING * way)
        assert not across(normal, 0.76 * SPACING * way) and not across(normal, -0.76 * SPACING * way)
