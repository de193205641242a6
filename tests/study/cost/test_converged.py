"""The limit of a ladder and what is promised by it: clean, crossing, turning, short and empty series."""

import itertools
import json
import math
import shutil

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sdph import scenes
from sdph.schema import CaseError
from sdph.study.cost import choice, climb, converged, errors, ladder, report, rows, summary

BED = 937.12, 831.43, 726.86, 649.24  # J, heat to the grains; two fluids give 705.6
STEPS = 8.0, 4.0, 2.0, 1.0


def own(steps=STEPS, **more):
    return ladder.Ladder(reference="two fluids", knobs={"x": list(steps)}, **more)


def row(x, value, reference=None, scale=None, wall=None, label="all", **more):
    made = {"label": label, "solver": rows.OWN, "without": ladder.ALL, "load": 0.0, "measured": "2026-11-22", "x": x}
    made |= {"wall_s": 1.0 / x**2 if wall is None else wall, "metrics": json.dumps({"a": (value, reference, scale)})}
    return made | more


def judged(values, steps=STEPS, reference=None, scale=None, more=()):
    return errors.judged(own(steps), [*(row(x, v, reference, scale) for x, v in zip(steps, values)), *more])


def walls(made, *accuracies):
    best = [rows.cheapest(made, accuracy) for accuracy in accuracies]
    return [one and one["wall_s"] for one in best]


@pytest.mark.parametrize("p", [0.51, 0.7, 1.0, 1.43, 1.99])
@pytest.mark.parametrize("steps", [(4.0, 2.0, 1.0), (50.0, 33.3, 20.0), (8.0, 5.0, 4.0, 3.0)])
@pytest.mark.parametrize("size", [3.0, -0.2])
def test_a_power_law_gives_its_limit(p, steps, size):
    found = converged.limit(list(steps), [5.0 + size * h**p for h in steps])
    assert found.value == pytest.approx(5.0)
    assert found.order == pytest.approx(p)
    assert found.doubt == pytest.approx(abs(size) * steps[-1] ** p)


@pytest.mark.parametrize("p", [2.5, 4.0, 9.0])
def test_more_than_second_order_is_not_believed(p):
    """The limit is then further away than the power law has it, and the truth within the doubt."""
    found = converged.limit([4.0, 2.0, 1.0], [5.0 + h**p for h in (4.0, 2.0, 1.0)])
    assert found.order == 2.0
    assert found.value == pytest.approx(6.0 - (2.0**p - 1.0) / 3.0)
    assert abs(found.value - 5.0) < found.doubt


@pytest.mark.parametrize("p", [0.4, 0.1, -1.0])
def test_changes_that_hardly_shrink_show_no_limit(p):
    values = [5.0 + math.copysign(1.0, p) * h**p for h in (4.0, 2.0, 1.0)]
    found = converged.limit([4.0, 2.0, 1.0], values)
    assert found.value == values[-1] and math.isnan(found.order)
    assert found.doubt == pytest.approx(3.0 * abs(values[1] - values[2]))


def test_a_series_that_turns_is_in_doubt_by_its_range():
    for values in itertools.permutations((1.0, 2.0, 3.0)):
        found = converged.limit([4.0, 2.0, 1.0], list(values))
        if (values[1] - values[0]) * (values[2] - values[1]) < 0.0:
            assert found[:2] == (values[-1], 2.0)
    assert converged.limit([4.0, 2.0, 1.0], [1.0, 3.0, 3.0])[:2] == (3.0, 2.0)


FLUCTUATING = (10.0, 7.5, 5.0, 3.5), (2133.6, 2288.0, 1981.1, 1972.3)  # Pa, of a bed at one instant; mm


