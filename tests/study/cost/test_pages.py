"""The table of what accuracy costs, and the page of the estimates, are what their scripts make."""

import pytest
from scripts import script

from sdph.scenes import paths
from sdph.study.cost import ladder, report, rows


def test_pages_are_what_the_rows_say():
    """Else: python validation/cost_table.py"""
    made = script("cost_table")
    for file, text in made.pages().items():
        assert file.read_text(encoding="utf-8") == text, file
    assert made.BEGIN in made.PAGE.read_text(encoding="utf-8")


def test_every_ladder_was_measured_and_its_rows_are_of_it():
    """A row of settings that the ladder does not have any more is stale."""
    for scene in ladder.with_ladder():
        own = ladder.declared(scene)
        measured = [
            row for row in rows.read(paths.data("validation") / scene / "cost.csv") if row["solver"] == rows.OWN
        ]
        wanted = [settings for _, settings in ladder.rungs(own)]
        assert all(any(rows.has(row, settings) for settings in wanted) for row in measured), scene
        assert all(any(rows.has(row, own.level(n)) for row in measured) for n in range(own.count)), scene


def test_what_is_between_the_marks_is_replaced_and_nothing_else():
    made = script("cost_table")
    text = f"before\n{made.BEGIN}old\nlines{made.END}\nafter\n"
    assert made.with_table(text, ["new"]) == f"before\n{made.BEGIN}new{made.END}\nafter\n"
    assert made.with_table("no marks\n", ["new"]) == "no marks\n"


@pytest.mark.parametrize(
    ("change", "estimate", "right"),
    [(0.3, 0.1, True), (0.31, 0.1, False), (0.1, 0.3, True), (0.1, 0.31, False), (16.0, 1.0, True),
     (0.009, 1e-9, True), (0.011, 1e-9, False), (0.0, 0.5, False), (0.0, 0.0, True)],
)  # fmt: skip
def test_an_estimate_is_right_within_a_factor_of_three_or_of_no_account(change, estimate, right):
    assert report.near(change, estimate) is right


def test_misses_stand_as_misses():
    made = script("estimates")
    effects = made.effects_table([("a", "drag", 0.5, 0.4), ("a", "heat", 0.5, 0.1)])
    assert "| a | drag | 0.5 | 0.4 |  |" in effects and "| a | heat | 0.5 | 0.1 | miss |" in effects
    assert "1 of 2 are right" in effects
    counts = made.counts_table([("a", 129, 100.0, 69, 100.0), ("b", None, 7.0, 100, 100.0)])
    assert "| a | 129 | 100 | 1.29 | 69 | 100 | 0.69 | miss |" in counts
    assert "| b | - | - | - | 100 | 100 | 1.00 |  |" in counts
    assert "2 of 3 numbers are right" in counts
