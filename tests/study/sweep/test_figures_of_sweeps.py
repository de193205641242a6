"""The figure of a sweep: its axis, numbers of summaries, runs that have none."""

import contextlib
import math

import numpy as np
import pytest
from test_sweep import FINE, rows_of

from sdph import cli
from sdph.schema import CaseError
from sdph.study.sweep import jobs, table


def points_of(*values):
    return [jobs.Job(dict(zip(("k.name", "k.v", "k.x"), row)), "", (), "") for row in values]


def test_the_axis_of_the_figure_is_what_varies():
    """A number before vectors, of these the component that varies, or their length."""
    both = points_of(("p", "[1,0]", "1"), ("q", "[1,-2]", "2"))
    assert table.axis(both, None) == table.Axis("k.x")
    assert table.axis(both, "k.v") == table.Axis("k.v", True, 1)
    turned = table.axis(points_of(("p", "[3,4]", "1"), ("p", "[6,8]", "1")), None)
    assert turned.label == "length of k.v" and turned.place({"k.v": [3, 4]}) == 5.0
    assert turned.place({"k.v": ""}) is None
    for over, said in (("k.y", "no varied key called k.y"), ("k.name", "does not take several numbers")):
        with pytest.raises(CaseError, match=said):
            table.axis(both, over)
    with pytest.raises(CaseError, match=r"no key takes several numbers in this sweep, k.name, k.v, k.x"):
        table.axis(points_of(("p", "[1]", "1"), ("q", "['a',2]", "1")), None)


def test_metrics_are_numbers_of_some_summary():
    rows = [{"run": "a", **FINE, "k.x": 1, "lost_J": 2.0}, {"run": "b", "exit_code": 5, "reason": "", "k.x": 2}]
    rows[1]["lost_J"] = ""
    table.refuse_unknown(rows, ["k.x"], ["lost_J"])
    rows[1]["exit_code"] = 0
    table.refuse_unknown(rows, ["k.x"], ["lost_J"])  # it is told only where something was lost
    rows[1]["exit_code"] = 5
    with pytest.raises(CaseError, match="did you mean lost_J"):
        table.refuse_unknown(rows, ["k.x"], ["lost"])
    table.refuse_unknown(rows[1:], ["k.x"], ["lost"])  # no run is fine: they are told, and the metric is not known


@pytest.mark.parametrize(
    ("options", "runs", "said"),
    [
        (("heat.closure=geometric,paper", "--plot", "time_s"), 0, "no key takes several numbers"),
        (("heat.closure=geometric,paper", "--plot", "time_s", "--over", "heat.closure"), 0, "does not take several"),
        (("resolution.spacing_mm=20,25", "--plot", "time_s", "--over", "cell"), 0, "no varied key called cell"),
        (("resolution.spacing_mm=20,25", "--plot", "tim_s"), 1, "did you mean time_s"),
    ],
)
def test_a_figure_that_cannot_be_is_refused_as_soon_as_it_is_known(tmp_path, monkeypatch, capsys, options, runs, said):
    done = []

    def process(own):
        done.append(own)
        folder = tmp_path / "out" / "runs" / own.name
        folder.mkdir(parents=True)
        (folder / "summary.json").write_text('{"time_s": 1.0}')
        return {**FINE, "took_s": 0.0}

    monkeypatch.setattr(jobs, "done", process)
    command = ["sweep", "disc_cluster", "--gas", "embedded", "--out", str(tmp_path / "out"), "--set", *options]
    for _ in range(2):  # a second call knows it before it goes on
        assert cli.main(command) == 2
        assert said in capsys.readouterr().err.splitlines()[-1] and len(done) == runs


def test_a_figure_over_vectors(tmp_path):
    found = [{"run": "a", **FINE, "k.v": [0, x], "lost_J": math.nan if x == 2 else x} for x in (1, 2, 3)]
    found += [{"run": "b", "exit_code": 5, "reason": "", "k.v": [0, 4], "lost_J": ""}]
    path = table.draw(found, ["k.v"], ["lost_J"], table.Axis("k.v", True, 1), tmp_path / "sweep.png")
    assert path.stat().st_size > 5000