def test_two_rungs_that_are_close_by_chance_sell_nothing():
    """The finest three go one way and less and less, as of an order above 2; the fourth shows that it is chance."""
    found = converged.limit(*map(list, FLUCTUATING))
    assert found[:2] == (1972.3, pytest.approx(2288.0 - 1972.3)) and math.isnan(found.order) and found.swings
    assert found.why == "the finest four rungs go up and down; doubt: the spread of the finest three"
    made = judged(FLUCTUATING[1], FLUCTUATING[0])
    assert walls(made, 0.02, 0.1, 0.15) == [None] * 3
    assert errors.refusal(own(FLUCTUATING[0]), made, 0.02) == (
        f"not shown to converge to 2 %: the limit of a is in doubt by 16 % ({found.why})"
    )
    assert converged.limit([10.0, 7.5, 5.0, 3.5], [2310.0, *FLUCTUATING[1][1:]]).why.startswith(
        "changes of the finest four rungs do not shrink"
    )
    clean = converged.limit([10.0, 7.5, 5.0, 3.5], [2700.0, *FLUCTUATING[1][1:]])
    assert clean.order == 2.0 and clean.why == "" and not clean.swings


@pytest.mark.parametrize("steps", [(8.0, 7.0, 4.0, 2.0), (4.0, 3.5, 2.0, 1.9, 1.0)])
def test_changes_of_uneven_steps_are_compared_by_their_steps(steps):
    """The second is larger than the first here, as its step is wider."""
    found = converged.limit(list(steps), [5.0 + h for h in steps])
    assert (found.value, found.order) == (pytest.approx(5.0), pytest.approx(1.0))


def test_two_levels_are_in_doubt_by_three_times_first_order():
    assert converged.limit([2.0, 1.0], [1.2, 1.1])[:2] == (1.1, pytest.approx(0.3))
    assert converged.limit([1.5, 1.0], [1.2, 1.1])[:2] == (1.1, pytest.approx(0.6))


def test_one_level_or_no_number_shows_nothing():
    assert converged.limit([1.0], [3.0]).doubt == math.inf
    assert converged.limit([2.0, 1.0], [math.inf, 1.0]).doubt == math.inf
    made = judged([3.0], (1.0,))
    assert walls(made, 0.5) == [None]
    assert "without bound" in errors.refusal(own((1.0,)), made, 0.5)


def test_a_series_that_does_not_move_is_at_its_limit():
    assert converged.limit([4.0, 2.0, 1.0], [7.0, 7.0, 7.0])[:2] == (7.0, 0.0)


@pytest.mark.parametrize("steps", [STEPS, (20.0, 12.5, 10.0, 5.0), (2.83, 2.0, 1.41, 1.0)])
def test_the_bed_does_not_sell_its_crossing_of_the_reference(steps):
    """727 J is 3 % from two fluids, and 649 J, finer, 8 %: neither is worth 5 %."""
    made = judged(BED, steps, 705.6)
    assert [r["off reference"] for r in made[2:]] == pytest.approx([0.0301, 0.0799], abs=1e-4)
    assert walls(made, 0.02, 0.05) == [None, None]
    assert errors.refusal(own(steps), made, 0.05).startswith("not shown to converge to 5 %: the ")
    assert all(r["bound"] >= r["error"] for r in made)


def test_a_second_order_series_is_priced_by_its_errors_and_the_doubt():
    """1 + h^2: 16, 4 and 1 % off its limit, which is in doubt by 1 %."""
    made = judged([1.16, 1.04, 1.01], (0.4, 0.2, 0.1), 1.0)
    assert [r["error"] for r in made] == pytest.approx([0.16, 0.04, 0.01])
    assert [r["bound"] for r in made] == pytest.approx([0.17, 0.05, 0.02])
    assert [wall and wall**-0.5 for wall in walls(made, 0.171, 0.051, 0.021, 0.019)] == pytest.approx(
        [0.4, 0.2, 0.1, None]
    )
    assert errors.refusal(own((0.4, 0.2, 0.1)), made, 0.019) == (
        "not shown to converge to 1.9 %: the finest level errs by up to 2 %"
    )
    assert errors.model_difference(own((0.4, 0.2, 0.1)), made) == ""


def test_a_level_has_the_errors_of_all_finer_ones():
    """The coarsest sits on the limit by chance: 1, 1.8, 1.4, 1.2, 1.1."""
    made = judged([1.0, 1.8, 1.4, 1.2, 1.1], (16.0, *STEPS), reference=1.0)
    assert [r["error"] for r in made] == pytest.approx([0.0, 0.8, 0.4, 0.2, 0.1])
    assert [r["bound"] for r in made] == pytest.approx([0.9, 0.9, 0.5, 0.3, 0.2])


