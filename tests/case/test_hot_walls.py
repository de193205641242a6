"""Walls whose temperature grains do not feel are told of."""

import pytest

from sdph import scenes
from sdph.case import hot_walls
from sdph.case import read as cases
from sdph.study import explained

HOT = "boundaries.walls.temperature_K=450"
FELT = f"effects={[*cases.load(scenes.find('bubbling_bed_3d')[1]).effects, 'wall_heat']!r}"


def load(*overrides):
    return cases.load(scenes.find("bubbling_bed_3d")[1], overrides)


def test_walls_that_grains_do_not_feel_are_named():
    case = load(HOT)
    (line,) = hot_walls.warnings(case)
    assert line.startswith("boundaries walls: the gas feels") and "wall_heat in effects" in line
    assert line in explained._of_case(case, scenes.HERE)


@pytest.mark.parametrize("more", [(), (HOT, FELT), (HOT.replace("450", "288"), "boundaries.jet.temperature_K=288")],
                         ids=["cold", "felt", "as warm as all else"])  # fmt: skip
def test_others_are_not(more):
    assert not hot_walls.warnings(load(*more))


@pytest.mark.parametrize("scene", scenes.names())
def test_no_scene_is_warned_of(scene):
    assert not hot_walls.warnings(cases.load(scenes.find(scene)[1]))
