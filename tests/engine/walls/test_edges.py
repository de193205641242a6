"""Edges of a mesh: what lies behind two facets there is once in the sum of a particle in front of both."""

import meshio
import numpy as np
import pytest
from grain_boxes import SPACING, box, started

SIDE = 8.0 * SPACING  # of a square block in the middle of the box
LOW, HIGH = 0.08 - 0.5 * SIDE, 0.08 + 0.5 * SIDE


@pytest.fixture
def stepper(tmp_path):
    """Grains all about a square block of lines, normals outwards; none in it."""
    corners = np.array([[LOW, LOW], [LOW, HIGH], [HIGH, HIGH], [HIGH, LOW]])
    path = tmp_path / "block.vtk"
    lines = np.array([[0, 1], [1, 2], [2, 3], [3, 0]])
    meshio.Mesh(np.column_stack((corners, np.zeros(4))), [("line", lines)]).write(path)
    case = box(
        ["granular_pressure", "walls"], size=(0.16, 0.16), periodic=("x", "y"), alpha_p=0.5, walls={"mesh": str(path)},
    )  # fmt: skip
    return started(case, tmp_path).stepper


def listed(stepper, i):
    wall = stepper.wall
    rows = wall.entries[wall.start[i] : wall.start[i] + wall.number[i]]
    return np.stack((wall.x[rows], wall.y[rows]), axis=1)


def test_no_place_counts_twice_and_none_is_missing(stepper):
    """Grains in front of one facet see all of its dummies, those in front of two each place once."""
    s, seen = stepper.state, []
    for i in range(len(s.x)):
        places = listed(stepper, i)
        if len(places) > 1:
            apart = np.linalg.norm(places[:, None] - places, axis=2) + SPACING * np.eye(len(places))
            seen.append(apart.min())
            solid = np.clip(places, LOW, HIGH) == places
            assert solid.all()
    assert len(seen) > 100 and min(seen) > 0.99 * SPACING


def test_no_grain_about_an_edge_is_denser_than_the_others(stepper):
    """A lattice of grains about a block on its own lattice: the block is as full as they are. Beside an edge they lack
    the neighbour beyond it."""
    density = stepper.state.density / np.median(stepper.state.density)
    print(f"{density.min() - 1.0:.3f} to {density.max() - 1.0:.1e}")
    assert density.max() < 1.0 + 1e-12 and density.min() > 0.9