@given(st.lists(st.floats(-1e3, 1e3), min_size=1, max_size=4), st.floats(0.001, 10.0))
def test_whatever_the_series_what_is_sold_holds_for_all_that_is_finer(values, accuracy):
    """No level within `accuracy` is followed by one that is further from the limit; refining never raises the bound."""
    steps = STEPS[: len(values)]
    made = judged(values, steps, 0.0, 1.0)
    bounds, errs = [r["bound"] for r in made], [r["error"] for r in made]
    assert bounds == sorted(bounds, reverse=True)
    best = rows.cheapest(made, accuracy)
    sold = [r["x"] for r in made].index(best["x"]) if best else len(made)
    assert all(error <= accuracy for error in errs[sold:])
    assert best is not None or bounds[-1] > accuracy


def test_one_key_alone_does_not_make_good_the_errors_of_the_others():
    """The middle errs by 0.4; a row beside it that sits on the limit has moved by 0.4 more."""
    lucky = row(9.0, 1.0, 1.0, label="y", wall=1e-3)
    *_, beside = judged([1.8, 1.4, 1.2, 1.1], reference=1.0, more=[lucky])
    assert (beside["error"], beside["bound"]) == pytest.approx((0.8, 0.9))
    still = row(9.0, 1.41, 1.0, label="y", wall=1e-3)
    *_, beside = judged([1.8, 1.4, 1.2, 1.1], reference=1.0, more=[still])
    assert (beside["error"], beside["bound"]) == pytest.approx((0.41, 0.51))


def test_without_an_effect_or_a_middle_nothing_is_promised():
    off = row(2.0, 1.2, 1.0, without="drag")
    assert judged([1.8, 1.4, 1.2, 1.1], reference=1.0, more=[off])[-1]["bound"] == math.inf
    (alone,) = errors.judged(own(), [row(9.0, 1.0, 1.0, label="y")])
    assert alone["bound"] == math.inf
    assert errors.refusal(own(), [alone], 0.1) == "no level of its ladder has been measured"


def test_a_limit_off_the_reference_is_told_as_a_difference_of_models():
    made = judged([1.26, 1.14, 1.11], (0.4, 0.2, 0.1), 1.0)
    assert [r["error"] for r in made] == pytest.approx([0.16, 0.04, 0.01])
    assert [r["off reference"] for r in made] == pytest.approx([0.26, 0.14, 0.11])
    said = errors.model_difference(own((0.4, 0.2, 0.1)), made)
    assert said.startswith("a converges to +10 % off the reference (doubt 1 %): a difference of model and reference")
    close = judged([1.163, 1.043, 1.013], (0.4, 0.2, 0.1), 1.0)  # 0.3 %, in doubt by 1 %
    assert errors.model_difference(own((0.4, 0.2, 0.1)), close) == ""


def test_a_reference_may_be_another_at_each_level():
    """As Ergun's drop of pressure is, over the bed that each level has."""
    steps, references = (4.0, 2.0, 1.0), (10.0, 20.0, 30.0)
    made = errors.judged(own(steps), [row(x, r * (1.0 + 0.01 * x), r) for x, r in zip(steps, references)])
    assert [r["error"] for r in made] == pytest.approx([0.04, 0.02, 0.01])


def test_zeros():
    assert [r["bound"] for r in judged([0.0, 0.0, 0.0], (4.0, 2.0, 1.0))] == [0.0] * 3
    assert [r["bound"] for r in judged([0.0, 0.0, 0.0], (4.0, 2.0, 1.0), 0.0, 1.0)] == [0.0] * 3
    to_zero = judged([4.0, 2.0, 1.0], (4.0, 2.0, 1.0))  # without a scale no share of it can be told
    assert min(r["bound"] for r in to_zero) > 1e9
    assert [r["error"] for r in judged([0.4, 0.2, 0.1], (4.0, 2.0, 1.0), 0.0, 1.0)] == pytest.approx([0.4, 0.2, 0.1])
    assert [r["bound"] for r in judged([1.0, 1.0, 0.0], (4.0, 2.0, 1.0), 0.0)] == [math.inf] * 3


