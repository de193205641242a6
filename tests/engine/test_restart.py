"""A run that was cut and goes on is the run that was not cut; what cannot go on is refused and named."""

import json
import os
import shutil
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
import pyvista
from test_cli import ENVIRONMENT

from coupling.gas import GasError
from sdph import scenes
from sdph.case import read as cases
from sdph.engine import restart
from sdph.engine.clock import Stalled
from sdph.running import driver, output
from sdph.schema import CaseError

COARSE = {
    "disc_cluster": ("resolution.spacing_mm=20", "resolution.cell_mm=50", "run.output_interval_s=0.0002",
    "run.end_time_s=0.0004"),
    "bubbling_bed": ("resolution.spacing_mm=20", "resolution.cell_mm=20", "run.output_interval_s=0.001",
    "run.end_time_s=0.003"),
    "evaporating_jet": (  # droplets come in, evaporate, and leave from the 25th window on
        "resolution.spacing_mm=100", "resolution.cell_mm=200", "domain.size_m=[1.2,2.0]",
        "nozzles.jet.centre_m=[0.0,1.0]", "nozzles.jet.speed_m_s=30.0", "evaporation.onset_temperature_K=294.001",
        "coupling.window_largest_s=2e-3", "coupling.window_tolerance=1e-2", "run.output_interval_s=0.02",
        "run.end_time_s=0.06",
    ),
}  # fmt: skip
SOON = "run.checkpoint_windows=4"
SECOND = (  # faces the first, opens and closes on the way; two sizes, at a rate that changes
    "nozzles.second={shape='slot', centre_m=[1.0,1.3], width_m=0.3, direction=[-1.0,0.1], speed_m_s=20.0, "
    "rates=[[0.0,200.0],[0.03,600.0],[0.06,400.0]], temperature_K=300.0, start_s=0.01, end_s=0.05, sizes='given', "
    "diameters_mm=[2.0,4.0]}",
)  # fmt: skip
BREAKING = (  # droplets that come in so thin that they feel the gas break on their way
    "nozzles.jet.volume_fraction=0.05",
    "effects=['inflow','outflow','drag','gas_pressure','gravity','granular_pressure','granular_temperature','heat',"
    "'evaporation','break_up']",
    "break_up.liquid_viscosity_Pa_s=9e-4", "break_up.products='chi_squared'",
)  # fmt: skip
HOT = (  # walls that heat grains by how long they have been there
    "effects=['gravity','granular_pressure','friction','walls','heat','conduction','wall_heat']",
    "boundaries.walls.temperature_K=400",
)


class Cut(RuntimeError):
    pass


class Reporter:
    """Cuts a run after some windows, as a power failure would: nothing is saved on the way out."""

    def __init__(self, cut_after=None):
        self.cut_after, self.said = cut_after, []

    def status(self, text):
        self.said.append(text)

    def progress(self, simulation):
        if simulation.windows == self.cut_after:
            raise Cut


def load(scene, gas, *more):
    return cases.load(scenes.HERE / scene / "case.toml", (*COARSE[scene], SOON, f"coupling.gas='{gas}'", *more))


def start(folder, scene="disc_cluster", gas="embedded", cut_after=None, more=()):
    return driver.run(load(scene, gas, *more), scene, folder, None, Reporter(cut_after))


@pytest.fixture
def cut(tmp_path):
    """A run that was cut after its tenth window."""
    with pytest.raises(Cut):
        start(tmp_path / "cut", cut_after=10)
    return tmp_path / "cut"


def same_run(one, other):
    record = ["outflow.csv"] if (one / "outflow.csv").exists() else []
    for name in ("ledger.csv", "history.csv", "metrics.csv", "run.pvd", *record):
        assert (one / name).read_bytes() == (other / name).read_bytes(), name
    names = [path.name for path in sorted((one / "fields").iterdir())]
    assert names == [path.name for path in sorted((other / "fields").iterdir())]
    for name in names:
        a, b = pyvista.read(one / "fields" / name), pyvista.read(other / "fields" / name)
        for x, y in ((a.point_data, b.point_data), (a.cell_data, b.cell_data)):
            assert all(x[key].tobytes() == y[key].tobytes() for key in x), name


