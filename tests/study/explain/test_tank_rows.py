"""Rows of `explain` on a tank: its volume, and what its pools hold."""

import math

import pytest

from sdph import scenes
from sdph.case import read as cases
from sdph.study.explain import vessel


def rows(scene, *overrides):
    return vessel.rows(cases.load(scenes.find(scene)[1], overrides))


def test_a_sphere_filled_to_a_part():
    """Water up to 15 % of a sphere of 1 m3 or so: the height of that cap by its closed form."""
    tank, pool = rows("sloshing_sphere")
    case = cases.load(scenes.find("sloshing_sphere")[1])
    radius, middle = case.parameters["tank"].radius, case.parameters["tank"].centre[2]
    assert tank["volume [m3]"] == pytest.approx(4.0 / 3.0 * math.pi * radius**3)
    assert pool["volume [m3]"] == pytest.approx(0.15 * tank["volume [m3]"], rel=1e-3)
    assert pool["mass [kg]"] == pytest.approx(case.liquid.density * pool["volume [m3]"])
    high = pool["surface, upwards [m]"] - middle + radius
    cap = math.pi * high**2 * (3.0 * radius - high) / 3.0
    assert cap == pytest.approx(pool["volume [m3]"], rel=0.01)


def test_a_case_without_a_tank_has_none():
    assert rows("taylor_green") == [] and rows("bubbling_bed") == []
