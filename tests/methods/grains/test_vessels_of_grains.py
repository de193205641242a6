"""Surface meshes as walls of grains: where one is open is told, and grains never stand around a vessel that they were
to fill."""

import math

import meshio
import numpy as np
import pytest
import pyvista

from sdph.case import read as cases
from sdph.cli import main
from sdph.engine.state import positions
from sdph.engine.walls import facets
from sdph.methods.grains import start
from sdph.schema import CaseError

SPACING = 0.01
BED = {"shape": "walls", "volume_fraction": 0.5, "temperature_K": 300.0}


def tube(capping: bool):
    """A cylinder, radius and height 0.1 and 0.2 m, of triangles with normals outwards, as CAD writes them."""
    return pyvista.Cylinder(
        center=(0.15, 0.15, 0.15), direction=(0, 0, 1), radius=0.1, height=0.2, resolution=48, capping=capping
    ).triangulate()


def funnel() -> pyvista.PolyData:
    """Sides of a funnel that is open above and below, normals towards the grains in it, four neighbours of its 288
    triangles missing, half way up."""
    angle = 2.0 * math.pi * np.arange(49) / 48
    rings = np.array([
        np.stack([0.15 + r * np.cos(angle), 0.15 + r * np.sin(angle), np.full(49, z)], axis=1)
        for r, z in ((0.03, 0.05), (0.05, 0.11), (0.08, 0.2), (0.1, 0.25))
    ])  # fmt: skip
    rings[:, -1] = rings[:, 0]
    quads = np.stack([rings[:-1, :-1], rings[:-1, 1:], rings[1:, 1:], rings[1:, :-1]], axis=2)
    quads = np.delete(quads.reshape(-1, 4, 3), [48 + 10, 48 + 11], axis=0)
    triangles = np.concatenate([quads[:, [0, 2, 1]], quads[:, [0, 3, 2]]])
    cells = np.insert(np.arange(3 * len(triangles)).reshape(-1, 3), 0, 3, axis=1)
    return pyvista.PolyData(triangles.reshape(-1, 3), cells.ravel())


def table(mesh, dimensions=3, **region) -> dict:
    return {
        "dimensions": dimensions, "effects": ["walls", "gravity", "friction", "granular_pressure"],
        "run": {"end_time_s": 0.01, "output_interval_s": 0.01},
        "domain": {"size_m": [0.3] * dimensions, "gravity_m_s2": [0.0] * (dimensions - 1) + [-9.81]},
        "resolution": {"spacing_mm": 1e3 * SPACING, "cell_mm": 30.0},
        "gas": {"density_kg_m3": 1.2, "viscosity_Pa_s": 1.8e-5, "conductivity_W_m_K": 0.026,
                "heat_capacity_J_kg_K": 1006.0, "temperature_K": 293.0},
        "grains": {"density_kg_m3": 2500.0, "diameter_mm": 0.5, "heat_capacity_J_kg_K": 840.0,
                   "conductivity_W_m_K": 1.0},
        "walls": {"source": "mesh", "mesh": str(mesh)},
        "particles": {"bed": BED | region},
        "boundaries": {"walls": {"kind": "wall"}},
    }  # fmt: skip


def told(mesh, dimensions=3, **region) -> tuple[list[str], np.ndarray]:
    """Notices of a case that a mesh holds, and the places of its grains."""
    notices: list[str] = []
    state = start.fill(cases.from_table(table(mesh, dimensions, **region)), (), notices)
    return notices, positions(state)[:, :dimensions]


def test_a_funnel_with_a_hole_says_where_it_is(tmp_path):
    funnel().save(tmp_path / "funnel.stl")
    line = told(tmp_path / "funnel.stl", height_m=0.1)[0][0]
    triangles = facets.read(str(tmp_path / "funnel.stl"), 3)
    mouth, hole, top = facets.Surface(triangles).rims()
    assert mouth[1] == pytest.approx(2.0 * math.pi * 0.03, rel=0.01) and mouth[0] == pytest.approx((0.15, 0.15, 0.05))
    assert top[1] == pytest.approx(2.0 * math.pi * 0.1, rel=0.01) and 0.2 < hole[1] < 0.3
    assert "funnel.stl' is open at the places about" in line and "grains pass there" in line
    assert all(", ".join(f"{a:.4g}" for a in rim[0]) in line for rim in (hole, mouth, top))


