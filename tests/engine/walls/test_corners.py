"""Points beyond hollow edges and corners of a mesh: as many as there is room, seen from in front of all facets
there."""

import itertools

import meshio
import numpy as np
import pytest
import pyvista
from grain_boxes import SPACING, box, started
from scipy.integrate import quad
from scipy.spatial import cKDTree

from sdph.engine.walls import corners, facets
from sdph.laws import kernels

REACH = 3.0 * SPACING
R, H = 0.03, 0.08


def triangles(drawn, inwards=True) -> np.ndarray:
    drawn = drawn.triangulate()
    return np.asarray(drawn.points, float)[drawn.faces.reshape(-1, 4)[:, 1:]][:, :: -1 if inwards else 1]


def cylinder(resolution) -> np.ndarray:
    return triangles(pyvista.Cylinder(radius=R, height=H, direction=(0, 0, 1), resolution=resolution))


def cube(inwards=True) -> np.ndarray:
    return triangles(pyvista.Cube(x_length=H, y_length=H, z_length=H), inwards)


def ball(inwards=True) -> np.ndarray:
    return triangles(pyvista.Icosphere(radius=R, nsub=4), inwards)


ABOUT_A_CUBE = 12 * H * np.pi * REACH**2 / 4.0 + 4.0 / 3.0 * np.pi * REACH**3
RIM = 2.0 * quad(lambda out: 2.0 * np.pi * (R + out) * np.sqrt(REACH**2 - out**2), 0.0, REACH)[0]


@pytest.mark.parametrize(
    ("surface", "volume"),
    [
        (cube(), ABOUT_A_CUBE), (cube(inwards=False), 0.0), (cylinder(24), RIM), (cylinder(400), RIM), (ball(), 0.0),
        (ball(inwards=False), 0.0),
    ],
    ids=["cube", "block", "cylinder", "slivers", "ball", "solid ball"],
)  # fmt: skip
def test_there_are_as_many_as_there_is_room(surface, volume):
    """The facets of a round vessel lie a little within it."""
    found = corners.spread(surface, SPACING, REACH)
    assert len(found.place) == pytest.approx(volume / SPACING**3, rel=0.02)
    if volume:
        off = facets.Surface(surface).distance(found.place)
        assert -off == pytest.approx(np.linalg.norm(found.place - found.foot, axis=1), abs=0.2 * SPACING)
        assert cKDTree(found.place).query(found.place, 2)[0][:, 1].min() > 0.4 * SPACING


LAYERS_OF_A_BALL = 4.0 * np.pi * R**2 * REACH


@pytest.mark.parametrize(
    ("surface", "volume"),
    [
        (cube(), 0.0), (cylinder(24), np.pi * REACH**2 * H), (cylinder(400), np.pi * REACH**2 * H),
        (cylinder(24)[:, ::-1], -np.pi * REACH**2 * H),
        (ball(), 4.0 / 3.0 * np.pi * ((R + REACH) ** 3 - R**3) - LAYERS_OF_A_BALL),
        (ball(inwards=False), 4.0 / 3.0 * np.pi * (R**3 - (R - REACH) ** 3) - LAYERS_OF_A_BALL),
    ],
    ids=["cube", "pipe", "slivers", "solid cylinder", "ball", "solid ball"],
)  # fmt: skip
def test_layers_behind_a_round_wall_are_longer_or_shorter_than_it(surface, volume):
    found = corners.rounded(surface, SPACING, REACH)
    assert found.part.sum() * SPACING**3 == pytest.approx(volume, rel=0.02, abs=1e-12)


def lines(points) -> np.ndarray:
    points = np.array(points)
    return np.stack((points, np.roll(points, -1, axis=0)), axis=1)


@pytest.mark.parametrize(("angle", "turn"), [(30.0, 150.0), (60.0, 120.0), (90.0, 90.0)])
def test_a_wedge_in_the_plane_is_as_wide_as_the_wall_turns(angle, turn):
    tip = np.radians(angle)
    side = 20.0 * SPACING * np.array([[0.0, 0.0], [1.0, 0.0], [np.cos(tip), np.sin(tip)]])
    found = corners.spread(np.stack((side[[2, 0]], side[[0, 1]])), SPACING, REACH)
    assert len(found.place) == pytest.approx(np.radians(turn) * 4.5, abs=0.51)
    assert set(found.facets.ravel().tolist()) == {0, 1}


