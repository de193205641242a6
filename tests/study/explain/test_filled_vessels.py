"""Gas that is let in and finds no way out is told of, where it may be as dense as it likes."""

import pytest

from sdph import scenes
from sdph.case import read as cases
from sdph.running.driver import template_of
from sdph.study import closed_vessels, explained

BED = scenes.HERE / "bubbling_bed" / "case.toml"
SHUT = ("boundaries.outlet.kind='wall'",)
FED = "boundaries.jet is a velocity_inlet, and 0.188 m2/s of gas comes in on balance that finds no way out"


def told(*overrides, equation="operating"):
    case = cases.load(BED, (f"gas.equation_of_state='{equation}'", *overrides))
    return closed_vessels.warnings(case, template_of(case, "bubbling_bed"))


def test_gas_at_the_operating_pressure_that_stays_is_told_of():
    """0.02 m 7.5 m/s + 0.48 m 0.08 m/s into 0.5 m x 1 m."""
    (text,) = told(*SHUT)
    width, height = cases.load(BED).domain.size
    assert text.startswith(f"{FED}, as much as there is within {width * height / 0.1884:.3g} s")
    assert "gas_box_rel" in text and "pressure stays at gas.operating_pressure_Pa" in text
    assert told() == []


def test_of_ideal_gas_the_pressure_follows_without_the_heat_of_compression():
    (text,) = told(*SHUT, equation="ideal")
    assert text.startswith(FED) and "its pressure follows" in text and "c_p/c_v = 1.4" in text
    assert told(equation="ideal") == told(*SHUT, equation="constant") == []


def test_what_is_sucked_out_as_it_comes_in_is_not():
    sucked = "boundaries.outlet.kind='velocity_inlet'", "boundaries.outlet.velocity_m_s=[0.0, {}]"
    assert told(sucked[0], sucked[1].format(0.3768)) == []
    (text,) = told(sucked[0], sucked[1].format(0.5768))
    assert "0.1 m2/s of gas goes out on balance that finds no way in" in text


@pytest.mark.parametrize("whole", [False, True])
def test_explain_and_the_start_of_a_run_tell_it(whole):
    case = cases.load(BED, ("gas.equation_of_state='operating'", "coupling.gas='embedded'", *SHUT))
    given = case, template_of(case, "bubbling_bed")
    told = [row["warning"] for row in explained.explained(*given)["warnings"]] if whole else explained.warned(*given)
    assert len([text for text in told if text.startswith(FED)]) == 1
