"""A number and the edge that it is judged by read otherwise wherever they are not the same."""

import math

import pytest

from sdph import scenes
from sdph.case import read as cases
from sdph.study.explain import edges, tables


@pytest.mark.parametrize(
    ("value", "edge", "told"),
    [
        (10.06, 10.07, "10.06, safe from 10.07 on"),
        (10.0, 10.07, "10, safe from 10.1 on"),
        (9.9996, 10.0, "9.9996, safe from 10 on"),
        (10.0 - 1e-14, 10.0, "9.99999999999999, safe from 10 on"),
        (2.0, 3.0, "2, safe from 3 on"),
    ],
)
def test_digits_are_as_many_as_tell_the_side(value, edge, told):
    row = {"ratio": "body / spacing", "value": value, "least": edge, "most": math.inf, "safe": "NO", "why": "thin"}
    assert edges.unsafe([row, row | {"safe": "yes"}]) == [f"body / spacing = {told}: thin"]


def test_both_edges_are_told_with_the_same_digits():
    row = {"ratio": "cell / h", "value": 4.0004, "least": 0.25, "most": 4.0, "safe": "NO", "why": "coarse"}
    assert edges.outside(row) == "cell / h = 4.0004, safe from 0.25 to 4: coarse"


def test_tables_show_them_too_and_other_rows_are_as_before():
    text = tables.table([
        {"number": "a", "value": 0.99996, "threshold": 1.0}, {"number": "b", "value": 1 / 3, "threshold": 1 / 3},
        {"number": "c", "value": 0.123456, "threshold": 1.0}, {"number": "d", "value": math.nan, "threshold": 1.0},
    ])  # fmt: skip
    own = [line.split()[1:] for line in text.splitlines()[1:]]
    assert own == [["0.99996", "1"], ["0.333", "0.333"], ["0.123", "1"], ["-", "1"]]


def test_explain_of_a_plate_just_too_thin_shows_on_which_side_it_is():
    """h = 1.3 spacings: safe is sqrt(60) 1.3 = 10.0698 spacings."""
    table = cases.parsed(scenes.find("taylor_bar")[1])
    del table["rigid_sides"]
    table["resolution"] = {"spacing_mm": 1.0, "smoothing_ratio": 1.3}
    table["bodies"] = {"plate": {"shape": "box", "lower_m": [0.0, 0.0], "upper_m": [0.2, 0.01006]}}
    table |= {"dimensions": 2, "effects": [], "run": {"end_time_s": 1e-3, "output_interval_s": 1e-3}}
    table["domain"] = {"size_m": [0.3, 0.3], "gravity_m_s2": [0.0, -9.81]}
    case = cases.from_table(table)
    (line,) = [one for one in tables.warnings(case) if one.startswith("slender")]
    assert line.startswith("slender body / spacing = 10.06, safe from 10.07 on")
    (row,) = [one for one in tables.text({"ratios": tables.explain(case)["ratios"]}).splitlines() if "slender" in one]
    assert row.split()[4:6] == ["10.06", "10.07"]
