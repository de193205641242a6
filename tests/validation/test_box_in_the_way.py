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
    assert len(OWN.spheric(run)) == 9
    assert (run.folder / "box.png").is_file()


def as_measured(late: float, factor: float):
    """A run whose columns are the record, later by `late` [s] and P1 by a factor."""
    known = BOX.record()
    known["t_s"] = known["t_s"] + late
    pressure = factor * known["P1"] * BOX.PEAK / known["P1"].max()
    run = SimpleNamespace(history={"time_s": known["t_s"], "P1_pressure_Pa": pressure})
    return run, known


@pytest.mark.parametrize(
    ("late", "factor", "wrong"), [(0.0, 1.0, 0), (0.02, 1.0, 0), (0.0, 1.3, 2), (0.0, 0.7, 2), (0.06, 1.0, 3)]
)
def test_what_is_late_or_too_strong_is_told(monkeypatch, late, factor, wrong):
    run, ours = as_measured(late, factor)
    monkeypatch.setattr(BOX, "heights", lambda _: ours)
    monkeypatch.setattr(BOX, "_figures", lambda *_: None)
    told = [check["name"] for check in OWN.spheric(run) if not check["ok"]]
    assert len([name for name in told if "rms" not in name]) == wrong, told
