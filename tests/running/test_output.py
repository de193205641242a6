"""The run folder: refused or made whole, and read back as it was written."""

import contextlib
import dataclasses
import json
import os
from types import SimpleNamespace

import numpy as np
import pytest
from builders import disc, polar_mesh, run, simulation, tensor_mesh
from hypothesis import given
from hypothesis import strategies as st

from sdph.engine.table import Table
from sdph.running import driver, output
from sdph.running.fields import Fields
from sdph.running.outputs import Outputs
from sdph.running.progress import Reporter
from sdph.schema import CaseError
from sdph.show import timeline, view

SHORT = (
    "resolution.spacing_mm=10",
    "resolution.cell_mm=25",
    "run.end_time_s=0.004",
    "run.output_interval_s=0.002",
    "run.report_at_s=[]",
)


def snapshot(folder):
    return {path.relative_to(folder): path.read_bytes() if path.is_file() else None for path in folder.rglob("*")}


def test_new_folder_is_made_with_what_it_needs(tmp_path):
    folder = output.create(tmp_path / "deep" / "run")
    assert (folder / "fields").is_dir()
    assert output.create(tmp_path / "deep" / "other", ()).is_dir()


@pytest.mark.parametrize(("name", "told"), [("case.toml", "another run or case"), ("notes.txt", "not an empty folder")])
def test_folder_in_use_is_refused_and_left_as_it_is(tmp_path, name, told):
    (tmp_path / name).write_text("mine")
    before = snapshot(tmp_path)
    with pytest.raises(CaseError, match=told):
        output.create(tmp_path)
    assert snapshot(tmp_path) == before


def test_a_run_in_the_way_is_gone_on_with(tmp_path):
    """As a command that is given again means, as a rule."""
    own = output.create(tmp_path / "a run")
    (own / output.MARK).write_text("mine")
    output.write_origin(own)
    with pytest.raises(CaseError, match="go on with that run: sdph run --resume '.*a run', with --until"):
        output.create(own)


def test_file_in_the_way_is_refused(tmp_path):
    file = tmp_path / "file"
    file.write_text("mine")
    for folder, refusal in ((file, CaseError), (file / "run", output.CannotWrite)):
        with pytest.raises(refusal):
            output.create(folder)
    assert file.read_text() == "mine"


def test_free_name_is_the_first_that_is_not_there(tmp_path):
    base = tmp_path / "disc"
    assert output.free_name(base) == base
    base.mkdir()
    (tmp_path / "disc-2").mkdir()
    assert output.free_name(base) == tmp_path / "disc-3"


def test_text_is_whole_or_not_there(tmp_path, monkeypatch):
    file = tmp_path / "summary.json"
    output.write_text(file, "first")

    def full_disk(descriptor):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full_disk)
    with pytest.raises(OSError):
        output.write_text(file, "second, longer")
    assert file.read_text() == "first"


def test_summary_reads_back_and_a_missing_one_is_told(tmp_path):
    with pytest.raises(CaseError, match="no summary.json"):
        output.read_summary(tmp_path)
    output.write_summary(tmp_path, {"particles": 5024, "drift": 1.5e-13})
    assert (
        output.read_summary(tmp_path)
        == json.loads((tmp_path / "summary.json").read_text())
        == {"particles": 5024, "drift": 1.5e-13}
    )


@given(
    rows=st.lists(
        st.tuples(
            st.floats(allow_nan=False), st.integers(-(2**53), 2**53), st.sampled_from(["a", "courant", 'x, "y"'])
        ),
        min_size=1,
    )
)
def test_table_reads_back_to_the_last_bit(tmp_path_factory, rows):
    file = tmp_path_factory.mktemp("table") / "t.csv"
    table = Table(file)
    for a, b, c in rows:
        table.write({"a_K": a, "b": b, "limit": c})
    table.close()
    columns = output.read_table(file)
    np.testing.assert_array_equal(columns["a_K"], [row[0] for row in rows])
    np.testing.assert_array_equal(columns["b"], [row[1] for row in rows])
    assert columns["limit"].tolist() == [row[2] for row in rows]


def test_fields_read_back(tmp_path):
    """Particles and gas of every output on one timeline, each gas cell with its own value."""
    case = disc(*SHORT)
    simulated = simulation(case, tmp_path)
    output.create(tmp_path / "run")
    fields = Fields(tmp_path / "run")
    fields.write(0.0, simulated.meshes())
    while simulated.time < case.run.end_time:
        simulated.window()
    fields.write(simulated.time, simulated.meshes())
    reader = timeline.read(tmp_path / "run")
    assert list(reader.time_values) == [0.0, 0.004]
    time, particles, gas = timeline.state_at(reader)
    assert time == 0.004
    np.testing.assert_array_equal(particles["temperature"], simulated.state.temperature)
    np.testing.assert_array_equal(particles["ident"], simulated.state.ident)
    np.testing.assert_allclose(particles.points[:, 0], simulated.state.x, rtol=1e-6)
    from scipy.spatial import cKDTree

    np.testing.assert_allclose(particles["alpha_p"], simulated.state.density / 3060.0, rtol=1e-14)
    distance, order = cKDTree(simulated.gas.mesh.centres).query(gas.cell_centers().points)
    assert distance.max() < 1e-9
    np.testing.assert_array_equal(gas["temperature"], simulated.gas.temperature[order])
    assert gas.bounds[:4] == pytest.approx((0.0, 0.5, 0.0, 0.5))