def test_the_worst_metric_decides():
    steps, made = (4.0, 2.0, 1.0), []
    for x in steps:
        made.append(
            row(x, 0.0) | {"metrics": json.dumps({"good": (1.0, 1.0, None), "bad": (1.0 + 0.1 * x, 1.0, None)})}
        )
    assert [r["bound"] for r in errors.judged(own(steps), made)] == pytest.approx([0.5, 0.3, 0.2])


@pytest.fixture
def measured(tmp_path, monkeypatch):
    """Writes a ladder as that of the scene `some`."""
    monkeypatch.chdir(tmp_path)

    def write(values, reference):
        for module in (choice, report, summary):
            monkeypatch.setattr(module, "declared", lambda scene: own((4.0, 2.0, 1.0)))
        monkeypatch.setattr(summary, "with_ladder", lambda: ["some"])
        for x, value in zip((4.0, 2.0, 1.0), values):
            climb._keep(tmp_path / "runs/cost/some/cost.csv", row(x, value, reference))
        return tmp_path / "runs/cost"

    return write


def test_accuracy_refuses_in_one_line_what_is_not_shown(measured):
    measured((831.43, 726.86, 649.24), 705.6)
    with pytest.raises(CaseError) as refused:
        choice.settings_for("some", ("", 0.05), lambda text: None)
    line = str(refused.value)
    assert line.startswith("some is not shown to converge to 5 %: the limit of a is in doubt by") and "\n" not in line


def test_accuracy_tells_a_difference_of_models(measured):
    measured((1.14, 1.12, 1.11), 1.0)
    said = []
    assert choice.settings_for("some", ("", 0.0301), said.append) == ("x=2.0",)
    assert "within 3 % of its limit" in said[0]
    assert "of the numerics alone: a converges to +10 % off" in said[1] and "two fluids" in said[1]


def test_the_table_of_all_scenes_has_what_the_rows_say(measured):
    line = summary.table(measured((1.14, 1.12, 1.11), 1.0))[-1]
    cells = [cell.strip() for cell in line.split("|")[2:-1]]
    assert cells == ["a", "0.062 s", "0.25 s", "-", "-", "1 %", "1.0", "10 %", "two fluids", "2026-11-22", ""]


def test_the_table_of_all_scenes_refuses_a_crossing(measured):
    line = summary.table(measured((831.43, 726.86, 649.24), 705.6))[-1]
    assert [cell.strip() for cell in line.split("|")[3:7]] == ["-"] * 4


def test_accuracy_of_a_scene_is_not_that_of_a_folder_called_so(tmp_path, monkeypatch):
    """A case of one's own in a folder called disc_cluster was run with settings that were measured of the scene."""
    scene, mine = scenes.find("disc_cluster")[1], tmp_path / "disc_cluster/case.toml"
    mine.parent.mkdir()
    shutil.copy(scene, mine)
    monkeypatch.chdir(tmp_path)
    for target in (str(mine), "disc_cluster"):
        with pytest.raises(CaseError, match="declares no ladder"):
            choice.settings_for(target, ("", 0.05), lambda text: None)
    (mine.parent / "cost.toml").write_text("metrics = ['a']\n[knobs]\n'resolution.spacing_mm' = [20.0, 10.0, 5.0]")
    with pytest.raises(CaseError, match="nothing is measured for disc_cluster"):
        choice.settings_for("disc_cluster", ("", 0.05), lambda text: None)


def test_a_level_that_was_stopped_leaves_those_that_were_measured():
    """It has no metrics; the others' limit is as without it."""
    made = [row(x, 5.0 + x) for x in STEPS[1:]]
    stopped = row(STEPS[0], 0.0) | {"metrics": "{}"}
    assert errors.converged(own(), [stopped, *made]) == errors.converged(own(), made) != {}
    assert errors.judged(own(), [stopped, *made])[0]["error"] == math.inf