@pytest.mark.parametrize(
    ("scene", "gas", "after", "more"),
    [
        ("disc_cluster", "embedded", 10, ()),
        ("bubbling_bed", "embedded", 10, ("run.forces=['left','bottom']", "resolution.neighbour_skin=0")),
        ("bubbling_bed", "embedded", 10, HOT),
        ("evaporating_jet", "embedded", 29, ()),
        ("evaporating_jet", "embedded", 29, SECOND),
        ("evaporating_jet", "embedded", 29, BREAKING),
        pytest.param("disc_cluster", "openfoam", 10, (), marks=pytest.mark.openfoam),
        pytest.param("disc_cluster", "openfoam", 10, ("coupling.gas_ranks=2",), marks=pytest.mark.openfoam),
        pytest.param("bubbling_bed", "openfoam", 10, (), marks=pytest.mark.openfoam),
        pytest.param("evaporating_jet", "openfoam", 29, (), marks=pytest.mark.openfoam),
        pytest.param("evaporating_jet", "openfoam", 29, SECOND, marks=pytest.mark.openfoam),
    ],
)
def test_resumed_run_is_the_uninterrupted_one_bit_for_bit(tmp_path, scene, gas, after, more):
    whole = start(tmp_path / "whole", scene, gas, more=more)
    with pytest.raises(Cut):
        start(tmp_path / "cut", scene, gas, cut_after=after, more=more)
    resumed = driver.resume(tmp_path / "cut", (), Reporter())
    same_run(tmp_path / "whole", tmp_path / "cut")
    assert {
        key: resumed[key] for key in whole if "wall" not in key and "_per_" not in key and "start_to" not in key
    } == {key: whole[key] for key in whole if "wall" not in key and "_per_" not in key and "start_to" not in key}


def test_a_run_can_be_made_longer(tmp_path):
    start(tmp_path / "long", more=("run.end_time_s=0.0006",))
    start(tmp_path / "short")
    driver.resume(tmp_path / "short", ("run.end_time_s=0.0006",), Reporter())
    same_run(tmp_path / "long", tmp_path / "short")


@pytest.mark.parametrize("gas", ["embedded", pytest.param("openfoam", marks=pytest.mark.openfoam)])
@pytest.mark.parametrize(("count", "interval"), [(12, 0.05), (3, 0.1), (7, 0.01)])
def test_a_run_goes_on_past_an_end_that_is_a_landmark_but_for_round_off(tmp_path, gas, count, interval):
    """12 x 0.05 is more than 0.6 in floating point; a window of 1e-16 s used to end the run."""
    end, later = float(f"{count * interval:.6g}"), float(f"{(count + 0.4) * interval:.6g}")
    quick = (
        "resolution.spacing_mm=50",
        "resolution.cell_mm=100",
        "coupling.window_tolerance=1e-1",
        "run.report_at_s=[]",
        f"run.output_interval_s={interval}",
    )
    whole = start(tmp_path / "whole", gas=gas, more=(*quick, f"run.end_time_s={later}"))
    start(tmp_path / "cut", gas=gas, more=(*quick, f"run.end_time_s={end}"))
    resumed = driver.resume(tmp_path / "cut", (f"run.end_time_s={later}",), Reporter())
    same_run(tmp_path / "whole", tmp_path / "cut")
    assert resumed["windows"] == whole["windows"] and resumed["time_s"] == later
    instants = [entry.split('"')[1] for entry in (tmp_path / "cut" / "run.pvd").read_text().split("timestep=")[1:]]
    assert len(set(instants)) == len(instants) / 2 == count + 2  # particles and gas; the start and the end too


def test_the_output_interval_may_change_when_a_run_goes_on(tmp_path):
    start(tmp_path / "run")
    driver.resume(tmp_path / "run", ("run.end_time_s=0.0006", "run.output_interval_s=0.00005"), Reporter())
    instants = sorted(
        {float(entry.split('"')[1]) for entry in (tmp_path / "run" / "run.pvd").read_text().split("timestep=")[1:]}
    )
    np.testing.assert_allclose(instants, [0.0, 2e-4, 4e-4, 4.5e-4, 5e-4, 5.5e-4, 6e-4], rtol=1e-12)


def test_an_absurd_limit_ends_with_its_name(tmp_path):
    with pytest.raises(Stalled, match="window_largest_s"):
        start(tmp_path / "run", more=("coupling.window_largest_s=1e-14",))
    assert json.loads((tmp_path / "run" / "failure.json").read_text())["kind"] == "Stalled"