def test_folder_without_fields_is_told(tmp_path):
    with pytest.raises(CaseError, match="run.pvd"):
        timeline.read(tmp_path)


def test_picture_of_a_run(tmp_path, monkeypatch):
    case = disc(*SHORT)
    simulated = run(case, tmp_path)
    output.create(tmp_path / "run")
    Fields(tmp_path / "run").write(simulated.time, simulated.meshes())
    view.show(tmp_path / "run", tmp_path / "picture.png")
    from matplotlib.image import imread

    picture = imread(tmp_path / "picture.png")
    assert min(picture.shape[:2]) > 900
    assert len(np.unique(picture.reshape(-1, picture.shape[2]), axis=0)) > 100
    with pytest.raises(CaseError, match="no fields at 1 s: this run has fields from 0.004 to 0.004 s"):
        view.show(tmp_path / "run", tmp_path / "other.png", time=1.0)
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    with pytest.raises(CaseError, match="no display .* --png"):
        view.show(tmp_path / "run")


def test_mesh_that_is_no_tensor_grid_is_not_drawn_as_one():
    """Centres of a wedge are not the nodes of a grid of their coordinates, so the boxes are not to be used."""

    class Wedge:
        mesh = polar_mesh(3, 4, 1.0, 1.0)

    with pytest.raises(AttributeError, match="case_folder"):  # it goes on to the OpenFOAM case of the solver
        output.gas_grid(Wedge())


@pytest.mark.parametrize(
    ("low", "deep"), [((0.0, 0.0, 0.0), 0.01), ((0.25, -0.1, 1.0), 0.1), ((0.02, 0.0, -0.05), 0.1)]
)
def test_a_slab_is_drawn_where_it_is(low, deep):
    """One cell deep along z, centres with the round-off that OpenFOAM's own have."""
    edges = [
        start + length * np.linspace(0.0, 1.0, count + 1)
        for start, length, count in zip(low, (0.06, 0.09, deep), (12, 15, 1))
    ]
    mesh = tensor_mesh(*edges)
    noise = 1e-16 * np.random.default_rng(3).standard_normal(mesh.centres.shape)
    rough = dataclasses.replace(mesh, centres=mesh.centres + noise)
    grid, order = output.gas_grid(SimpleNamespace(mesh=rough))
    ends = [value for start, length in zip(low, (0.06, 0.09, deep)) for value in (start, start + length)]
    np.testing.assert_allclose(grid.bounds, ends, atol=1e-12)
    np.testing.assert_allclose(grid.cell_centers().points, mesh.centres[order], atol=1e-12)


def test_a_run_that_goes_on_has_its_rows_on_the_disk_up_to_the_last_output(tmp_path, monkeypatch):
    written, found = Outputs._write, []

    def looked_at(outputs):
        written(outputs)
        names = ("metrics.csv", "history.csv", "ledger.csv")
        found.append([len((tmp_path / "run" / name).read_text().splitlines()) - 1 for name in names])

    monkeypatch.setattr(Outputs, "_write", looked_at)
    with contextlib.closing(Reporter(line=False)) as reporter:
        driver.run(disc(*SHORT), "disc_cluster", tmp_path / "run", None, reporter)
    assert [rows[0] for rows in found] == list(range(1, len(found) + 1)) and len(found) > 1
    assert all(history >= 1 and ledger >= 1 for _, history, ledger in found)


def test_a_run_that_begins_again_keeps_none_of_its_tables(tmp_path):
    """Rows of a run that was cut before its first checkpoint would stand before its new ones."""
    names = ("ledger_solid.csv", "ledger_liquid.csv", "droplets.csv", "outflow.csv", "fields/solid_0000.vtu")
    (tmp_path / "fields").mkdir()
    for name in (*names, "mine.csv"):
        (tmp_path / name).write_text("time_s\n0.0\n")
    output.clear(tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["fields", "mine.csv"]


@pytest.fixture
def drawn(tmp_path):
    """A run folder with one instant."""
    simulated = run(disc(*SHORT), tmp_path)
    output.create(tmp_path / "run")
    Fields(tmp_path / "run").write(simulated.time, simulated.meshes())
    return tmp_path / "run"


@pytest.mark.parametrize("harm", ["no timeline", "cut", "gone"])
def test_damaged_fields_are_told(drawn, harm):
    file = drawn / ("run.pvd" if harm == "no timeline" else "fields/gas_00000.vtr")
    file.write_bytes(b"" if harm == "no timeline" else file.read_bytes()[:-20])
    if harm == "gone":
        file.unlink()
    with pytest.raises(CaseError, match=f"{file.name} is damaged|is damaged .*{file.name}"):
        view.show(drawn, drawn / "a.png")


def test_what_tells_of_an_end_goes_when_a_run_goes_on(tmp_path):
    """A run that is killed on its way is not the one that ended earlier."""
    names = ("summary.json", "compare_exact.json", output.FAILURE)
    for over in (True, False):
        for name in (*names, "mine.json"):
            (tmp_path / name).write_text("{}")
        output.forget(tmp_path, over)
        left = {path.name for path in tmp_path.iterdir()}
        assert left == ({"mine.json", *names[:2]} if over else {"mine.json"})
