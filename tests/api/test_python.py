"""`import sdph` as its users meet it: docs/python.md, cases, runs, windows, results."""

import contextlib
import inspect
import os
import re
import signal
import subprocess
import sys

import numpy as np
import pytest

import sdph
from sdph import cli
from sdph.engine import restart
from sdph.running import compiling
from sdph.running.interruption import Stopped
from sdph.scenes import paths

ROOT = paths.PACKAGE.parent
BLOCK = re.compile(r"```python\n(.*?)```", re.DOTALL)
SMALL = {"resolution.spacing_mm": 20.0, "resolution.cell_mm": 50.0, "run.output_interval_s": 0.001}


@pytest.fixture
def case():
    own = sdph.Case.load("disc_cluster")
    own.update(SMALL)
    return own


@pytest.fixture(scope="module")
def told(tmp_path_factory):
    """A finished run, and times of the windows that its callback was told of."""
    own, times = sdph.Case.load("disc_cluster"), []
    own.update(SMALL)
    out = tmp_path_factory.mktemp("python") / "run"
    run = sdph.run(own, gas="embedded", out=out, until=0.002, callback=lambda window: times.append(window.time))
    return run, times


def test_importing_is_quick_and_names_are_there():
    code = "import sys, sdph; sdph.CaseError; print([m for m in ('numba', 'pandas', 'pyvista') if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
    for name in sdph.__all__:
        assert getattr(sdph, name) is not None
    with pytest.raises(AttributeError, match="has no attribute 'runs'; it has: "):
        sdph.runs  # noqa: B018


def test_types_are_declared_for_all_that_is_public():
    stub = (ROOT / "sdph" / "__init__.pyi").read_text(encoding="utf-8")
    assert set(re.findall(r" as (\w+)$", stub, re.MULTILINE)) == {*sdph.PUBLIC, *sdph.ROOMS}
    assert (ROOT / "sdph" / "py.typed").is_file()
    for name in ("run", "stepping", "load", "explain", "resume"):
        bare = [p for p in inspect.signature(getattr(sdph, name)).parameters.values() if p.annotation is p.empty]
        assert not bare, f"sdph.{name}: {bare}"


def test_page_of_the_docs_runs(tmp_path, monkeypatch):
    """Blocks of docs/python.md, one after the other in one folder; those of data frames where pandas is."""
    monkeypatch.chdir(tmp_path)
    known, blocks = {}, BLOCK.findall((ROOT / "docs" / "python.md").read_text(encoding="utf-8"))
    assert len(blocks) == 5
    for block in (block for block in blocks if "pandas;" not in block):
        exec(block, known)
    assert (tmp_path / "my_run" / "summary.json").is_file() and known["run"].finished
    assert np.linalg.norm(known["force"]) > 0.0
    pytest.importorskip("pandas", reason="pandas is not installed: make setup")
    exec(next(block for block in blocks if "pandas;" in block), known)
    assert known["checks"]["ok"].all()


def test_keys_are_read_and_changed_in_their_units(case):
    assert case["resolution.spacing_mm"] == 20.0 and case.resolved.resolution.spacing == 0.02
    assert "resolution.spacing_mm" in case and case["resolution"]["cell_mm"] == 50.0
    case.update({"resolution.spacing_mm": np.float64(10.0), "resolution.stretch": np.array([1.0, 2.0])})
    assert case["resolution.stretch"] == [1.0, 2.0] and case["resolution.spacing_mm"] == 10.0
    del case["resolution.stretch"]
    assert "resolution.stretch" not in case


@pytest.mark.parametrize(
    ("key", "value", "said"),
    [
        ("resolution.spacing", 1.0, "did you mean resolution.spacing_mm?"),
        ("resolution.spacing_mm", "wide", "it must be a number in mm, without the unit"),
        ("heat.closure", "none", "allowed: geometric, paper"),
        ("title.x", 1, "title is a value, not a section"),
        ("resolution.", 1, "give it as section.key=value"),
    ],
)
def test_what_makes_no_sense_is_refused_and_changes_nothing(case, key, value, said):
    before = str(case)
    with pytest.raises(sdph.CaseError) as refused:
        case[key] = value
    assert said in str(refused.value) and "\n" not in str(refused.value) and str(case) == before
    with pytest.raises(sdph.CaseError, match="unknown key"):
        case["resolution.nothing"]


def test_a_saved_case_is_the_same_with_its_files(tmp_path, case):
    case.save(tmp_path / "own")
    again = sdph.Case.load(tmp_path / "own")
    assert str(again) == str(case) and again.gas_folder == tmp_path / "own" / "gas" == case.gas_folder
    with pytest.raises(sdph.CaseError, match="holds another run or case"):
        case.save(tmp_path / "own")


def test_a_callback_hears_of_every_window(told):
    run, times = told
    assert run.finished and len(times) == run.summary["windows"] and times[-1] == run.summary["time_s"] == 0.002
    assert times == sorted(times)


