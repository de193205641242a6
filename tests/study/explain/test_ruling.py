"""Effects that rule the step alone are told of, with the steps that they cost."""

import pytest

from sdph import scenes
from sdph.case import read as cases
from sdph.study.explain import ruling, tables


def load(scene, *overrides):
    return cases.load(scenes.find(scene)[1], overrides)


def test_a_viscosity_that_makes_the_step_short_is_told_with_what_it_becomes():
    """By hand: 0.125 h^2/nu with h = 1.5 x 1.42875 mm is 5.74e-7 s, sound's 2.36e-5 s 41.1 times that."""
    (line,) = tables.warnings(load("dam_break", "liquid.viscosity_Pa_s=1000"))
    assert line.startswith("laminar_viscosity lets a step be 5.74e-07 s long at most, 41.1 times shorter than sound ")
    assert "348400 steps in place of 8500" in line
    assert line.endswith("look at liquid.viscosity_Pa_s = 1000; if mPa s was meant, give 1")


@pytest.mark.parametrize(("viscosity", "told"), [("242", False), ("244", True)])
def test_it_is_told_from_ten_times_on(viscosity, told):
    assert len(tables.warnings(load("dam_break", f"liquid.viscosity_Pa_s={viscosity}"))) == told


def test_the_phase_that_rules_is_named():
    """The liquid of 0.05 Pa s is a thousand times as dense."""
    (line,) = ruling.warnings(load("drop_on_plate", "gas_phase.viscosity_Pa_s=0.04"), 1.0, rows(laminar_viscosity=1e-9))
    assert "look at gas_phase.viscosity_Pa_s = 0.04;" in line


def rows(**others):
    return [{"cause": name, "largest [s]": value} for name, value in ({"sound": 1e-6} | others).items()]


def test_what_is_no_effect_rules_without_a_word():
    case = load("dam_break")
    assert ruling.warnings(case, 1.0, rows(force=1e-9)) == []
    assert ruling.warnings(case, 1.0, rows()) == []
    (line,) = ruling.warnings(case, 1.0, rows(surface_tension=1e-9))
    assert line.endswith("look at the units of [surface_tension]")


def test_moving_particles_are_told_of_it():
    (line,) = [own for own in tables.warnings(load("swirl_sheet", "liquid.viscosity_Pa_s=2400")) if "a step be" in own]
    assert "look at liquid.viscosity_Pa_s = 2400; if mPa s was meant, give 2.4" in line