def test_beyond_the_foot_of_a_sheet_stands_what_is_behind_the_floor_on_its_other_side():
    """Those on one side see it. A plate two spacings thick has no floor under it, which both corners fill together."""
    tip, left, right = (0.0, 0.1), (-0.1, 0.0), (0.1, 0.0)
    sheet = np.array([(left, (0.0, 0.0)), ((0.0, 0.0), tip), (tip, (0.0, 0.0)), ((0.0, 0.0), right)])
    assert len(corners.spread(sheet, SPACING, REACH).place) == 0
    half, top = SPACING, (SPACING, 0.1)
    chain = [left, (-half, 0.0), (-half, 0.1), top, (half, 0.0), right]
    plate = np.array(list(itertools.pairwise(chain)))
    found = corners.spread(plate, SPACING, REACH)
    assert np.abs(found.place[:, 0]).max() < half and found.place[:, 1].max() < 0.0 and len(found.place) in (5, 6)
    assert {frozenset(own) for own in found.facets.tolist()} == {frozenset((0, 1)), frozenset((3, 4))}


def in_a_vessel(tmp_path, corners_, fill, size=(0.16, 0.16)):
    path, points = (
        tmp_path / "vessel.vtk",
        np.pad(corners_.reshape(-1, corners_.shape[2]), ((0, 0), (0, 3 - len(size)))),
    )
    kind = "line" if len(size) == 2 else "triangle"
    meshio.Mesh(points, [(kind, np.arange(len(points)).reshape(corners_.shape[:2]))]).write(path)
    region = {"shape": "box", "lower_m": fill[0], "upper_m": fill[1], "volume_fraction": 0.5, "temperature_K": 300.0}
    axes = tuple("xyz"[: len(size)])
    return started(
        box(["granular_pressure", "walls"], size, 0.5, axes, (0.0,) * len(size), walls={"mesh": str(path)},
            particles={"bed": region}),
        tmp_path,
    ).stepper  # fmt: skip


def test_grains_that_fill_a_square_vessel_are_as_dense_in_its_corners(tmp_path):
    """12 % lack where nothing stands beyond a corner."""
    low, high = 0.04, 0.12
    square = lines([(low, low), (high, low), (high, high), (low, high)])
    density = in_a_vessel(tmp_path, square, ([low, low], [high, high])).state.density
    assert np.abs(density / np.median(density) - 1.0).max() < 0.04


def cut(across: int) -> np.ndarray:
    """A cube with sides of H about 0, each cut into so many squares along and across, of two triangles."""
    middles = [side * axis for axis in 0.5 * H * np.eye(3) for side in (-1.0, 1.0)]
    sizes = {"i_size": H, "j_size": H, "i_resolution": across, "j_resolution": across}
    return np.concatenate([triangles(pyvista.Plane(center=own, direction=own, **sizes)) for own in middles])


@pytest.mark.parametrize("across", [1, 7, 24])
def test_grains_that_fill_a_cube_are_as_dense_along_its_edges(tmp_path, across):
    """Points on facets stand in no lattice. Where all of them counted alike the first rows were off by up to 8 to 15 %,
    those along edges by 22, in corners by 34; where nothing stands beyond edges those beside them lack 11 % on average,
    and those in corners 23."""
    low, high = 0.04, 0.12
    s = in_a_vessel(tmp_path, cut(across) + 0.08, ([low] * 3, [high] * 3), (0.16,) * 3).state
    density = s.density / np.median(s.density)
    sides = sum((np.minimum(x - low, high - x) < SPACING).astype(int) for x in (s.x, s.y, s.z))
    off = [np.abs(density[sides == number] - 1.0).max() for number in range(4)]
    print("at most off, inside, at sides, edges, corners:", *(f"{most:.3f}" for most in off))
    assert off[1] < 0.03 and max(off) < 0.06


def test_who_stands_behind_a_facet_of_a_corner_does_not_see_its_dummies(tmp_path):
    """A bent sheet of two faces: those in its hollow see what stands beyond it, those on the other side do not."""
    bend, along, up = (0.08, 0.08), (0.14, 0.08), (0.08, 0.14)
    sheet = np.array([(up, bend), (bend, along), (along, bend), (bend, up)])
    around = lines([(0.01, 0.01), (0.15, 0.01), (0.15, 0.15), (0.01, 0.15)])  # a vessel of the same file
    stepper = in_a_vessel(tmp_path, np.concatenate((sheet, around)), ([0.01, 0.01], [0.15, 0.15]))
    boundary, wall, s = stepper.boundary, stepper.wall, stepper.state
    hollow, seen = (s.x > 0.08) & (s.y > 0.08), np.zeros(len(s.x), bool)
    own = boundary.beyond.corner & (np.hypot(boundary.dummies.x - 0.08, boundary.dummies.y - 0.08) < 4.0 * SPACING)
    wedge = 0.25 * np.pi * REACH**2
    assert boundary.dummies.volume[own].sum() == pytest.approx(wedge, rel=0.05)
    assert np.abs(boundary.feet[own, :2] - 0.08).max() < 1e-12
    for i in range(len(s.x)):
        seen[i] = own[wall.entries[wall.start[i] :][: wall.number[i]]].any()
    assert seen[hollow].any() and not seen[~hollow].any()


