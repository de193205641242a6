"""Liquid at rest in tanks of every shape, and turning with one like a solid."""

import itertools
import math

import numpy as np
import pytest

from sdph.case import read as cases
from sdph.engine import state as particles
from sdph.engine.walls import shapes
from sdph.methods.liquids.loads import loads, wall_loads
from sdph.methods.liquids.method import LiquidStepper
from sdph.schema import CaseError

G = 9.81  # m/s2
RADIUS = 0.5  # m
ROUND = {"centre_m": [0.5, 0.5, 0.5], "radius_m": RADIUS}
SHAPES = {
    "sphere": {"shape": "sphere", **ROUND},
    "capsule": {"shape": "capsule", "length_m": 0.4, **ROUND},
    "cylinder": {"shape": "cylinder", "length_m": 0.8, **ROUND},
    "box": {"shape": "box", "lower_m": [0.0, 0.0, 0.0], "upper_m": [0.8, 0.8, 0.8]},
    "mesh": {"shape": "mesh"},
}


def settled(tank: dict, spacing: float, seconds: float, **sections) -> LiquidStepper:
    """A tank half full of a viscous liquid, some time after it was filled."""
    table = {
        "dimensions": 3,
        "effects": ["gravity", "density_diffusion", "liquid_damping", "tank", *sections],
        "run": {"end_time_s": 1.0, "output_interval_s": 1.0},
        "domain": {"size_m": [1.0, 1.0, 1.0], "gravity_m_s2": [0.0, 0.0, -G]},
        "resolution": {"spacing_mm": 1e3 * spacing},
        "liquid": {"density_kg_m3": 1000.0, "sound_speed_m_s": 10.0 * math.sqrt(G * 0.5)},
        "liquid_damping": {"alpha": 0.3},
        "tank": {"slip": "free_slip", **tank},
        "pools": {"water": {"shape": "tank", "fill": 0.5}},
    } | sections
    own = LiquidStepper(cases.from_table(table))
    while own.time < seconds:
        own.step(seconds - own.time)
    return own


def mesh_of_a_ball(folder, centre=(0.5, 0.5, 0.5)) -> str:
    import meshio
    import pyvista

    ball = pyvista.Icosphere(radius=RADIUS, center=centre, nsub=4)
    path = str(folder / "ball.stl")
    meshio.write_points_cells(path, ball.points, [("triangle", ball.faces.reshape(-1, 4)[:, 1:])])
    return path


@pytest.mark.parametrize("name", SHAPES)
def test_liquid_comes_to_rest(name, tmp_path):
    shape = dict(SHAPES[name])
    if name == "mesh":
        shape["mesh"] = mesh_of_a_ball(tmp_path)
    own = settled(shape, 0.1, 5.0)
    weight = G * own.state.mass[own.active].sum()
    speed = np.linalg.norm(particles.velocities(own.state)[own.active], axis=1).max()
    assert speed < 0.05 * math.sqrt(G * RADIUS)  # five spacings in a radius: the lattice still rearranges
    for load in (loads(own), wall_loads(own)):
        assert load[2] == pytest.approx(-weight, rel=0.01)
        assert np.abs(load[:2]).max() < 0.01 * weight


def test_liquid_turns_with_its_tank_like_a_solid():
    """The surface becomes z = z_0 + omega^2 r^2/(2 g), within a spacing."""
    spacing, omega = 0.07, 3.5
    # its axis is the frame's
    tank = {"shape": "cylinder", "length_m": 0.8, "radius_m": RADIUS, "centre_m": [0.0, 0.0, 0.0]}
    own = settled(tank, spacing, 3.0, frame={"spin_rad_s": [0.0, 0.0, omega]})
    x = particles.positions(own.state)[own.active]
    radius = np.hypot(x[:, 0], x[:, 1])
    edges = np.linspace(0.0, RADIUS, 6)
    middle, top = 0.5 * (edges[:-1] + edges[1:]), []
    for inner, outer in itertools.pairwise(edges):
        # the five highest of a ring
        top.append(np.sort(x[(radius >= inner) & (radius < outer), 2])[-5:].mean() + 0.5 * spacing)
    rise = omega**2 * middle**2 / (2.0 * G)
    assert np.ptp(rise) > 1.5 * spacing
    assert np.abs(np.array(top) - rise - np.mean(np.array(top) - rise)).max() < spacing


