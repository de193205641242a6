"""Short form of the collapse against a box of `sdph validate dam_break_3d`: the tank's mesh, heights that are those of
a pool at rest, checks that tell what is off."""

from types import SimpleNamespace

import numpy as np
import pytest

from sdph import scenes
from sdph.case import read as cases
from sdph.effects.around import tank
from sdph.running import driver
from sdph.running.progress import Reporter
from sdph.study import compare

OWN = compare.scene_module("dam_break_3d")
BOX = OWN.box


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """The first moments, with seven spacings in the depth."""
    folder = tmp_path_factory.mktemp("box") / "run"
    coarse = "resolution.spacing_mm=78.5714285714", "run.end_time_s=0.04"
    case = cases.load(scenes.find("dam_break_3d")[1], (*BOX.OVERRIDES, *coarse))
    driver.run(case, "dam_break_3d", folder, None, Reporter(quiet=True))
    return compare.open_run(folder)


def test_the_tank_is_the_box_less_what_stands_in_it(run):
    """Volume of the tank of the record, box of 0.161 x 0.403 x 0.161 m; liquid is outside of it."""
    shape = tank.shape_of(run.case)
    assert shape.volume == pytest.approx(3.22 - 0.161 * 0.403 * 0.161, rel=1e-9)
    inside, beside = [2.476, 0.4965, 0.08], [2.3, 0.4965, 0.08]
    assert shape.distance(np.array([inside, beside])) == pytest.approx([0.0805, -0.08], abs=1e-3)


def test_heights_are_those_of_the_water(run):
    """At the start 0.55 m of water where it stands, none elsewhere; checks of what the run lasted are made."""
    found = BOX.heights(run)
    assert found["h_2638"][0] == pytest.approx(BOX.DEPTH, rel=0.05)
    assert [found[name][0] for name in ("h_1488", "h_0992", "h_0496")] == [0.0, 0.0, 0.0]
    assert len(OWN.spheric(run)) == 19
    assert (run.folder / "box.png").is_file()


def test_sensors_are_on_the_box(run):
    """Two on its front and two on its top, on one line along the tank; distances of the shape are within round-off."""
    places = np.array(list(BOX.SENSORS.values()))
    assert tank.shape_of(run.case).distance(places) == pytest.approx(np.zeros(4), abs=1e-6)
    assert places[:2, 0] == pytest.approx([2.3955] * 2) and places[2:, 2] == pytest.approx([0.161] * 2)
    assert places[:2, 2] == pytest.approx([0.021, 0.101]) and places[2:, 0] == pytest.approx([2.4165, 2.4965])
    assert set(places[:, 1]) == {0.295 + 0.176}
    assert [len(probe.at) for probe in run.case.probes.values()] == [3] * 4


def test_the_record_has_the_largest_values_that_are_asked_for():
    """Rows of the record are every second one: their largest are up to 5 % below those of all rows, 10 ms apart."""
    known = BOX.record()
    for name, (largest, at) in BOX.PEAKS.items():
        k = np.argmax(known[name])
        assert 0.95 * largest < known[name][k] <= largest + 0.5 and known["t_s"][k] == pytest.approx(at, abs=1e-2)


def as_measured(late: float, factor: float, sensors=tuple(BOX.SENSORS)):
    """A run whose columns are the record, later by `late` [s] and those of `sensors` by a factor."""
    known = BOX.record()
    known["t_s"] = known["t_s"] + late
    history = {"time_s": known["t_s"]}
    for name, (largest, _) in BOX.PEAKS.items():
        own = factor if name in sensors else 1.0
        history[f"{name}_pressure_Pa"] = own * known[name] * largest / known[name].max()
    return SimpleNamespace(history=history), known


def told_of(monkeypatch, run, ours) -> list[str]:
    """Names of the checks that miss, but for heights, of such a run."""
    monkeypatch.setattr(BOX, "heights", lambda _: ours)
    monkeypatch.setattr(BOX, "_figures", lambda *_: None)
    return [check["name"] for check in OWN.spheric(run) if not check["ok"] and "rms" not in check["name"]]


@pytest.mark.parametrize(
    ("late", "factor", "wrong"), [(0.0, 1.0, 0), (0.02, 1.0, 0), (0.0, 1.3, 8), (0.0, 0.7, 8), (0.06, 1.0, 7)]
)
def test_what_is_late_or_too_strong_is_told(monkeypatch, late, factor, wrong):
    told = told_of(monkeypatch, *as_measured(late, factor))
    assert len(told) == wrong, told


@pytest.mark.parametrize("name", BOX.SENSORS)
def test_each_sensor_is_judged_by_its_own_column(monkeypatch, name):
    told = told_of(monkeypatch, *as_measured(0.0, 1.3, (name,)))
    assert len(told) == 2 and all(text.startswith(name) for text in told)
