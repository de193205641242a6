"""A run folder holds all that its run needs: it can be moved, looked at and gone on with where its case is no more."""

import json
import shutil
from pathlib import Path

import meshio
import numpy as np
import pytest
import pyvista
import tomli_w
from test_cli import refused  # noqa: F401  (`refused` is a fixture)
from test_restart import Cut, Reporter

from sdph import cli
from sdph.case import read as cases
from sdph.effects.around import tank
from sdph.engine.walls import sides
from sdph.methods.grains import start
from sdph.running import driver, inputs, vessel
from sdph.schema import CaseError

AIR = {
    "density_kg_m3": 1.2,
    "viscosity_Pa_s": 1.8e-5,
    "conductivity_W_m_K": 0.025,
    "heat_capacity_J_kg_K": 1006.0,
    "temperature_K": 300.0,
}
SAND = {"density_kg_m3": 2500.0, "diameter_mm": 1.0, "heat_capacity_J_kg_K": 800.0, "conductivity_W_m_K": 1.0}
GRAINS = {
    "title": "grains fall on a plate", "dimensions": 2, "effects": ["gravity", "drag", "walls", "granular_pressure"],
    "run": {"end_time_s": 0.004, "output_interval_s": 0.002}, "coupling": {"window_largest_s": 0.001},
    "domain": {"size_m": [0.2, 0.2], "gravity_m_s2": [0.0, -9.81]}, "resolution": {"spacing_mm": 10.0, "cell_mm": 50.0},
    "gas": AIR, "grains": SAND, "boundaries": {"sides": {"kind": "slip_wall"}}, "walls": {"mesh": "shapes/plate.vtk"},
    "particles": {"cloud": {"shape": "box", "lower_m": [0.05, 0.11], "upper_m": [0.15, 0.16], "volume_fraction": 0.2,
    "temperature_K": 300.0}},
}  # fmt: skip
LIQUID = {
    "title": "a tank that is shaken", "dimensions": 2, "effects": ["gravity", "frame", "tank"],
    "run": {"end_time_s": 0.004, "output_interval_s": 0.002},
    "domain": {"size_m": [0.2, 0.2], "gravity_m_s2": [0.0, -9.81]}, "resolution": {"spacing_mm": 20.0},
    "liquid": {"density_kg_m3": 1000.0, "viscosity_Pa_s": 0.001, "sound_speed_m_s": 20.0},
    "pools": {"water": {"shape": "box", "lower_m": [0.0, 0.0], "upper_m": [0.2, 0.1]}}, "tank": {"shape": "box"},
    "frame": {"table": "shapes/motion.csv"},
}  # fmt: skip
MOTION = "time_s,ax_m_s2,ay_m_s2,az_m_s2,wx_rad_s,wy_rad_s,wz_rad_s\n0,0,0,0,0,0,0\n0.1,1,0,0,0,0,0\n"
EMBEDDED = ("--gas", "embedded")


def write_case(folder, table, **more):
    """A case folder with a plate and a motion in shapes/."""
    (folder / "shapes").mkdir(parents=True)
    places = np.array([[0.02, 0.1, 0.0], [0.18, 0.1, 0.0]])
    meshio.write_points_cells(folder / "shapes" / "plate.vtk", places[::-1], [("line", np.array([[0, 1]]))])
    (folder / "shapes" / "motion.csv").write_text(MOTION)
    (folder / "case.toml").write_text(tomli_w.dumps(table | more))
    return folder