def test_what_presses_a_corner_acts_on_the_surface(tmp_path):
    low, high = 0.04, 0.12
    square = lines([(low, low), (high, low), (high, high), (low, high)])
    boundary = in_a_vessel(tmp_path, square, ([low, low], [high, high])).boundary
    corner = boundary.beyond.corner
    assert corner.sum() == 28 and not np.stack(boundary.dummies[3:6])[:, corner].any()
    feet = boundary.feet[corner, :2]
    assert np.isin(np.round(feet, 9), [low, high]).all()


@pytest.mark.parametrize(
    ("radius", "outside", "lies"), [(2.5, False, 0.395), (6.0, False, 0.351), (6.0, True, 0.300), (10.0, True, 0.309)]
)
def test_round_walls_fill_what_lies_in_them(tmp_path, radius, outside, lies):
    """The share of the kernel of a grain 0.4 spacings before a pipe or a tube of a radius [spacings] that lies in the
    wall, by quadrature. Layers of a flat wall give 2.8 % too little; layers as long as the wall 0.33 in the narrow pipe
    and 0.322 and 0.317 about the tubes."""
    radius, turn = radius * SPACING, 2.0 * np.pi * np.arange(64) / 64
    circle = np.column_stack((np.cos(turn), np.sin(turn)))
    pipe = lines(0.08 + radius * (circle[::-1] if outside else circle))
    stepper = in_a_vessel(tmp_path, pipe, ([0.07, 0.07], [0.09, 0.09]) if not outside else ([0.0, 0.0], [0.01, 0.01]))
    h, way = stepper.case.smoothing_length, radius + (0.4 if outside else -0.4) * SPACING
    axes = tuple(0.08 + way * own for own in (np.cos(turn + 0.01), np.sin(turn + 0.01)))
    wall, _ = stepper.boundary.seen(stepper.boundary.rows(axes), axes)
    sigma, sums = kernels.normalisation("cubic_spline", 2, h), []
    for i, (x, y) in enumerate(zip(*axes)):
        seen = wall.entries[wall.start[i] :][: wall.number[i]]
        sums.append(
            sum(wall.volume[w] * kernels.cubic_spline(np.hypot(x - wall.x[w], y - wall.y[w]), h, sigma) for w in seen)
        )
    assert np.mean(sums) == pytest.approx(lies, rel=0.04)


def test_a_round_wall_that_ends_at_an_edge_counts_once(tmp_path):
    """Solid half discs of radii about 6 spacings, chord upwards: of grains 0.4 spacings off a corner either way, and
    before chord and arc beside it. Where dummies stand by the edge is chance: means of nine discs."""
    turn, off = np.pi * np.arange(41) / 40, 0.4 * SPACING
    arc = np.column_stack((-np.cos(turn), -np.sin(turn)))[::-1]  # from right to left below: the solid on the right hand
    ticks = (np.arange(-60, 60) + 0.5) * 3.0 * SPACING / 60.0
    across, up = (part.ravel() for part in np.meshgrid(ticks, ticks))
    found, lies = np.zeros((2, 9, 3))
    for n, radius in enumerate(SPACING * np.linspace(5.6, 6.4, 9)):
        stepper = in_a_vessel(tmp_path, lines(0.08 + radius * arc), ([0.0, 0.13], [0.01, 0.14]))
        places = 0.08 + np.array([(radius + off, off), (radius - off, off), (radius + off, -off)])
        axes, h = tuple(np.ascontiguousarray(places.T)), stepper.case.smoothing_length
        sigma = kernels.normalisation("cubic_spline", 2, h)
        weight = (
            np.array([kernels.cubic_spline(r, h, sigma) for r in np.hypot(across, up)]) * (ticks[1] - ticks[0]) ** 2
        )
        wall, _ = stepper.boundary.seen(stepper.boundary.rows(axes), axes)
        for i, (x, y) in enumerate(places):
            lies[n, i] = weight[(np.hypot(x + across - 0.08, y + up - 0.08) < radius) & (y + up < 0.08)].sum()
            found[n, i] = sum(
                wall.volume[w] * kernels.cubic_spline(np.hypot(x - wall.x[w], y - wall.y[w]), h, sigma)
                for w in wall.entries[wall.start[i] :][: wall.number[i]]
            )
    assert found.mean(axis=0) == pytest.approx(lies.mean(axis=0), rel=0.1)


def test_the_tip_of_a_cone_has_points_of_its_own():
    """Its edges turn by little each, its corner by much."""
    tip = triangles(pyvista.Cone(height=H, radius=H, direction=(0, 0, 1), resolution=48))
    top = tip[:, :, 2].max()
    found = corners.spread(tip, SPACING, REACH)
    beyond = (found.foot[:, 2] == top).sum()
    assert beyond == pytest.approx(2.0 * np.pi * (1.0 - np.sin(np.pi / 4.0)) * 9.0, rel=0.15)  # its normal cone, R^3/3
