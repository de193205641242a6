"""Points on facets: one for each spacing^2, evenly apart, whatever the facets are."""

import meshio
import numpy as np
import pytest
import pyvista
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree
from scipy.spatial.distance import cdist

from sdph.engine.walls import facets

SPACING = 0.05


def triangles(drawn) -> np.ndarray:
    drawn = drawn.triangulate()
    return np.asarray(drawn.points, float)[drawn.faces.reshape(-1, 4)[:, 1:]]


def vessel(resolution: int) -> np.ndarray:
    """A closed cylinder, R = 0.25 m, H = 0.8 m, as CAD makes it: sides of slivers from end to end, ends as fans."""
    return triangles(pyvista.Cylinder(radius=0.25, height=0.8, direction=(0, 0, 1), resolution=resolution))


def ball(rounds: int) -> np.ndarray:
    return triangles(pyvista.Icosphere(radius=0.5, nsub=rounds))


@pytest.mark.parametrize(
    "corners",
    [vessel(24), vessel(400), ball(1), ball(3), ball(5), triangles(pyvista.Plane(i_resolution=1, j_resolution=1))],
    ids=["slivers", "thinner slivers", "large", "like the spacing", "0.2 of the spacing", "two triangles"],
)
def test_points_stand_one_spacing_apart(corners):
    points, normals, *_ = facets.spread(corners, SPACING)
    area = facets.sizes(corners).sum()
    assert len(points) == round(area / SPACING**2)
    apart = cKDTree(points).query(points, k=2)[0][:, 1] / SPACING
    bare = cKDTree(points).query(corners.mean(axis=1))[0].max() / SPACING
    print(f"{len(points)} points, nearest {apart.min():.3f} to {apart.max():.3f}, bare {bare:.3f}")
    assert apart.min() > 0.35 and np.percentile(apart, 2) > 0.5 and apart.max() < 1.4 and bare < 1.0
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0, rtol=1e-12)


def sheet(across: int, along: int) -> np.ndarray:
    return triangles(pyvista.Plane(i_resolution=across, j_resolution=along))


@pytest.mark.parametrize("corners", [sheet(1, 1), sheet(1, 400), sheet(4, 800), sheet(100, 100)], ids=len)
def test_walls_fill_their_room_evenly(corners):
    """Each sixteenth sample in the order of the facets, where points began, was in one column of four: points there had
    a 20th of their room, and elsewhere gaps of four spacings. All points counted alike, and their number half a spacing
    in front was 1.2 to 6 times its mean in places."""
    points, normals, _, share = facets.spread(corners, SPACING)
    ticks = np.linspace(-0.3, 0.3, 25)
    probes = np.stack([*np.meshgrid(ticks, ticks), np.full((25, 25), 0.5 * SPACING * normals[0, 2])], axis=-1)
    found = sum(
        share @ kernel(cdist(points - (layer + 0.5) * SPACING * normals, probes.reshape(-1, 3)) / (1.3 * SPACING))
        for layer in range(3)
    )
    print(f"{found.std() / found.mean():.3f}, up to {found.max() / found.mean():.3f}")
    assert share.mean() == pytest.approx(1.0, rel=1e-12)
    assert found.std() < 0.05 * found.mean() and found.max() < 1.15 * found.mean()


def kernel(q):
    """Wendland's C2, up to a factor."""
    return np.maximum(1.0 - 0.5 * q, 0.0) ** 4 * (1.0 + 2.0 * q)


def test_points_lie_on_a_ball_and_their_normals_point_outwards():
    points, normals, *_ = facets.spread(ball(4), SPACING)
    radius = np.linalg.norm(points, axis=1)
    assert radius.min() > 0.498 and radius.max() < 0.501  # of facets, and planes through them
    assert np.einsum("ij,ij->i", points, normals).min() > 0.49


