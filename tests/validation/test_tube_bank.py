"""Short forms of the bank of tubes of `sdph validate experiments`."""

import re
from types import SimpleNamespace

import numpy as np
import pytest
import pyvista
from matplotlib.figure import Figure

from sdph.running.progress import Reporter
from sdph.study import validate

BANK = validate.part(validate.EXPERIMENTS, "tube_bank")
QUIET = Reporter(quiet=True)


def test_law_of_a_bank_by_hand():
    """Pitch over diameter 2.828: 1 - 0.21 x 0.1622 = 0.9659 of a single tube's."""
    case = BANK.hot_tube.cases.load(BANK.hot_tube.scenes.find(BANK.hot_tube.SCENE)[1])
    alone = BANK.hot_tube.grewal_saxena(case, 0.45, 0.5)
    assert BANK.grewal(case, 0.45, 0.5) == pytest.approx(0.9659 * alone, rel=1e-3)


def test_mesh_has_a_ring_of_cells_around_each_tube():
    text = BANK.mesh()
    assert text.count("hex (") == 5 * 5 - 5 + 4 * 5 and text.count("arc ") == 2 * 4 * 5
    places = np.array(re.findall(r"^\((\S+) (\S+) 0\.0\)$", text, re.MULTILINE), float)
    assert len(places) == 6 * 6 + 4 * 5
    centres = places[36:].reshape(5, 4, 2).mean(axis=1)
    assert np.sort(centres.round(9), axis=0) == pytest.approx(
        np.array([[0.08, 0.10], [0.08, 0.10], [0.16, 0.18], [0.24, 0.26], [0.24, 0.26]])
    )


def test_without_openfoam_it_is_left_out_and_told(tmp_path, monkeypatch):
    said = []
    monkeypatch.setattr(BANK.installation, "find", lambda: None)
    assert BANK.checks(tmp_path, (), SimpleNamespace(status=said.append)) == []
    assert len(said) == 1 and "needs OpenFOAM" in said[0]


def told_run():
    """The bank from which 100 W of each metre of depth go, all the time, and three grains of it."""
    case = BANK.hot_tube.cases.load(BANK.hot_tube.scenes.find(BANK.hot_tube.SCENE)[1], ("run.end_time_s=2.0",))
    time = np.linspace(0.02, 2.0, 100)
    cloud = pyvista.PolyData(np.array([[0.0, 0.1, 0.0], [0.1, 0.2, 0.0], [0.3, 0.3, 0.0]]))
    cloud["alpha_p"] = np.array([0.1, 0.3, 0.6])
    return SimpleNamespace(
        case=case, ledger={"time_s": time, "heat_of_walls_J": np.full(100, 2.0)},
        summary={"tube_area_m2": 0.2 * np.pi}, metrics={"time_s": time, "alpha_p_inside": np.full(100, 0.4)},
        fields=lambda at: (at, cloud, None),
    )  # fmt: skip


def test_a_figure_tells_the_course_and_the_bed(tmp_path, monkeypatch):
    """h = 100/(0.2 pi 50) = 3.183 W/(m2 K) at all times; the picture has all grains and tubes."""
    own, drawn = told_run(), []
    monkeypatch.setattr(BANK.installation, "find", lambda: True)
    monkeypatch.setattr(BANK, "run", lambda *given: own)
    saved = Figure.savefig
    monkeypatch.setattr(Figure, "savefig", lambda figure, *a, **k: drawn.append(figure) or saved(figure, *a, **k))
    (check,) = BANK.checks(tmp_path)
    assert (tmp_path / "tube_bank.png").is_file()
    (axes,) = drawn[0].axes
    Nu = 3.1831 * own.case.grains.diameter / own.case.gas.conductivity
    assert check["value"] == pytest.approx(Nu, rel=1e-3)
    assert axes.lines[0].get_ydata()[1:] == pytest.approx(np.full(39, Nu), rel=1e-3)
    (band,), (bed,) = axes.patches, axes.child_axes
    assert [band.get_y(), band.get_y() + band.get_height()] == pytest.approx(
        [0.75 * check["reference"], 1.25 * check["reference"]]
    )
    assert len(bed.collections[0].get_offsets()) == 3 and len(bed.patches) == 5


@pytest.mark.openfoam
def test_a_moment_of_it_has_all_tubes_hot(tmp_path):
    """40 ms of coarse particles: their area, heat from them, balances."""
    own = BANK.run(tmp_path / "run", ("resolution.spacing_mm=8", "run.output_interval_s=0.02"), QUIET, 0.04)
    assert own.summary["tube_area_m2"] == pytest.approx(5.0 * np.pi * 0.04, rel=0.02)
    assert BANK.hot_tube.number(own) > 0.0 and own.summary["energy_drift_rel"] < 1e-8
    grains = np.asarray(own.fields(0.0)[1].points, float)
    axes = np.array([[0.08, 0.10], [0.24, 0.10], [0.16, 0.18], [0.08, 0.26], [0.24, 0.26]])
    apart = np.linalg.norm(grains[:, None, :2] - axes, axis=2)
    assert 0.02 < apart.min() < 0.028 and grains[:, 1].max() > 0.35