def test_results_are_arrays_and_meshes(told):
    run, _ = told
    assert run.times == [0.0, 0.001, 0.002] and run.failure is None
    particles, (time, points, gas) = run.particles(0.001), run.fields(0.001)
    assert time == 0.001 and points.n_points == len(particles["temperature"]) == run.summary["particles"]
    assert particles["position"].shape == particles["velocity"].shape == (points.n_points, 3)
    assert run.gas(0.001)["centre"].shape == (gas.n_cells, 3)
    assert run.particles()["temperature"].mean() > run.particles(0.0)["temperature"].mean()
    assert {"history", "ledger", "metrics"} == set(run.tables)
    assert len(run.columns("ledger")["time_s"]) == run.summary["windows"] + 1
    with pytest.raises(sdph.CaseError, match="no fields at 1 s: this run has fields from 0 to 0.002 s"):
        run.particles(1.0)
    with pytest.raises(sdph.CaseError, match="has no table outlet; it has: history, ledger, metrics"):
        run.table("outlet")


def test_a_box_of_gas_has_axes(told, monkeypatch):
    """Each cell stands where its centre is, whatever the order of cells; without xarray one line says so."""
    xarray, (run, _) = pytest.importorskip("xarray"), told
    gas, fields = run.gas(0.001), run.gas_on_axes(0.001)
    assert isinstance(fields, xarray.Dataset) and fields.sizes == {"x": 10, "y": 10, "component": 3}
    for place, heat, speed in zip(gas["centre"][::7], gas["temperature"][::7], gas["velocity"][::7]):
        here = fields.sel(x=place[0], y=place[1], method="nearest")
        assert float(here.temperature) == heat and here.velocity.values.tolist() == speed.tolist()
        assert abs(float(here.x) - place[0]) < 1e-6
    corner = run.fields(0.001)._replace(gas=run.fields(0.001).gas.extract_cells([0, 1, 12]))
    monkeypatch.setattr(run, "fields", lambda time: corner)
    with pytest.raises(sdph.CaseError, match="no box of cells"):
        run.gas_on_axes()
    monkeypatch.undo()
    monkeypatch.setitem(sys.modules, "xarray", None)
    with pytest.raises(sdph.CaseError, match="pip install 'sdph.xarray.'"):
        run.gas_on_axes(0.001)


def test_tables_are_data_frames(told):
    pandas = pytest.importorskip("pandas", reason="pandas is not installed: make setup")
    run, _ = told
    for frame in (run.history, run.metrics, run.ledger, run.compare("exact"), sdph.explain(run.case).frame("limits")):
        assert isinstance(frame, pandas.DataFrame) and len(frame)
    assert run.history["time_s"].iloc[-1] == 0.002 and run.ledger["limit"].iloc[-1]


def test_a_loop_that_is_left_goes_on_to_the_same_ledger(told, case, tmp_path):
    with sdph.stepping(case, gas="embedded", out=tmp_path / "run", until=0.002) as windows:
        for window in windows:
            assert window.ledger["time_s"] == window.time == window.history["time_s"]
            assert len(window.particles["mass"]) == told[0].summary["particles"]
            assert window.gas["temperature"].shape == (len(window.gas["centre"]),)
            if window.number == 3:
                break
    assert restart.newest(tmp_path / "run").number == 3  # leaving the loop wrote it
    assert not windows.result.finished and len(windows.result.columns("ledger")["time_s"]) == 4
    assert sdph.resume(tmp_path / "run").finished
    assert (tmp_path / "run" / "ledger.csv").read_bytes() == (told[0].folder / "ledger.csv").read_bytes()


def test_options_that_do_nothing_are_refused(tmp_path):
    with pytest.raises(sdph.CaseError, match="gas embedded: dam_break has no gas and no gas solver; leave it out"):
        sdph.run("dam_break", gas="embedded", out=tmp_path / "run")
    with pytest.raises(sdph.CaseError, match="ranks 2: the embedded gas solver runs in this process"):
        sdph.run("disc_cluster", gas="embedded", ranks=2, out=tmp_path / "run")
    with pytest.raises(TypeError, match="unknown option folder; known: gas, out"):
        sdph.run("disc_cluster", folder=tmp_path)
    with pytest.raises(sdph.CaseError, match="holds no run"):
        sdph.load(tmp_path)
    assert not list(tmp_path.iterdir())


def test_explain_is_what_the_command_says(case, capsys):
    found = sdph.explain(case)
    assert cli.main(["explain", "disc_cluster", *(f"--set={key}={value}" for key, value in SMALL.items())]) == 0
    assert str(found).strip() in capsys.readouterr().out and found.warnings == case.validate()


def test_kernels_that_are_compiled_are_told_without_progress_too(case, tmp_path, monkeypatch, capsys):
    """By a run whose compiling is told as soon as it starts; no other line is."""

    @contextlib.contextmanager
    def compiled(tell):
        tell(compiling.TEXT)
        tell("t = 1 s")
        yield

    monkeypatch.setattr(compiling, "told", compiled)
    with sdph.stepping(case, gas="embedded", out=tmp_path / "run", until=0.002) as windows:
        next(windows)
    assert capsys.readouterr().err.splitlines() == [compiling.TEXT]


def test_a_signal_in_a_loop_is_a_keyboard_interrupt_that_leaves_a_checkpoint(case, tmp_path):
    seen = []
    with pytest.raises(KeyboardInterrupt) as stopped:
        for window in sdph.stepping(case, gas="embedded", out=tmp_path / "run", until=0.002):
            seen.append(window.time)
            os.kill(os.getpid(), signal.SIGINT)
    assert isinstance(stopped.value, Stopped) and seen and seen[-1] < 0.002
    assert sdph.resume(tmp_path / "run").finished
