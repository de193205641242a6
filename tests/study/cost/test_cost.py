"""The ladder of accuracy: errors, orders, limits and choices on made rows; measuring, budget and resuming on a small
disc."""

import argparse
import json

import pytest

from sdph import scenes
from sdph.case import read as cases
from sdph.cli import arguments
from sdph.schema import CaseError
from sdph.study.cost import choice, climb, converged, errors, ladder, report, rows

SMALL = ladder.Ladder(
    reference="none",
    settings=["coupling.gas='embedded'"],
    excerpt=["run.end_time_s=0.002", "run.output_interval_s=0.001", "run.report_at_s=[]"],
    knobs={"resolution.spacing_mm": [20.0, 10.0], "resolution.cell_mm": [50.0, 25.0]},
    metrics=["centre_rise_K"],
)


def row(label="all 1/1", wall=1.0, value=0.0, reference=None, without=ladder.ALL, solver=rows.OWN, **settings):
    made = {"label": label, "solver": solver, "wall_s": wall, "without": without, "load": 0.0, "measured": "2026-11-22"}
    return made | {"metrics": json.dumps({"a": (value, reference, 2.0)})} | settings


def test_observed_order_of_second_order_rows():
    own = ladder.Ladder(reference="", knobs={"x": [4.0, 2.0, 1.0]})
    made = [row(value=7.0 + 0.1 * x**2, x=x) for x in (4.0, 2.0, 1.0)]
    assert rows.orders(own, made)["x"] == pytest.approx(2.0)


@pytest.mark.parametrize("p", [0.5, 1.0, 2.3])
def test_observed_order_of_steps_in_no_one_ratio(p):
    """Changes of c x^p between 5, 3 and 1."""
    assert converged.order(5.0, 3.0, 1.0, 5.0**p - 3.0**p, 3.0**p - 1.0) == pytest.approx(p)


def test_cheapest_holds_the_error_with_all_effects():
    made = [row(wall=9.0) | {"bound": 0.001}, row(wall=3.0) | {"bound": 0.015}, row(wall=0.5) | {"bound": 0.3}]
    made += [row(wall=1.0, without="drag") | {"bound": 0.0}, row(wall=0.1, solver="twoPhaseEulerFoam") | {"bound": 0.0}]
    assert rows.cheapest(made, 0.02)["wall_s"] == 3.0
    assert rows.cheapest(made, 0.01)["wall_s"] == 9.0
    assert rows.cheapest(made, 1e-4) is None
    assert [r["wall_s"] for r in rows.front(made)] == [0.5, 3.0, 9.0]


def test_each_solver_has_its_own_limit():
    """Another solver's levels halve their step each, ours have that of the first knob."""
    own = ladder.Ladder(reference="", knobs={"x": [9.0, 3.0, 1.0]})
    made = [row(f"all {n + 1}/3", value=5.0 + 0.1 * x, x=x) for n, x in enumerate((9.0, 3.0, 1.0))]
    made += [row(f"all {n + 1}/3", value=7.0 + 0.5**n, solver="other") for n in range(3)]
    assert [r["error"] for r in errors.judged(own, made)] == pytest.approx([0.45, 0.15, 0.05, 0.5, 0.25, 0.125])


def test_rungs_are_levels_single_knobs_and_effects_off():
    own = ladder.Ladder(
        reference="", knobs={"x": [3, 2, 1], "y": [6, 5, 4]}, alone={"z": [8]}, usual={"z": 9}, drop=["drag"]
    )
    found = ladder.rungs(own)
    assert [label for label, _ in found] == ["all 1/3", "all 2/3", "all 3/3", "x", "x", "y", "y", "z", "without drag"]
    assert found[3][1] == {"x": 3, "y": 5, "z": 9, "without": ladder.ALL}
    assert found[-2][1] == {"x": 2, "y": 5, "z": 8, "without": ladder.ALL}
    assert found[-1][1] == {"x": 2, "y": 5, "z": 9, "without": "drag"}


def test_ladder_is_measured_within_its_budget_and_resumed(tmp_path, monkeypatch):
    for module in (climb, report):
        monkeypatch.setattr(module, "declared", lambda scene: SMALL)
    file, said = tmp_path / "cost.csv", []
    assert climb.climb("disc_cluster", file, 0.0, 1, said.append) == []
    assert "budget is spent before all 1/2" in said[-1]
    first = climb.climb("disc_cluster", file, 1e9, 1, said.append)
    before = file.read_bytes()
    assert len(first) == len(ladder.rungs(SMALL)) == 4
    assert all(r["wall_s"] > 0.0 and r["particles"] > 50 for r in first)
    said.clear()
    again = climb.climb("disc_cluster", file, 1e9, 1, said.append)
    assert file.read_bytes() == before
    assert all("measured before" in line for line in said) and len(said) == 4
    assert "all 2/2" in report.text("disc_cluster", errors.judged(SMALL, again))
    report.draw("disc_cluster", errors.judged(SMALL, again), tmp_path / "cost.png")
    assert (tmp_path / "cost.png").stat().st_size > 10_000


