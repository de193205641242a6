"""Damping of a liquid of any strength: no step turns a wave round, and explain names the limit."""

import numpy as np
import pytest
from decaying_waves import fastest

from sdph import scenes
from sdph.case import read as cases
from sdph.effects.liquids import liquid_damping
from sdph.methods.liquids.method import LiquidStepper
from sdph.study.explain import tables

STRONG = ("liquid_damping.alpha=20", "resolution.spacing_mm=5")


@pytest.mark.parametrize("kernel", ["wendland_c2", "cubic_spline"])
@pytest.mark.parametrize("dimensions", [2, 3])
def test_a_step_takes_no_more_than_all_of_a_wave(kernel, dimensions):
    """For h of 1.2 to 2 spacings."""
    rates = [fastest(kernel, ratio, dimensions) for ratio in (1.2, 1.3, 1.5, 2.0)]
    assert 0.5 < liquid_damping.STEP * max(rates) <= 1.0


def test_explain_names_it_where_it_is_strong():
    case = cases.load(scenes.HERE / "dam_break" / "case.toml", STRONG)
    rows = {row["cause"]: row for row in tables.explain(case)["limits"]}
    expected = 0.45 * case.smoothing_length / (20.0 * case.liquid.sound_speed)
    assert rows["liquid_damping"]["largest [s]"] == pytest.approx(expected) and rows["liquid_damping"]["rules"]
    weak = tables.explain(cases.load(scenes.HERE / "dam_break" / "case.toml", STRONG[1:]))["limits"]
    assert not {row["cause"]: row["rules"] for row in weak}["liquid_damping"]


@pytest.mark.parametrize("lighter", [1.0, 1000.0])
def test_two_phases_bear_what_the_lighter_does_among_the_heavier(lighter):
    """Each phase is damped by its own density, so that a light one bears half the step at worst, not a thousandth."""
    sets = ("liquid_damping.alpha=20", f"gas_phase.density_kg_m3={lighter}")
    case = cases.load(scenes.HERE / "water_under_air" / "case.toml", sets)
    rows = {row["cause"]: row for row in tables.explain(case)["limits"]}
    among = 2000.0 / (1000.0 + lighter)
    expected = 0.45 * case.smoothing_length / (among * 20.0 * case.liquid.sound_speed)
    assert rows["liquid_damping"]["largest [s]"] == pytest.approx(expected, rel=1e-12)


def test_two_phases_that_are_damped_strongly_come_to_rest():
    """The limit rules, and no step turns a wave of either phase round."""
    sets = ("liquid_damping.alpha=20", "resolution.spacing_mm=125")
    case = cases.load(scenes.HERE / "water_under_air" / "case.toml", sets)
    stepper, speeds = LiquidStepper(case), []
    for _ in range(300):
        stepper.step(1.0)
        assert stepper.limit == "liquid_damping"
        speeds.append(float(np.abs(stepper.state.v[stepper.active]).max()))
    assert max(speeds[200:]) < max(speeds[:100]) < 0.05
