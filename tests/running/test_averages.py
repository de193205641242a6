"""Means of a run are over the time from which they are taken; profiles are those of flows that are known."""

from types import SimpleNamespace

import numpy as np
import pytest

import sdph
from sdph.case import read as cases
from sdph.methods.grains.history import Warmed
from sdph.running import averages, metrics, output
from sdph.study import report

LENGTH, HEIGHT, WIDTH, SPEED, SHARE, FROM = 0.4, 0.1, 0.04, 5.0, 0.001, 0.1
GIVEN = {
    "title": "grains that fly with the gas through a duct", "dimensions": 2,
    "effects": ["drag", "gravity", "inflow", "outflow", "walls"],
    "run": {"end_time_s": 0.2, "output_interval_s": 0.05, "average_from_s": FROM, "metrics": ["jet"]},
    "domain": {"size_m": [LENGTH, HEIGHT], "gravity_m_s2": [0.0, 0.0]},
    "resolution": {"spacing_mm": 10.0, "cell_mm": 20.0},
    "gas": {"density_kg_m3": 1.2, "viscosity_Pa_s": 1.8e-5, "conductivity_W_m_K": 0.025,
            "heat_capacity_J_kg_K": 1006.0, "temperature_K": 300.0},
    "grains": {"density_kg_m3": 1000.0, "diameter_mm": 0.2, "heat_capacity_J_kg_K": 1000.0, "conductivity_W_m_K": 1.0},
    "nozzles": {"mouth": {"shape": "slot", "centre_m": [0.0, 0.05], "direction": [1.0, 0.0], "speed_m_s": SPEED,
                          "temperature_K": 300.0, "volume_fraction": SHARE, "width_m": WIDTH}},
    "boundaries": {"inlet": {"kind": "velocity_inlet", "side": "left", "velocity_m_s": [SPEED, 0.0],
                             "temperature_K": 300.0},
                   "out": {"kind": "pressure_outlet", "side": "right", "pressure_Pa": 0.0, "temperature_K": 300.0},
                   "walls": {"kind": "slip_wall"}},
    "profiles": {"along": {"along": "x"},
                 "across": {"along": "y", "lower_m": [0.2, 0.0], "upper_m": [0.3, HEIGHT]}},
}  # fmt: skip


def case_of(folder, table):
    (folder / "duct.toml").write_text(cases.dumps(cases.from_table(table)))
    return sdph.Case.load(folder / "duct.toml")


@pytest.fixture(scope="module")
def duct(tmp_path_factory):
    folder = tmp_path_factory.mktemp("duct")
    case = case_of(folder, GIVEN)
    return case, sdph.run(case, gas="embedded", out=folder / "run"), folder


def test_the_summary_has_means_of_metrics_since_then(duct):
    """The output at that time is the first of them."""
    _, run, _ = duct
    rows = run.table("metrics")
    since = rows[rows["time_s"] > FROM - 1e-9]
    assert len(since) == 3 < len(rows) and since["time_s"].iloc[0] == pytest.approx(FROM)
    assert run.summary["mean_front_m"] == pytest.approx(since["front_m"].mean(), rel=1e-12)
    assert run.summary["mean_grains"] == pytest.approx(since["grains"].mean(), rel=1e-12)
    assert run.summary["front_m"] == rows["front_m"].iloc[-1] and "mean_time_s" not in run.summary


def test_without_such_a_time_there_are_no_means_of_metrics():
    rows = [{"time_s": time, "drop_Pa": 10.0 * time} for time in (0.0, 0.1, 0.2)]
    assert metrics.means(rows, 0.0) == metrics.means(rows, 0.3) == {}
    assert metrics.means(rows, 0.1) == {"mean_drop_Pa": pytest.approx(1.5)}


def test_profiles_of_a_stream_tell_its_share_its_speed_and_what_passes(duct):
    _, run, _ = duct
    assert {"profile_along", "profile_across"} <= set(run.tables)
    along, across = run.table("profile_along"), run.table("profile_across")
    np.testing.assert_array_equal(along["x_m"], np.arange(0.01, LENGTH, 0.02).round(12))
    inner = along[(along.x_m > 0.05) & (along.x_m < LENGTH - 0.03)]  # the kernel looks past both ends
    passing = SHARE * 1000.0 * SPEED * WIDTH / HEIGHT
    np.testing.assert_allclose(inner["mass_flux_x_kg_m2_s"], passing, rtol=0.02)
    np.testing.assert_allclose(inner["alpha_p"], SHARE * WIDTH / HEIGHT, rtol=0.02)
    np.testing.assert_allclose(inner["velocity_x_m_s"], SPEED, rtol=2e-3)
    np.testing.assert_allclose(along["gas_mass_flux_x_kg_m2_s"], 1.2 * SPEED, rtol=1e-3)
    np.testing.assert_allclose(along["gas_temperature_K"], 300.0, rtol=1e-6)
    np.testing.assert_allclose(across["alpha_p"], across["alpha_p"][::-1], atol=1e-12)  # the stream is in the middle
    whole = across["mass_flux_x_kg_m2_s"].sum() * 0.02
    assert whole == pytest.approx(passing * HEIGHT, rel=0.02)  # kg/s per metre of depth
    assert across["mass_flux_x_kg_m2_s"].iloc[2] > 10.0 * across["mass_flux_x_kg_m2_s"].iloc[0]


