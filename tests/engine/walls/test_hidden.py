"""A surface that lies in the sides of the domain, or touches them, is their wall, and there once."""

import math

import meshio
import numpy as np
import pytest
from builders import simulation
from grain_boxes import SPACING, box

from sdph.engine.walls import hidden, sides

SIDE = 0.06  # m
CORNERS = SIDE * np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])


def drawn(path, points, closed=True) -> str:
    """A line through points (P, 2) [m], what it encloses to its left."""
    ends = np.column_stack((np.arange(len(points)), np.arange(1, len(points) + 1)))[: None if closed else -1]
    meshio.Mesh(np.pad(points, ((0, 0), (0, 1))), [("line", ends % len(points))]).write(path)
    return str(path)


def circle(count: int) -> np.ndarray:
    """A circle that touches all four sides."""
    turn = 2.0 * math.pi * np.arange(count) / count
    return 0.5 * SIDE * (1.0 + np.column_stack((np.cos(turn), np.sin(turn))))


def boxed(**walls):
    return box(["granular_pressure", "walls"], (SIDE, SIDE), 0.5, (), walls=walls)


def densest(case, folder) -> float:
    """Largest volume fraction of grains at the start."""
    folder.mkdir()
    stepper = simulation(case, folder).stepper
    stepper.prepare()
    return float((stepper.state.density / case.grains.density).max())


def test_a_mesh_in_the_sides_is_there_once(tmp_path):
    meshed = densest(boxed(mesh=drawn(tmp_path / "sides.vtk", CORNERS)), tmp_path / "meshed")
    assert meshed == pytest.approx(densest(boxed(), tmp_path / "plain"), rel=0.02)


@pytest.mark.parametrize("count", [24, 200])
def test_sides_that_a_mesh_touches_are_behind_it(tmp_path, count):
    placed = sides.dummies(boxed(mesh=drawn(tmp_path / "circle.vtk", circle(count))))
    assert (placed.whose[:, 0] > 0).all()
    assert len(placed.table) > 0.9 * math.pi * SIDE / SPACING * sides.LAYERS


def test_sides_that_a_mesh_ends_in_go_on_behind_it(tmp_path):
    """The corner between an upright plate and the floor is filled by the floor."""
    plate = np.array([[0.5, 1.0], [0.5, 0.0]]) * SIDE  # grains to its left: x > 0.03
    kept = sides.dummies(boxed(mesh=drawn(tmp_path / "plate.vtk", plate, closed=False)))
    plain = sides.dummies(boxed())
    floor = [(own.whose[:, 0] == 0) & (own.table[:, 1] < 0.0) for own in (kept, plain)]
    assert floor[0].sum() == floor[1].sum()
    left = [
        (own.whose[:, 0] == 0) & (own.table[:, 0] < 0.0) & (abs(own.table[:, 1] - 0.03) < 0.01) for own in (kept, plain)
    ]
    assert left[1].any() and not left[0].any()


def test_what_is_behind_a_ring_of_facets_is_hidden_but_not_under_its_rim():
    turn = 2.0 * math.pi * np.arange(24) / 24
    low = np.column_stack((np.cos(turn), np.sin(turn), np.zeros(24)))
    high, after = low + np.array([0.0, 0.0, 2.0]), np.roll(np.arange(24), -1)
    facets = np.concatenate(
        [np.stack((low, high, low[after]), axis=1), np.stack((low[after], high, high[after]), axis=1)]
    )  # normals to the axis
    places = np.array([[1.2, 0.0, 1.0], [0.5, 0.0, 1.0], [1.2, 0.0, -0.1], [0.0, 0.0, -0.1]])
    assert hidden.behind(facets, places).tolist() == [True, False, False, False]
    assert hidden.behind(facets, places[:0]).tolist() == []  # of a domain without walls of its own
