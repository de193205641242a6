"""Pairs across a thin wall: parted where the way between them goes through a point of its surface."""

import numpy as np
import pytest

from sdph.engine.rows import Rows
from sdph.engine.walls import mesh
from sdph.engine.walls.dummies import Dummies

SPACING, DEPTH = 0.1, 0.08
AT = np.array([0.3, -0.2, 1.5])  # m, the point of the surface


def pair_of(walls, ends):
    """Whether a pair at `ends` (2, 3) [m] is parted by points of a surface, each with its normal."""
    columns = [np.array([(*(at - DEPTH * np.array(n)), *n) for at, n in walls]).T]
    fixed = ([value] * len(walls) for value in (DEPTH, 1.0, 0.0, 0.0, 0.0, SPACING**3))
    wall = Dummies(*np.ascontiguousarray(columns[0]), *(np.array(row) for row in fixed))
    seen = np.tile(np.arange(len(walls), dtype=np.uint32), 2)
    rows = Rows(seen, len(walls) * np.arange(2), np.full(2, len(walls), np.int32))
    places = tuple(np.ascontiguousarray(column) for column in np.array(ends).T)
    return mesh.parted(wall, np.ones(len(walls), bool), SPACING, places, rows, 0, 1)


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
