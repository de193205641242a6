"""Parts of a tank's mesh that lie in each other: their normals point out of what is inside, by turns."""

import itertools

import meshio
import numpy as np
import pytest
import pyvista

from sdph.engine.walls import nested, shapes
from sdph.schema import CaseError


def balls(path, *given):
    """A mesh of balls, each by its radius [m], x of its middle [m] and whether its normals point outwards."""
    points, triangles, first = [], [], 0
    for radius, x, outwards in given:
        ball = pyvista.Icosphere(radius=radius, center=(x, 0.0, 0.0), nsub=2)
        faces = ball.regular_faces if outwards else ball.regular_faces[:, ::-1]
        points, triangles, first = [*points, ball.points], [*triangles, faces + first], first + ball.n_points
    meshio.write_points_cells(path, np.concatenate(points), [("triangle", np.concatenate(triangles))])
    return shapes.Mesh(str(path))


OUT, IN = True, False
TANK, BODY, HOLE, BESIDE = (1.0, 0.0), (0.4, 0.2), (0.1, 0.3), (0.2, -0.6)


@pytest.mark.parametrize("given", [
    [(*TANK, OUT)], [(*TANK, OUT), (*BODY, IN)], [(*BODY, IN), (*TANK, OUT), (*BESIDE, IN)],
    [(*TANK, OUT), (*BODY, IN), (*HOLE, OUT)], [(*TANK, OUT), (1.0, 3.0, OUT)],
])  # fmt: skip
def test_bodies_in_a_tank_and_rooms_in_bodies_are_known(tmp_path, given):
    tank = balls(tmp_path / "tank.stl", *given)
    exact = sum((1.0 if outwards else -1.0) * radius**3 for radius, _, outwards in given)
    assert tank.volume == pytest.approx(4.0 / 3.0 * np.pi * exact, rel=0.05)


@pytest.mark.parametrize(("given", "said"), [
    ([(*TANK, IN)], "is inside out"),
    ([(*TANK, IN), (*BODY, OUT)], r"about \(.*\) m is inside out"),
    ([(*TANK, OUT), (*BODY, OUT)], r"320 triangles about \(0.2, .*\) m lies within another"),
    ([(*TANK, OUT), (*BODY, IN), (*BESIDE, OUT)], r"about \(-0.6, .*\) m lies within another"),
])  # fmt: skip
def test_a_part_that_is_turned_is_refused(tmp_path, given, said):
    with pytest.raises(CaseError, match=said) as refused:
        balls(tmp_path / "tank.stl", *given).triangles  # noqa: B018 - read now
    assert "\n" not in str(refused.value)


BLOCK = pyvista.Box((0.3, 0.5, 0.3, 0.5, 0.0, 0.3)).triangulate()  # on the floor of a tank
WALL_TO_WALL = pyvista.Box((0.3, 0.5, 0.0, 1.0, 0.4, 0.5)).triangulate()


@pytest.mark.parametrize("body", [BLOCK, WALL_TO_WALL])
def test_a_body_that_touches_the_walls_of_its_tank_is_one(tmp_path, body):
    room = pyvista.Box((0.0, 1.0, 0.0, 1.0, 0.0, 1.0)).triangulate()
    for turned in (True, False):
        faces = body.regular_faces[:, ::-1] if turned else body.regular_faces
        points = np.concatenate([room.points, body.points])
        triangles = np.concatenate([room.regular_faces, faces + room.n_points])
        path = tmp_path / f"{turned}.stl"
        meshio.write_points_cells(path, points, [("triangle", triangles)])
        if turned:
            assert shapes.Mesh(str(path)).volume == pytest.approx(1.0 - body.volume, rel=1e-5)
        else:
            with pytest.raises(CaseError, match="lies within another"):
                shapes.Mesh(str(path)).triangles  # noqa: B018


def test_triangles_without_a_size_are_no_part(tmp_path):
    path, ball = tmp_path / "tank.stl", pyvista.Icosphere(nsub=2)
    points = np.concatenate([ball.points, [(2.0, 0.0, 0.0), (3.0, 0.0, 0.0), (4.0, 0.0, 0.0)]])
    triangles = np.concatenate([ball.regular_faces, [[ball.n_points, ball.n_points + 1, ball.n_points + 2]]])
    meshio.write_points_cells(path, points, [("triangle", triangles)])
    assert shapes.Mesh(str(path)).volume == pytest.approx(ball.volume, rel=1e-5)


def test_parts_are_told_in_any_order(tmp_path):
    given = [(*TANK, OUT), (*BODY, OUT), (*HOLE, OUT)]
    for order in itertools.permutations(given):
        mesh = meshio.read(balls_only(tmp_path / "tank.stl", *order))
        faces = np.insert(mesh.cells_dict["triangle"], 0, 3, axis=1).ravel()
        found = sorted(nested.parts(pyvista.PolyData(mesh.points, faces).clean()), key=lambda part: part.middle[0])
        assert [part.within for part in found] == [False, True, False]
        assert [part.wrong for part in found] == [False, True, False]


def balls_only(path, *given):
    balls(path, *given)
    return path


@pytest.mark.parametrize(("turned", "fine"), [([], True), ([0], False), ([3, 4, 5], False)])
@pytest.mark.parametrize("dimensions", [2, 3])
def test_facets_that_look_to_different_sides_are_refused(turned, fine, dimensions):
    """A circle of lines, or a ball, of which some facets are turned round."""
    if dimensions == 2:
        ring = np.array([[np.cos(a), np.sin(a)] for a in np.linspace(0.0, 2.0 * np.pi, 13)[:-1]])
        corners = np.stack([ring, np.roll(ring, -1, axis=0)], axis=1)
    else:
        ball = pyvista.Icosphere(radius=1.0, nsub=1)
        corners = np.asarray(ball.points, float)[ball.faces.reshape(-1, 4)[:, 1:]]
    corners[turned] = corners[turned, ::-1]
    if fine:
        nested.refuse_mixed(corners, "tank.mesh")
    else:
        with pytest.raises(CaseError, match="tank.mesh: normals of facets beside each other look to different sides"):
            nested.refuse_mixed(corners, "tank.mesh")


def test_faces_of_a_plate_and_branches_of_sheets_are_not_mixed():
    """Both faces of a sheet of no thickness share all sides; three sheets that meet have no common way."""
    square = np.array([[[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0], [0, 1, 0]]], float)
    nested.refuse_mixed(np.concatenate([square, square[:, ::-1]]), "walls.mesh")
    wing = np.array([[[1, 0, 0], [0, 1, 0], [0, 0, 1]]], float)
    nested.refuse_mixed(np.concatenate([square, wing]), "walls.mesh")