def test_a_run_that_is_refused_without_an_effect_has_no_metrics(monkeypatch):
    """As where grains leave through a side that was a wall; refused with all effects it is no rung."""

    def refuse(case, scene, folder):
        raise CaseError("2 particles have left the domain")

    monkeypatch.setattr(climb, "_run", refuse)
    made = climb.measure("disc_cluster", SMALL, SMALL.middle | {"without": "conduction"}, 1)
    assert made["metrics"] == "{}" and made["wall_s"] != made["wall_s"]
    with pytest.raises(CaseError, match="have left"):
        climb.measure("disc_cluster", SMALL, SMALL.middle, 1)


def test_accuracy_takes_what_was_measured_and_says_so(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(choice, "declared", lambda scene: SMALL)
    for wall, (spacing, cell), value in ((1.0, (20.0, 50.0), 1.2), (4.0, (10.0, 25.0), 1.02)):
        settings = {"resolution.spacing_mm": spacing, "resolution.cell_mm": cell}
        climb._keep(tmp_path / "runs/cost/some/cost.csv", row("x", wall, value, 1.0, **settings))
    said = []
    assert not any("end_time" in setting for setting in choice.settings_for("some", ("", 0.4), said.append))
    assert "resolution.spacing_mm=20.0" in choice.settings_for(
        "some", ("", 0.4), said.append
    )  # 0.09 and three times that
    assert "resolution.spacing_mm=10.0" in choice.settings_for("some", ("", 0.3), said.append)
    assert "within 27 % of its limit" in said[-1] and "4 s" in said[-1]
    with pytest.raises(CaseError, match="in doubt by 27 %"):
        choice.settings_for("some", ("", 0.2), said.append)
    with pytest.raises(CaseError, match="sdph cost other"):
        choice.settings_for("other", ("", 0.02), said.append)


@pytest.mark.parametrize(("text", "seconds"), [("90", 90.0), ("90s", 90.0), ("10min", 600.0), ("2h", 7200.0)])
def test_budget_is_read_with_its_unit(text, seconds):
    assert arguments.seconds(text) == seconds


def test_accuracy_of_one_metric_asks_for_no_other(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(choice, "declared", lambda scene: SMALL)
    for wall, (spacing, cell), value in ((1.0, (20.0, 50.0), 1.2), (4.0, (10.0, 25.0), 1.02)):
        made = row("x", wall, value, 1.0, **{"resolution.spacing_mm": spacing, "resolution.cell_mm": cell})
        made["metrics"] = json.dumps(json.loads(made["metrics"]) | {"steady": (1.0, 1.0, None)})
        climb._keep(tmp_path / "runs/cost/some/cost.csv", made)
    said = []
    assert "resolution.spacing_mm=20.0" in choice.settings_for("some", ("steady", 0.01), said.append)
    assert said[-1].startswith("--accuracy steady=0.01: ")
    with pytest.raises(CaseError, match="ask for one metric alone: --accuracy 'steady=0.01'"):
        choice.settings_for("some", ("", 0.01), said.append)
    with pytest.raises(CaseError, match=r"no such metric; it has: .*steady"):
        choice.settings_for("some", ("stead", 0.01), said.append)


@pytest.mark.parametrize(
    ("text", "found"),
    [("5%", ("", 0.05)), ("a [J]=5%", ("a [J]", 0.05)), ("front at T = 3 = 0.1", ("front at T = 3", 0.1))],
)
def test_accuracy_may_name_a_metric(text, found):
    assert arguments.accuracy(text) == found


@pytest.mark.parametrize(("text", "found"), [("2%", 0.02), ("0.02", 0.02), ("100%", 1.0)])
def test_accuracy_is_a_share(text, found):
    assert arguments.share(text) == found


def test_an_accuracy_above_all_is_refused():
    with pytest.raises(argparse.ArgumentTypeError, match="did you mean 2%"):
        arguments.share("2")


def test_declared_ladders_name_keys_that_the_scene_has():
    assert ladder.with_ladder()
    for name in ladder.with_ladder():
        own = ladder.declared(name)
        assert len({len(values) for values in own.knobs.values()}) == 1
        assert own.steps == sorted(set(own.steps), reverse=True)  # numbers, the step of the levels
        for _, settings in ladder.rungs(own):
            assert ladder.case_of(name, own, settings)


def test_accuracy_leaves_what_is_simulated_as_it_is():
    """The ladder may look at an excerpt of a scene; the setting that it finds must not."""
    for name in ladder.with_ladder():
        own, case = ladder.declared(name), cases.load(scenes.find(name)[1])
        for _, settings in ladder.rungs(own):
            chosen = cases.load(scenes.find(name)[1], (*own.settings, *ladder.overrides(settings)))
            assert chosen.run.end_time == case.run.end_time and chosen.domain == case.domain
            assert (
                chosen.effects == case.effects
                and chosen.nozzles == case.nozzles
                and chosen.boundaries == case.boundaries
            )


def test_a_table_of_another_version_is_told(tmp_path):
    (tmp_path / "cost.csv").write_text("label,wall_s\nall 1/1,1.0\n")
    with pytest.raises(CaseError, match="remove it"):
        rows.read(tmp_path / "cost.csv")


def test_what_is_nothing_in_one_of_two_rows_has_changed_wholly():
    nothing, some = row(value=0.0), row(value=3.0)
    for made in (nothing, some):
        made["metrics"] = made["metrics"].replace("2.0]", "null]")
    assert rows.distance(nothing, some) == rows.distance(some, nothing) == 1.0
    assert rows.distance(nothing, nothing) == 0.0


def test_rows_of_another_ladder_do_not_go_below_a_head_that_is_not_theirs(tmp_path):
    file = tmp_path / "cost.csv"
    climb._keep(file, row(x=1.0))
    before = file.read_text()
    with pytest.raises(CaseError, match="move it away and measure again"):
        climb._keep(file, row(x=1.0, y=2.0))
    assert file.read_text() == before and len(rows.read(file)) == 1


def reported(monkeypatch, values, name="drop_Pa"):
    own = ladder.Ladder(knobs={"x": [10.0, 7.5, 5.0, 3.5]}, metrics=[name])
    made = [row(f"all {n + 1}/4", x=x) for n, x in enumerate(own.steps)]
    made = [one | {"metrics": json.dumps({name: (value, None, None)})} for one, value in zip(made, values)]
    monkeypatch.setattr(report, "declared", lambda scene: own)
    monkeypatch.setattr(report, "without", lambda scene, rows: [])
    return own, errors.judged(own, made)


def test_a_number_of_one_instant_that_swings_is_told_to_take_its_mean(monkeypatch):
    swinging, converging = (2133.6, 2288.0, 1981.1, 1972.3), (2.0, 1.5, 1.0, 0.7)
    told = report.text("some", reported(monkeypatch, swinging)[1])
    assert "set run.average_from_s and give mean_drop_Pa in place of drop_Pa" in told
    assert "the finest four rungs go up and down; doubt: the spread of the finest three" in told
    for values, name in ((converging, "drop_Pa"), (swinging, "mean_drop_Pa")):
        assert "average_from_s" not in report.text("some", reported(monkeypatch, values, name)[1])


def test_a_limit_has_its_sign_and_errors_are_told_per_cent(monkeypatch):
    own, made = reported(monkeypatch, (-257.0, -258.0, -258.8, -259.1))
    known = errors.converged(own, made)
    assert report._limit("drop_Pa", known["drop_Pa"])["limit"] == pytest.approx(-259.4, abs=0.1)
    own, made = reported(monkeypatch, (4.42, 3.42, 2.42, 1.0))
    assert report._row(own, made[0])["error"] == "342 %" and report._row(own, made[-1])["error"] == "0 %"


def test_names_in_the_figure_stay_within_it():
    from matplotlib import pyplot

    figure, axes = pyplot.subplots()
    axes.set(xscale="log", yscale="log")
    made = [row("all 1/1", wall=wall) | {"error": 0.1, "none": False} for wall in (1.0, 100.0)]
    report._points(axes, made)
    figure.canvas.draw()
    assert all(figure.bbox.contains(*corner) for text in axes.texts for corner in text.get_window_extent().corners())
    assert axes.lines[0].get_ydata() == [10.0]  # per cent
    assert [text.get_ha() for text in axes.texts] == ["left", "right"]
    pyplot.close(figure)


def test_names_in_the_figure_that_lie_on_another_are_counted_by_it():
    """The bed's 18 rungs and effects of about the same time and error were one black bar."""
    from matplotlib import pyplot

    figure, axes = pyplot.subplots()
    axes.set(xscale="log", yscale="log")
    crowd = [row(f"without {k}", without=str(k), wall=1.0 + 0.01 * k) for k in range(12)]
    made = [*crowd, row("all 1/1", wall=1.05), row("far", wall=50.0)]
    report._points(axes, [own | {"error": 0.1, "none": False} for own in made])
    figure.canvas.draw()
    assert len(axes.lines) == 14 and [text.get_text() for text in axes.texts] == ["all 1/1 (+ 12)", "far"]
    pyplot.close(figure)


def test_an_error_of_none_does_not_stretch_the_figure():
    """It was drawn at 1e-10 per cent, and all others in one line."""
    whole = row("all", wall=1.0) | {"error": 0.2, "bound": 0.3}
    rungs = [whole, whole | {"error": 0.05, "bound": 0.1}, whole | {"error": 0.0, "bound": float("inf")}]
    drawn = report._on_the_axis(rungs)
    assert [(own["error"], own["none"]) for own in drawn] == [(0.2, False), (0.05, False), (0.025, True)]
    assert [own["bound"] for own in drawn] == [0.3, 0.1, float("inf")]
