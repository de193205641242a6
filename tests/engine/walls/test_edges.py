"""Edges of a mesh: what lies behind two facets there is once in the sum of a particle in front of both."""

import meshio
import numpy as np
import pytest
from grain_boxes import SPACING, box, started

SIDE = 8.0 * SPACING  # of a square block in the middle of the box
LOW, HIGH = 0.08 - 0.5 * SIDE, 0.08 + 0.5 * SIDE


@pytest.fixture
def stepper(tmp_path):
    return about_a_block(tmp_path, SIDE)


def about_a_block(tmp_path, side):
    """Grains all about a square block of lines of a side [m], normals outwards; none in it."""
    low, high = 0.08 - 0.5 * side, 0.08 + 0.5 * side
    corners = np.array([[low, low], [low, high], [high, high], [high, low]])
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


def test_all_grains_about_a_block_are_as_dense(stepper):
    """A lattice of grains about a block on its own lattice: the block is as full as they are, also round its edges."""
    assert stepper.state.density == pytest.approx(np.median(stepper.state.density), rel=1e-12)


def test_a_grain_that_comes_round_an_edge_finds_nothing_changed(tmp_path):
    """A grain beside a block that is on no lattice goes past its edge, rows made anew on the way: its density and its
    neighbours' change little by little."""
    stepper = about_a_block(tmp_path, 8.3 * SPACING)
    side = 0.08 + 4.15 * SPACING
    probe = int(np.argmin(np.hypot(stepper.state.x - side - 0.4 * SPACING, stepper.state.y - side)))
    ident, found = stepper.state.ident[probe], []
    for up in np.arange(-1.5, 1.5, 0.01) * SPACING:
        i = int(np.flatnonzero(stepper.state.ident == ident)[0])
        stepper.state.x[i], stepper.state.y[i] = side + 0.3 * SPACING, side + up
        stepper.neighbours.built = ()
        stepper.prepare()
        found.append(stepper.state.density[np.argsort(stepper.state.ident)])
    steps = np.abs(np.diff(found, axis=0)) / np.median(found)
    assert np.ptp(np.array(found)[:, ident]) > 0.05 * np.median(found) and steps.max() < 0.01