def test_a_run_without_the_number_is_a_cross_and_no_value():
    """What has none leaves a gap in the line; a text among numbers had made labels of all, in order of appearance."""
    from matplotlib import pyplot

    found = [{"run": "a", **FINE, "k.x": x, "rupture_s": told} for x, told in ((3, 0.3), (1, 0.75), (2, ""))]
    _, axis = pyplot.subplots()
    table._panel(axis, found, "rupture_s", table.Axis("k.x"), [])
    line, crosses = axis.lines
    np.testing.assert_array_equal(line.get_ydata(), [0.75, math.nan, 0.3])
    assert (list(line.get_xdata()), list(crosses.get_xdata())) == ([1, 2, 3], [2])
    assert [text.get_text() for text in axis.get_legend().get_texts()][-1] == "has none"
    pyplot.close()


@pytest.mark.parametrize(("left", "told"), [(1, False), (0, True)])
def test_a_number_that_may_still_come_is_waited_for(left, told):
    """The first run did not tear: another one may."""
    rows = [{"run": "a", **FINE, "k.x": 1, "time_s": 2.0}]
    with pytest.raises(CaseError, match="called rupture_time_s") if told else contextlib.nullcontext():
        table.refuse_unknown(rows, ["k.x"], ["rupture_time_s"], left)


def test_what_is_right_is_drawn_and_the_rest_named_first_after_one_run_and_in_the_end(tmp_path, monkeypatch, capsys):
    def done(own):
        folder = tmp_path / "runs" / own.name
        folder.mkdir(parents=True)
        (folder / "summary.json").write_text('{"time_s": 1.0, "centre_rise_K": 2.0, "heat_J": 3.0}')
        return {**FINE, "took_s": 0.0}

    monkeypatch.setattr(jobs, "done", done)
    command = ["sweep", "disc_cluster", "--gas", "embedded", "--out", str(tmp_path), "--plot", "heat_J"]
    command += ["--plot", "rise_of_centre_K", "--set", "resolution.spacing_mm=20,22,25"]
    for _ in range(2):
        assert cli.main(command) == 2
        *said, refused = capsys.readouterr().err.splitlines()
        assert (
            "no number of the summaries called rise_of_centre_K" in refused and "did you mean centre_rise_K" in refused
        )
        assert said[-1].endswith("sweep.png") and (tmp_path / "sweep.png").stat().st_size > 5000
        early = [n for n, line in enumerate(said) if "no summary yet has rise_of_centre_K (near: centre_rise_K" in line]
        assert early == ([2] if "3 of them to do" in said[0] else [])  # after the first run, once
        (tmp_path / "sweep.png").unlink()
    assert len(rows_of(tmp_path)) == 3


def test_lines_are_in_the_order_of_their_numbers():
    from matplotlib import pyplot

    found = [{"run": "a", **FINE, "k.x": x, "k.y": y, "lost_J": 1.0} for x in (1, 2) for y in (11, 22, 6, "auto")]
    _, axis = pyplot.subplots()
    table._panel(axis, found, "lost_J", table.Axis("k.x"), ["k.y"])
    assert [line.get_label() for line in axis.lines] == ["k.y = 6", "k.y = 11", "k.y = 22", "k.y = auto"]
    pyplot.close()


def test_a_sweep_goes_on_after_a_run_without_the_number(tmp_path, monkeypatch, capsys):
    """It is told when all runs are done, and a later call with more values goes on as well."""

    def done(own):
        folder = tmp_path / "runs" / own.name
        folder.mkdir(parents=True)
        torn = own.point["resolution.spacing_mm"] == "25"
        (folder / "summary.json").write_text('{"time_s": 1.0, "rupture_s": 0.5}' if torn else '{"time_s": 1.0}')
        return {**FINE, "took_s": 0.0}

    monkeypatch.setattr(jobs, "done", done)
    command = ["sweep", "disc_cluster", "--gas", "embedded", "--out", str(tmp_path), "--plot", "rupture_s", "--set"]
    assert cli.main([*command, "resolution.spacing_mm=20,22"]) == 2
    assert "no number of the summaries called rupture_s" in capsys.readouterr().err.splitlines()[-1]
    assert cli.main([*command, "resolution.spacing_mm=20,22,25"]) == 0
    assert [row["rupture_s"] for row in rows_of(tmp_path)] == ["", "", "0.5"]
