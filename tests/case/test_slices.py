"""Slices of a profile: where they begin and end, what lies in which, and what is refused."""

import numpy as np
import pytest

from sdph import scenes
from sdph.case import read as cases
from sdph.case import slices
from sdph.schema import CaseError

COLUMN = scenes.HERE / "fluidised_column" / "case.toml"  # 0.03 by 0.45 m, cells of 10 mm
VESSEL = scenes.HERE / "cylindrical_bed" / "case.toml"


def of(file, *keys):
    case = cases.load(file, tuple(f"profiles.own.{key}" for key in keys))
    return case, case.profiles["own"]


def test_slices_are_as_thick_as_cells_or_as_asked_for():
    np.testing.assert_allclose(slices.edges(*of(COLUMN, 'along="y"')), np.arange(46) * 0.01, atol=1e-12)
    np.testing.assert_allclose(slices.edges(*of(COLUMN, 'along="x"', "slice_m=0.02")), [0.0, 0.015, 0.03])
    boxed = of(COLUMN, 'along="y"', "lower_m=[0.0,0.1]", "upper_m=[0.03,0.2]", "slice_m=0.05")
    np.testing.assert_allclose(slices.edges(*boxed), [0.1, 0.15, 0.2])


def test_rings_are_about_an_axis():
    case, own = of(VESSEL, 'along="r"', 'axis="z"', "centre_m=[0.05,0.05,0.0]", "slice_m=0.01")
    assert slices.edges(case, own)[0] == 0.0
    places = np.array([[0.05, 0.05, 0.3], [0.08, 0.09, 0.1]])
    np.testing.assert_allclose(slices.places(own, places), [0.0, 0.05], atol=1e-15)


def test_what_lies_in_a_box_counts():
    case, own = of(COLUMN, 'along="y"', "lower_m=[0.0,0.1]")
    np.testing.assert_array_equal(slices.within(case, own, np.array([[0.01, 0.09, 0.0], [0.01, 0.11, 0.0]])), [0, 1])


@pytest.mark.parametrize(
    ("file", "keys", "told"),
    [
        (COLUMN, ['along="z"'], "this case has the axes x and y"),
        (COLUMN, ['along="r"', "centre_m=[0.0,0.0]"], "three dimensions"),
        (VESSEL, ['along="r"'], "centre_m is missing"),
        (COLUMN, ['along="y"', "lower_m=[0.0]"], "2 components"),
        (COLUMN, ['along="y"', "lower_m=[0.0,0.2]", "upper_m=[0.03,0.1]"], "not above"),
        (COLUMN, ['along="y"', "slice_m=1e-6"], "at most 10000"),
        (scenes.HERE / "dam_break" / "case.toml", ['along="y"'], "of grains in a gas"),
    ],
)
def test_what_makes_no_slices_is_refused(file, keys, told):
    with pytest.raises(CaseError, match=told):
        of(file, *keys)


def test_a_name_that_is_no_name_of_a_file_is_refused():
    table = cases.to_table(cases.load(COLUMN)) | {"profiles": {"../own": {"along": "y"}}}
    with pytest.raises(CaseError, match="letters, digits"):
        cases.from_table(table)


def test_means_that_begin_at_the_end_are_refused():
    with pytest.raises(CaseError, match="average_from_s = 2 is not before the end"):
        cases.load(COLUMN, ("run.average_from_s=2.0",))