@settings(max_examples=30, deadline=None)
@given(st.lists(st.floats(0.003, 3.0), min_size=1, max_size=20), st.integers(0, 2**31))
def test_a_chain_of_lines_is_strewn_evenly(lengths, seed):
    angles = np.cumsum(np.random.default_rng(seed).uniform(-0.1, 0.1, len(lengths)))
    steps = np.array(lengths)[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    ends = np.concatenate([np.zeros((1, 2)), np.cumsum(steps, axis=0)])
    points, normals, *_ = facets.spread(np.stack([ends[:-1], ends[1:]], axis=1), SPACING)
    assert len(points) == max(1, round(sum(lengths) / SPACING))
    step = np.linalg.norm(np.diff(points, axis=0), axis=1)
    even = sum(lengths) / len(points)
    assert np.all(step <= even * (1 + 1e-9)) and np.all(step > 0.9 * even)
    assert np.all(normals[:, 1] >= np.cos(np.abs(angles).max()) - 1e-9)


def test_facets_without_a_size_are_left_out(tmp_path):
    places = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0]], float)
    meshio.Mesh(places, [("triangle", np.array([[0, 1, 2], [0, 1, 3]]))]).write(tmp_path / "flat.vtk")
    assert len(facets.read(str(tmp_path / "flat.vtk"), 3)) == 1


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_plane_facets_in_any_order_leave_no_gap(seed):
    """A round tube and a wall whose facets come shuffled, each 1.3 spacings long: points stand one spacing apart along
    them, also where they close. In the order of the file gaps are up to two facets."""
    turn = np.linspace(0.0, 2.0 * np.pi, 25)
    rings = [np.array([np.cos(turn), np.sin(turn)]).T, np.array([np.linspace(-2.0, 2.0, 17), np.full(17, -3.0)]).T]
    corners = np.concatenate([np.stack([ends[:-1], ends[1:]], axis=1) for ends in rings])
    corners = corners[np.random.default_rng(seed).permutation(len(corners))]
    spacing = facets.sizes(corners).mean() / 1.3
    points, *_ = facets.spread(corners, spacing)
    assert len(points) == round(facets.sizes(corners).sum() / spacing)
    round_it = points[np.hypot(*points.T) < 1.5]
    turns = np.sort(np.arctan2(round_it[:, 1], round_it[:, 0]))
    gaps = np.sort(np.diff(turns, append=turns[0] + 2.0 * np.pi))
    assert gaps[-1] < 1.1 * spacing


def box_with_sheet(dimensions: int) -> np.ndarray:
    """Facets of a unit box, normals inwards, and of a sheet x = 0.5 in it, 0.2 to 0.8 of its height, from both sides;
    in three dimensions its faces are cut along different diagonals."""
    if dimensions == 2:
        rim = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
        sheet = np.array([[0.5, 0.2], [0.5, 0.8]])
        return np.concatenate([np.stack([rim, np.roll(rim, -1, axis=0)], axis=1), [sheet, sheet[::-1]]])
    box = triangles(pyvista.Box((0.0, 1.0, 0.0, 1.0, 0.0, 1.0)))[:, ::-1]
    a, b, c, d = np.array([[0.5, 0.2, 0.2], [0.5, 0.8, 0.2], [0.5, 0.8, 0.8], [0.5, 0.2, 0.8]])
    return np.concatenate([box, [[a, b, c], [a, c, d], [a, d, b], [b, d, c]]])


@pytest.mark.parametrize("dimensions", [2, 3])
def test_both_sides_of_a_sheet_without_thickness_are_free(dimensions):
    """A baffle of a gas's mesh has two faces in one place: what was beside it counted as behind it, and a bed had a
    hole there."""
    rng = np.random.default_rng(0)
    places = rng.uniform(-0.2, 1.2, (4000, dimensions))
    inside = ((places > 0.0) & (places < 1.0)).all(axis=1)
    beside = np.abs(places[:, 0] - 0.5)
    past = np.maximum(np.abs(places[:, 1:] - 0.5) - 0.3, 0.0)
    sheet = np.hypot(beside, np.linalg.norm(past, axis=1))
    wall = np.minimum(places, 1.0 - places).min(axis=1)
    found = facets.Surface(box_with_sheet(dimensions)).distance(places)
    np.testing.assert_array_equal(found > 0.0, inside)
    np.testing.assert_allclose(found[inside], np.minimum(sheet, wall)[inside], atol=1e-6)