def test_walls_of_a_mesh_whose_faces_lie_on_the_lattice(tmp_path):
    """Lattice points on a face have no way from it, and go along its normal."""
    import pyvista

    spacing, path = 0.5, tmp_path / "box.stl"
    pyvista.Box((0.0, 5.25, 0.0, 4.0, 0.0, 4.0)).triangulate().save(path)
    shape = shapes.Mesh(str(path))
    for layer in range(3):
        points = shape.shell((layer + 0.5) * spacing, spacing)
        np.testing.assert_allclose(shape.distance(points), (layer + 0.5) * spacing, rtol=1e-5)


def test_a_mesh_that_cannot_be_a_tank_is_refused(tmp_path):
    import meshio

    path = tmp_path / "open.stl"
    meshio.write_points_cells(str(path), np.eye(3), [("triangle", np.array([[0, 1, 2]]))])
    with pytest.raises(CaseError, match="open edges"):
        settled({"shape": "mesh", "mesh": str(path)}, 0.1, 0.0)
    with pytest.raises(CaseError, match="cannot be read"):
        settled({"shape": "mesh", "mesh": str(tmp_path / "none.stl")}, 0.1, 0.0)
    corners = np.vstack((np.zeros(3), np.eye(3))) + 5.0  # far from the origin: the sign is the volume's
    inwards = np.array([[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]])
    for faces, right in ((inwards, False), (inwards[:, ::-1], True)):
        meshio.write_points_cells(str(path), corners, [("triangle", faces)])
        if right:
            assert shapes.Mesh(str(path)).distance(np.full((1, 3), 5.1)) < 0.0
            continue
        with pytest.raises(CaseError, match="is inside out: its normals point into it"):
            _ = shapes.Mesh(str(path)).triangles


MIDDLE = np.array([0.5, 0.5, 0.5])
PIPE = shapes.Cylinder(MIDDLE - [0.0, 0.0, RADIUS], 0.05, 0.1, 0.1, open_top=True)
DRAWN = {
    "sphere": shapes.Capsule(MIDDLE, RADIUS),
    "capsule": shapes.Capsule(MIDDLE, RADIUS, 0.4),
    "cylinder": shapes.Cylinder(MIDDLE, RADIUS, 0.8, 0.1),
    "open box": shapes.Box(np.zeros(3), np.array([0.8, 0.6, 0.4]), ((1, 1),)),
    "channel": shapes.Box(np.zeros(2), np.array([0.8, 0.6]), ((0, 0), (0, 1))),
    "disc": shapes.Disc(MIDDLE[:2], RADIUS),
}


@pytest.mark.parametrize("name", DRAWN)
def test_a_tank_is_drawn_where_its_walls_are(name):
    shape = DRAWN[name]
    drawn = shape.surface()
    away = np.abs(shape.distance(drawn.points[:, : 2 if name in ("channel", "disc") else 3].astype(float)))
    assert away.max() < 1e-6
    size = drawn.area or drawn.compute_cell_sizes()["Length"].sum()
    exact = {
        "sphere": math.pi,
        "capsule": 1.4 * math.pi,
        "cylinder": 1.3 * math.pi,
        "open box": 1.76,
        "channel": 1.6,
        "disc": math.pi,
    }
    assert size == pytest.approx(exact[name], rel=0.02)  # round ones are drawn by facets


def test_a_pipe_is_drawn_with_its_tank():
    drawn = shapes.Joined(DRAWN["sphere"], PIPE).surface()
    assert drawn.area == pytest.approx(DRAWN["sphere"].surface().area + PIPE.surface().area)
    assert drawn.bounds[4] == pytest.approx(-0.05)