def test_a_closed_vessel_whose_normals_point_outwards_is_refused(tmp_path, capsys):
    """Its bed stood around it: 29 % of the mass that was meant, at radii above the vessel's."""
    tube(True).save(tmp_path / "out.stl")
    with pytest.raises(CaseError, match='particles.bed.shape = "walls", and .*out.stl.* closed and inside out'):
        told(tmp_path / "out.stl")
    (tmp_path / "case.toml").write_text(cases.dumps(cases.from_table(table(tmp_path / "out.stl"))))
    for words in (["explain"], ["run", "--out", str(tmp_path / "run")]):
        assert main([words[0], str(tmp_path / "case.toml"), *words[1:]]) == 2
        assert "closed and inside out" in capsys.readouterr().err


def test_the_same_vessel_turned_holds_its_bed_and_is_not_told_of(tmp_path):
    tube(True).flip_faces().save(tmp_path / "in.stl")
    notices, places = told(tmp_path / "in.stl")
    assert not [line for line in notices if "open" in line or "inside out" in line]
    assert np.hypot(*(places[:, :2] - 0.15).T).max() < 0.1
    inner = facets.enclosed(facets.read(str(tmp_path / "in.stl"), 3))
    assert inner == pytest.approx(24 * math.sin(math.pi / 24) * 0.01 * 0.2, rel=1e-6)


def test_an_open_vessel_inside_out_runs_and_is_told_of(tmp_path):
    tube(False).save(tmp_path / "open.stl")
    notices = told(tmp_path / "open.stl")[0]
    assert "is open at the places" in notices[0] and 'particles.bed.shape = "walls"' in notices[1]
    assert "inside out" in notices[1]


def test_grains_around_a_closed_body_are_what_was_meant(tmp_path):
    tube(True).save(tmp_path / "body.stl")
    around = {"shape": "box", "lower_m": [0.0] * 3, "upper_m": [0.3] * 3}
    notices, places = told(tmp_path / "body.stl", **around)
    assert len(places) > 1000 and not [line for line in notices if "inside out" in line or "is open" in line]


def test_an_open_plate_elsewhere_lets_no_grain_into_a_closed_body(tmp_path):
    """A thousand grains stood deep in the body as soon as any part of the walls was open."""
    body, plate = tube(True), pyvista.Plane(center=(0.03, 0.15, 0.15), direction=(1, 0, 0), i_size=0.1, j_size=0.04)
    body.save(tmp_path / "body.stl")
    body.append_polydata(plate.triangulate()).save(tmp_path / "both.stl")
    box = {"shape": "box", "lower_m": [0.05, 0.05, 0.05], "upper_m": [0.25] * 3}
    alone, beside = (told(tmp_path / name, **box)[1] for name in ("body.stl", "both.stl"))
    np.testing.assert_array_equal(beside, alone)
    case = cases.from_table(table(tmp_path / "both.stl", **box))
    outside = 0.2**2 * 0.2 - 24 * math.sin(math.pi / 24) * 0.01 * 0.2
    assert start.meant(case, case.particles["bed"]) == pytest.approx(0.5 * 2500.0 * outside, rel=0.02)
    notices = told(tmp_path / "both.stl")[0]
    assert any("which is open and has 2 parts" in line for line in notices)


def test_a_plate_and_a_polygon_in_two_dimensions(tmp_path):
    places, ends = np.array([(0.05, 0.1, 0.0), (0.25, 0.1, 0.0), (0.15, 0.25, 0.0)]), np.array([[0, 1], [1, 2], [2, 0]])
    box = {"shape": "box", "lower_m": [0.0, 0.0], "upper_m": [0.3, 0.3]}
    meshio.write_points_cells(tmp_path / "plate.vtk", places, [("line", ends[:1])])
    meshio.write_points_cells(tmp_path / "in.vtk", places, [("line", ends)])
    meshio.write_points_cells(tmp_path / "out.vtk", places, [("line", ends[:, ::-1])])
    plate = told(tmp_path / "plate.vtk", 2, **box)[0][0]
    assert "open at the places about (0.05, 0.1) m; (0.25, 0.1) m" in plate
    to_side = np.array([(0.0, 0.1, 0.0), (0.1, 0.1, 0.0)])
    meshio.write_points_cells(tmp_path / "baffle.vtk", to_side, [("line", ends[:1])])
    (baffle,) = [line for line in told(tmp_path / "baffle.vtk", 2, **box)[0] if "is open" in line]
    assert "open at the places about (0.1, 0.1) m:" in baffle  # its other end is in a side of the domain
    assert not [line for line in told(tmp_path / "in.vtk", 2)[0] if "open" in line]
    with pytest.raises(CaseError, match="closed and inside out"):
        told(tmp_path / "out.vtk", 2)