def test_the_report_draws_profiles(duct):
    _, run, folder = duct
    page = report.write([run.folder], folder / "report.html").read_text()
    part = page.partition("<h2>Profiles</h2>")[2].partition("</section>")[0]
    assert "<h3>along</h3>" in part and "<h3>across</h3>" in part
    assert 'alt="gas mass flux' in part and part.count('class="panel"') > 8


def test_what_left_tells_how_long_it_stayed(duct):
    _, run, _ = duct
    gone, windows = run.table("outflow"), run.ledger["window_s"].max()
    way = gone["x_m"] / SPEED
    np.testing.assert_allclose(gone["residence_s"], way, rtol=0.0, atol=1.01 * windows)
    mean = np.average(gone["residence_s"], weights=gone["mass_kg"])
    assert run.summary["outflow_residence_s"] == pytest.approx(mean, rel=1e-12)


def test_means_begin_when_they_are_asked_to(tmp_path):
    inlet = {"kind": "velocity_inlet", "side": "left", "temperature_K": 300.0}
    inlet["velocities"] = [[0.09, SPEED, 0.0], [0.0901, 2.0 * SPEED, 0.0]]
    late = case_of(tmp_path, GIVEN | {"boundaries": GIVEN["boundaries"] | {"inlet": inlet}})
    for start, mean in ((FROM, 2.0), (0.0, 1.55)):
        late["run.average_from_s"] = start
        run = sdph.run(late, gas="embedded", out=tmp_path / f"run{start}")
        passed = 1.2 * SPEED * HEIGHT
        assert run.summary["mean_inlet_gas_in_kg_s"] == pytest.approx(mean * passed, rel=1e-3)
        flux = run.table("profile_along")["gas_mass_flux_x_kg_m2_s"]
        np.testing.assert_allclose(flux, mean * passed / HEIGHT, rtol=0.01)


def test_a_run_that_ends_before_has_no_means(duct, tmp_path):
    case, _, _ = duct
    windows = sdph.stepping(case, gas="embedded", out=tmp_path / "run")
    with windows:
        next(iter(windows))
    run = sdph.load(tmp_path / "run")
    assert np.isnan(run.table("profile_along")["alpha_p"]).all()


def test_going_on_gives_the_profiles_of_a_run_in_one(duct, tmp_path):
    case, whole, _ = duct
    with sdph.stepping(case, gas="embedded", out=tmp_path / "run") as windows:
        for window in windows:
            if window.time > 0.15:
                break
    again = sdph.resume(tmp_path / "run")
    for name in ("profile_along.csv", "profile_across.csv", "outflow.csv"):
        assert (again.folder / name).read_text() == (whole.folder / name).read_text()
    assert {k: v for k, v in again.summary.items() if k.startswith(("mean_", "outflow"))} == {
        k: v for k, v in whole.summary.items() if k.startswith(("mean_", "outflow"))
    }


def test_a_run_that_begins_again_leaves_no_profile_of_before(tmp_path):
    (tmp_path / "profile_old.csv").write_text("x_m\n")
    output.clear(tmp_path)
    assert not list(tmp_path.glob("profile_*"))


def test_particles_of_materials_have_columns_of_their_own():
    grains, _ = averages.summed(cases.load(sdph.scenes.find("segregation")[1]))
    assert [name for name in grains if name.endswith("_volume")] == ["small_volume", "large_volume"]


def test_heat_of_walls_is_averaged_from_then_on_too():
    """A wall that gives 8 J in the first second and 2 J in the next: 2 W from the first second on, 5 W of both."""
    hot = SimpleNamespace(names=("tube",), owners=np.eye(1), areas=np.array([2.0]))
    for start, power in ((1.0, 2.0), (0.0, 5.0)):
        own = Warmed(hot, start)
        own.add(np.array([[8.0, 1.0]]), 0.0, 1.0)
        own.add(np.array([[2.0, 1.0]]), 1.0, 2.0)
        assert own.summary()["mean_tube_grain_heat_W"] == power and own.row()["tube_grain_heat_W"] == 2.0