@pytest.mark.parametrize(("table", "gas", "kept"), [
    (GRAINS, EMBEDDED, "inputs/walls.mesh/plate.vtk"),
    (LIQUID, (), "inputs/frame.table/motion.csv"),
    pytest.param(GRAINS, ("--gas", "openfoam"), "inputs/walls.mesh/plate.vtk", marks=pytest.mark.openfoam),
])  # fmt: skip
def test_a_run_folder_can_go_anywhere(tmp_path, monkeypatch, table, gas, kept):
    """Run from elsewhere, move it, take its case away: report, view and resume work, as if it had not been moved."""
    own, (one, other) = write_case(tmp_path / "mine", table), [tmp_path / name for name in ("here", "there")]
    one.mkdir(), other.mkdir()
    if "openfoam" in gas:
        shutil.copytree(driver.paths.gas_template(""), own / "gas")
    monkeypatch.chdir(one)
    assert cli.main(["run", "../mine", *gas, "--out", "whole", "--json"]) == 0
    assert cli.main(["run", "../mine", *gas, "--out", "part", "--json", "--until", "0.002"]) == 0
    shutil.rmtree(own)
    (one / "part").rename(other / "moved")
    text = (other / "moved" / "case.toml").read_text()
    assert kept in text and str(own) not in text and (other / "moved" / kept).is_file()
    monkeypatch.chdir(tmp_path)
    assert cli.main(["report", "there/moved"]) == 0
    assert cli.main(["view", "there/moved", "--png", "moved.png"]) == 0
    assert cli.main(["run", "--resume", "there/moved", "--json", "--until", "0.004"]) == 0
    for name in ("ledger.csv", "history.csv"):
        assert (other / "moved" / name).read_bytes() == (one / "whole" / name).read_bytes()


@pytest.mark.openfoam
def test_a_run_that_was_cut_at_its_start_begins_again_without_its_case(tmp_path):
    """With its own OpenFOAM case, not that of the template."""
    own = write_case(tmp_path / "mine", GRAINS, coupling={"gas": "openfoam", "window_largest_s": 0.001})
    shutil.copytree(driver.paths.gas_template(""), own / "gas")
    (own / "gas" / "system" / "mine").write_text("// mine\n")
    with pytest.raises(Cut):
        driver.run(cases.load(own / "case.toml"), "mine", tmp_path / "cut", own / "gas", Reporter(1))
    shutil.rmtree(own)
    shutil.rmtree(tmp_path / "cut" / "checkpoints")
    (tmp_path / "cut").rename(tmp_path / "moved")
    driver.resume(tmp_path / "moved", (), Reporter())
    assert (tmp_path / "moved" / "gas" / "system" / "mine").is_file()
    assert json.loads((tmp_path / "moved" / "summary.json").read_text())["time_s"] == 0.004


def test_a_file_after_set_is_taken_from_the_working_directory(tmp_path, monkeypatch):
    own = write_case(tmp_path / "mine", GRAINS)
    other = write_case(tmp_path / "other", GRAINS)
    monkeypatch.chdir(other)
    assert cases.load("../mine/case.toml").parameters["walls"].mesh == str(own / "shapes" / "plate.vtk")
    chosen = cases.load("../mine/case.toml", ("walls.mesh=shapes/plate.vtk",))
    assert chosen.parameters["walls"].mesh == str(other / "shapes" / "plate.vtk")


def test_another_file_is_another_case(tmp_path):
    own = write_case(tmp_path / "mine", GRAINS)
    case = cases.load(own / "case.toml", ("coupling.gas='embedded'", "run.end_time_s=0.001"))
    driver.run(case, "mine", tmp_path / "run", None, Reporter())
    with pytest.raises(CaseError, match="walls.mesh was 'inputs/walls.mesh/plate.vtk' and is '/"):
        driver.resume(tmp_path / "run", (f"walls.mesh={own}/shapes/plate.vtk", "run.end_time_s=0.002"), Reporter())


HARM = [
    ("missing", None, "no such file"),
    ("folder", None, "no such file"),
    ("empty", b"", "plate.vtk"),
    ("noise", bytes(range(256)) * 4, "plate.vtk"),
    ("another", b"# vtk DataFile Version 3.0\n", "plate.vtk"),
]  # fmt: skip


@pytest.mark.parametrize(("harm", "data", "told"), HARM)
@pytest.mark.parametrize("command", [("run",), ("explain",)])
def test_a_bad_file_is_one_line_and_leaves_no_folder(refused, tmp_path, command, harm, data, told):  # noqa: F811
    file = write_case(tmp_path / "mine", GRAINS) / "shapes" / "plate.vtk"
    file.unlink()
    if harm == "folder":
        file.mkdir()
    elif data is not None:
        file.write_bytes(data)
    line = refused(*command, "mine", *(EMBEDDED if command == ("run",) else ()))
    assert "walls.mesh" in line and told in line
    assert refused("init", "mine", "copy") == line


