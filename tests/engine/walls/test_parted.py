"""Pairs across a thin wall: parted where the way between them goes through a point of its surface."""

import numpy as np
import pytest

from sdph.engine.rows import Rows
from sdph.engine.walls import mesh
from sdph.engine.walls.dummies import Dummies

SPACING, DEPTH = 0.1, 0.08
AT = np.array([0.3, -0.2, 1.5])  # m, the point of the surface


def across(normal, aside):
    """Whether a pair is parted whose way goes straight through the surface, `aside` (3,) [m] of its point."""
    normal = np.array(normal) / np.linalg.norm(normal)
    behind = AT - DEPTH * normal
    wall = Dummies(*(np.array([v]) for v in (*behind, *normal, DEPTH, 1.0, 0.0, 0.0, 0.0)))
    ends = np.stack([AT + aside + 0.05 * normal, AT + aside - 0.03 * normal])
    rows = Rows(np.zeros(2, np.uint32), np.array([0, 1]), np.ones(2, np.int32))
    places = tuple(np.ascontiguousarray(column) for column in ends.T)
    return mesh.parted(wall, np.ones(1, bool), SPACING, places, rows, 0, 1)


@pytest.mark.parametrize("normal", [(1, 0, 0), (0, 1, 0), (0, 0, 1), (3, 4, 12), (-2, 1, -2)])
def test_a_pair_is_parted_within_three_quarters_of_a_spacing_of_a_point(normal):
    along = [np.cross(normal, axis) for axis in np.eye(3) if np.linalg.norm(np.cross(normal, axis)) > 0.0]
    for way in along:
        way = way / np.linalg.norm(way)
        assert across(normal, 0.0 * way)
        assert across(normal, 0.74 * SPACING * way) and across(normal, -0.74 * SPACING * way)
        assert not across(normal, 0.76 * SPACING * way) and not across(normal, -0.76 * SPACING * way)
