"""`sdph explain` of bodies alone."""

import pytest

from sdph import scenes
from sdph.case import read as cases
from sdph.study.explain import tables


def load(scene, *overrides):
    return cases.load(scenes.find(scene)[1], overrides)


def numbers(case):
    return {row["number"]: row["value"] for row in tables.explain(case)["numbers"]}


def test_the_rise_of_a_load_is_told_in_periods_of_the_ring():
    """The dry ring breathes at 43.3 kHz (gel_reference.json, ring_breathing_0.45_0.5); its load rises in 0.2 ms."""
    own = numbers(load("thick_ring"))
    assert own["rise of the load / ring's period"] == pytest.approx(2e-4 * 43324.2, rel=1e-3)
    assert not any("period" in name for name in numbers(load("taylor_bar")))


def test_a_load_that_rises_quicker_than_the_ring_answers_is_told_where_checks_take_rest():
    swift = "inflation.rise_time_s=2e-5"
    (line,) = tables.warnings(load("thick_ring", swift))
    assert line.startswith("inflation.rise_time_s = 2e-05 is 0.866 periods of the ring's breathing")
    (line,) = tables.warnings(load("thick_ring", "inflation.rise_time_s=0.0"))
    assert "up to 100 % of the load" in line
    assert tables.warnings(load("thick_ring")) == []
    assert tables.warnings(load("thick_ring", swift, "run.accuracy=0.5")) == []
    assert tables.warnings(load("thick_ring", swift, 'scene=""')) == []