@pytest.mark.parametrize(
    ("text", "told"),
    [(None, "no such file"), ("a,b\n1,2\n", "has no column"), (MOTION.splitlines()[0], "two rows at least")],
)
def test_a_bad_table_is_one_line_and_leaves_no_folder(refused, tmp_path, text, told):  # noqa: F811
    file = write_case(tmp_path / "mine", LIQUID) / "shapes" / "motion.csv"
    file.unlink() if text is None else file.write_text(text)
    line = refused("run", "mine")
    assert "frame.table" in line and told in line


def test_a_path_is_a_text(tmp_path):
    with pytest.raises(CaseError, match="walls.mesh = .*must be the path of a file"):
        cases.from_table(GRAINS | {"walls": {"mesh": ["a", "b"]}})


@pytest.mark.parametrize("quote", ['"{}"', "'{}'"])
@pytest.mark.parametrize("far", [False, True])
def test_init_takes_files_and_gas_along(tmp_path, monkeypatch, capsys, quote, far):
    """Of a case of one's own: the copy stands alone, and keeps its comments."""
    own = write_case(tmp_path / "mine", GRAINS)
    path = str(own / "shapes" / "plate.vtk") if far else "shapes/plate.vtk"
    text = (own / "case.toml").read_text().replace('"shapes/plate.vtk"', quote.format(path)) + "# mine\n"
    (own / "case.toml").write_text(text)
    shutil.copytree(driver.paths.gas_template(""), own / "gas")
    (own / "gas" / "mine").write_text("mine")
    monkeypatch.chdir(tmp_path)
    assert cli.main(["init", "mine", "copy"]) == 0
    shutil.rmtree(own)
    mesh = cases.load("copy/case.toml").parameters["walls"].mesh
    assert mesh == str(tmp_path / "copy" / "inputs" / "walls.mesh" / "plate.vtk")
    assert len(meshio.read(mesh).points) == 2 and (tmp_path / "copy" / "gas" / "mine").is_file()
    assert quote != '"{}"' or "# mine" in (tmp_path / "copy" / "case.toml").read_text()


def ball(path, radius):
    """A closed surface about (0.1, 0.1) with normals outwards, an STL as CAD writes it."""
    pyvista.Sphere(radius=radius, center=(radius, radius, radius)).triangulate().save(path)


BALL = {"shape": "mesh", "volume_fraction": 0.2, "temperature_K": 300.0}
IN_SPACE = GRAINS | {
    "dimensions": 3, "domain": {"size_m": [0.2, 0.2, 0.2], "gravity_m_s2": [0.0, 0.0, -9.81]}, "walls": {},
    "particles": {"ball": BALL | {"mesh": "ball.stl"}},
}  # fmt: skip
TANK = LIQUID | {
    "dimensions": 3, "effects": ["gravity", "tank"], "tank": {"shape": "mesh", "mesh": "ball.stl"},
    "domain": {"size_m": [0.2, 0.2, 0.2], "gravity_m_s2": [0.0, 0.0, -9.81]},
    "pools": {"water": {"shape": "tank", "fill": 0.3}},
}  # fmt: skip
del TANK["frame"]


@pytest.mark.parametrize(
    ("table", "key"),
    [
        (IN_SPACE, "particles.ball.mesh"),
        (IN_SPACE | {"walls": {"mesh": "ball.stl"}, "particles": {}}, "walls.mesh"),
        (TANK, "tank.mesh"),
    ],
)
def test_a_surface_in_millimetres_is_refused_with_its_width_and_the_key_of_its_unit(refused, tmp_path, table, key):  # noqa: F811
    own = write_case(tmp_path / "mine", table)
    ball(own / "ball.stl", 100.0)
    line = refused("explain", "mine")
    assert line.startswith(f"sdph: {key} = ") and "is 200 m wide" in line and f"set {key}_scale" in line
    assert refused("run", "mine", *(() if table is TANK else EMBEDDED)) == line
    assert "is 2e-05 m wide" in refused("explain", "mine", "--set", f"{key}_scale=1e-7")
    assert cli.main(["explain", "mine", "--set", f"{key}_scale=1e-3"]) == 0


