"""Steps and windows that are longer than usual are told of, with the reason."""

import pytest

from sdph import scenes
from sdph.case import paced
from sdph.case import read as cases
from sdph.study import explained


def load(scene, *overrides):
    return cases.load(scenes.find(scene)[1], overrides)


@pytest.mark.parametrize("scene", scenes.names())
def test_no_scene_is_warned_of(scene):
    assert paced.warnings(load(scene)) == []


@pytest.mark.parametrize(("scene", "given", "why"), [
    ("bubbling_bed", "run.step_factor=1000", "1000 times as long as the limits of the effects, most of which are"),
    ("dam_break", "run.step_factor=1.5", "run.step_factor = 1.5: steps are 1.5 times as long"),
    ("bubbling_bed", "coupling.courant=50", "gas may cross 50 cells in a window"),
])  # fmt: skip
def test_what_is_beyond_the_usual_is_told_with_the_reason(scene, given, why):
    (line,) = paced.warnings(load(scene, given))
    assert why in line and given.split("=")[0] in line
    assert line in explained._of_case(load(scene, given), scenes.HERE)


@pytest.mark.parametrize("given", ["run.step_factor=1", "run.step_factor=0.01", "coupling.courant=20"])
def test_what_is_usual_is_not(given):
    assert not paced.warnings(load("bubbling_bed", given))


def test_a_courant_number_without_a_gas_says_nothing():
    assert not paced.warnings(load("dam_break", "coupling.courant=50"))