@pytest.mark.parametrize("harm", ["truncate", "flip", "remove", "manifest", "draft"])
def test_a_damaged_checkpoint_is_passed_over(cut, tmp_path, harm):
    newest = restart.newest(cut).folder
    file = newest / ("manifest.json" if harm == "manifest" else "arrays.npz")
    data = file.read_bytes()
    if harm == "flip":
        file.write_bytes(data[:500] + bytes([data[500] ^ 1]) + data[501:])
    elif harm == "remove":
        file.unlink()
    elif harm == "draft":
        os.rename(newest, newest.with_name(f".{newest.name}.part"))
    else:
        file.write_bytes(data[: len(data) // 2])
    reporter = Reporter()
    driver.resume(cut, (), reporter)
    assert harm == "draft" or any("is passed over" in line for line in reporter.said)
    start(tmp_path / "whole")
    same_run(tmp_path / "whole", cut)


def test_without_any_checkpoint_a_run_begins_again(cut, tmp_path):
    shutil.rmtree(cut / "checkpoints")
    driver.resume(cut, (), Reporter())
    start(tmp_path / "whole")
    same_run(tmp_path / "whole", cut)


def test_what_the_user_has_put_into_the_folder_stays(cut):
    shutil.rmtree(cut / "checkpoints")
    (cut / "mine").mkdir()
    own = [cut / "notes.txt", cut / "disc.png", cut / "mine" / "a", cut / "fields" / "b.txt"]
    for path in own:
        path.write_text("mine")
    driver.resume(cut, (), Reporter())
    assert all(path.read_text() == "mine" for path in own)


@pytest.mark.parametrize(
    ("override", "told"),
    [("run.end_time_s=1e-6", "has reached .* lies before that"), ("grains.diameter_mm=0.3", "diameter")],
)
def test_a_refused_resume_changes_nothing(cut, override, told):
    before = {path: path.read_bytes() for path in cut.rglob("*") if path.is_file()}
    with pytest.raises(CaseError, match=told):
        driver.resume(cut, (override,), Reporter())
    assert {path: path.read_bytes() for path in cut.rglob("*") if path.is_file()} == before


@pytest.mark.parametrize(
    ("override", "told"),
    [
        ("grains.diameter_mm=0.3", "grains.diameter_mm was 0.285 and is 0.3"),
        ("vapour.molar_mass_kg_kmol=18.0", "vapour"),
    ],
)
def test_another_case_is_refused_with_the_difference(cut, override, told):
    with pytest.raises(CaseError, match=told):
        driver.resume(cut, (override,), Reporter())


@pytest.mark.parametrize(
    ("change", "told"),
    [({"sdph": "0.0.0"}, "written with sdph 0.0.0"), ({"format": 2}, "written with format 2; this is 21")],
)
def test_another_version_is_refused(cut, change, told):
    manifest = restart.newest(cut).folder / "manifest.json"
    manifest.write_text(json.dumps(json.loads(manifest.read_text()) | change))
    with pytest.raises(CaseError, match=told):
        driver.resume(cut, (), Reporter())


def test_lost_rows_of_the_ledger_are_noticed(cut):
    os.truncate(cut / "ledger.csv", 200)
    with pytest.raises(CaseError, match="lost rows"):
        driver.resume(cut, (), Reporter())


def test_what_is_no_run_is_refused(tmp_path):
    with pytest.raises(CaseError, match="no run"):
        driver.resume(tmp_path, (), Reporter())


def test_a_folder_in_use_is_refused(cut):
    with output.claimed(cut), pytest.raises(CaseError, match="in use"):
        driver.resume(cut, (), Reporter())


COARSE_DAM = ("resolution.spacing_mm=4", "domain.gravity_m_s2=[0.0,-0.1]", "run.output_interval_s=0.01")


@pytest.mark.parametrize(
    ("number", "scene", "coarse"),
    [
        (signal.SIGTERM, "disc_cluster", COARSE["disc_cluster"][:3]),
        (signal.SIGINT, "disc_cluster", COARSE["disc_cluster"][:3]),
        (signal.SIGTERM, "dam_break", COARSE_DAM),
    ],
)
def test_a_signal_leaves_a_checkpoint(tmp_path, number, scene, coarse):
    overrides = [
        word for text in (*coarse, "run.end_time_s=1.0", "run.checkpoint_interval_s=1e6") for word in ("--set", text)
    ]
    gas = () if scene == "dam_break" else ("--gas", "embedded")
    command = [sys.executable, "-m", "sdph.cli", "run", scene, *gas, *overrides, "--out", "mine"]
    process = subprocess.Popen(command, cwd=tmp_path, env=ENVIRONMENT, stderr=subprocess.PIPE, text=True)
    history = tmp_path / "mine" / "fields" / "particles_00001.vtp"
    while not history.exists():
        assert process.poll() is None, process.stderr.read()
        time.sleep(0.05)
    process.send_signal(number)
    said = process.communicate(timeout=60)[1]
    assert process.returncode == 128 + number
    assert signal.Signals(number).name in said and "--resume mine" in said
    end = restart.newest(tmp_path / "mine").manifest
    assert end["case"]["run"]["end_time_s"] == 1.0
    assert restart.newest(tmp_path / "mine").folder.name != "000000000"
    assert json.loads((tmp_path / "mine" / "failure.json").read_text())["kind"] == "Stopped"


def test_a_run_that_blows_up_says_where(tmp_path, monkeypatch):
    advance = driver.Simulation.window

    def window(simulation):
        advance(simulation)
        if simulation.windows == 5:
            simulation.state.temperature[simulation.state.ident == 3] = np.nan

    monkeypatch.setattr(driver.Simulation, "window", window)
    with pytest.raises(GasError, match="heat is not finite in cell") as told:
        start(tmp_path / "run")
    assert "--resume" in told.value.__notes__[0]