def test_a_scaled_surface_is_where_it_would_be_in_metres(tmp_path):
    own = write_case(tmp_path / "mine", IN_SPACE)
    ball(own / "ball.stl", 0.1)
    metres = start.fill(cases.load(own / "case.toml"), ())
    ball(own / "ball.stl", 100.0)
    scaled = start.fill(cases.load(own / "case.toml", ("particles.ball.mesh_scale=1e-3",)), ())
    assert len(scaled.x) == len(metres.x) and np.allclose(scaled.x, metres.x, atol=1e-7)
    own = write_case(
        tmp_path / "walls", IN_SPACE | {"walls": {"mesh": "ball.stl", "mesh_scale": 1e-3}, "particles": {}}
    )
    ball(own / "ball.stl", 100.0)
    behind = sides.dummies(cases.load(own / "case.toml"))
    of_ball = behind.table[behind.whose[:, 0] > 0]
    off = np.linalg.norm(of_ball[:, :3] - 0.1, axis=1)
    assert (
        len(of_ball) and off.min() > 0.07 and off.max() < 0.1
    )  # three layers behind, 5 to 25 mm: normals are outwards
    with pytest.raises(CaseError, match="walls.mesh_scale = 0.001, and walls names no mesh"):
        cases.from_table(GRAINS | {"walls": {"mesh_scale": 1e-3}})


@pytest.mark.parametrize("table", [IN_SPACE, IN_SPACE | {"walls": {"mesh": "ball.stl"}, "particles": {}}, TANK])
def test_a_surface_that_is_moved_is_where_it_would_be(tmp_path, table):
    """By 0.05 m along x: from a file in millimetres whose ball stands so much to the left, or in place."""
    own, named = write_case(tmp_path / "mine", table), inputs.named(cases.from_table(table))
    (key,) = (key for key in ("walls.mesh", "tank.mesh", "particles.ball.mesh") if key in named)
    ball(own / "ball.stl", 100.0)
    moved = pyvista.read(own / "ball.stl").translate((-50.0, 0.0, 0.0))
    there = _of_surface(cases.load(own / "case.toml", (f"{key}_scale=1e-3",)))
    moved.save(own / "ball.stl")
    case = cases.load(own / "case.toml", (f"{key}_scale=1e-3", f"{key}_offset_m=[0.05, 0, 0]"))
    assert len(there) > 20 and np.allclose(_of_surface(case), there, atol=1e-7)
    assert f"{key.rpartition('.')[2]}_offset_m = [\n    0.05," in cases.dumps(case)
    with pytest.raises(CaseError, match="_offset_m has 2 components; dimensions = 3 asks for 3"):
        cases.load(own / "case.toml", (f"{key}_offset_m=[0.05, 0]",))
    with pytest.raises(CaseError, match=r"_offset_m = \[1.0, 0.0, 0.0\], and .* names no mesh"):
        cases.load(own / "case.toml", (f"{key}=''", f"{key}_offset_m=[1, 0, 0]"))


def _of_surface(case):
    """Places of what a surface makes in a case: of its wall, of grains in it, of the tank's wall."""
    if case.liquid:
        return tank.shape_of(case).shell(0.5 * case.resolution.spacing, case.resolution.spacing)
    if case.particles:
        return np.transpose([getattr(start.fill(case, ()), axis) for axis in "xyz"])
    behind = sides.dummies(case)
    return behind.table[behind.whose[:, 0] > 0][:, :3]


def test_the_gas_of_a_run_folder_is_that_which_it_began_with(tmp_path):
    """Not as the run left it: its mesh and its fields would stand whatever is set anew."""
    run = tmp_path / "run"
    (run / "gas").mkdir(parents=True)
    (run / "case.toml").touch()
    assert inputs.beside(run / "case.toml") == run / "gas"  # a case of somebody's own
    (run / "origin.json").touch()
    assert inputs.beside(run / "case.toml") is None  # that of the scene
    inputs.gas_of(run).mkdir(parents=True)
    assert inputs.beside(run / "case.toml") == inputs.gas_of(run)


def test_walls_of_patches_are_named_without_detours(tmp_path, monkeypatch):
    """A run folder given as ../run would not know its own copy again."""
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    case = cases.load(write_case(tmp_path / "mine", GRAINS) / "case.toml")
    assert vessel._with(case, Path("../run/walls.vtp")).parameters["walls"].mesh == str(tmp_path / "run" / "walls.vtp")
