"""An effect that is off leaves nothing behind: no parameters, no array, no field on the wire."""

import pytest
from builders import DISC

from coupling.gas import SOURCES
from sdph import effects, scenes
from sdph.case import read as cases
from sdph.exchange.exchange import Exchange
from sdph.methods.grains import start
from sdph.study.explain import effect_costs, prices

BED = cases.load(scenes.HERE / "bubbling_bed" / "case.toml", effect_costs.BED)


@pytest.mark.parametrize("name", BED.effects)
def test_off_leaves_nothing(name):
    off = effect_costs.without(BED, name)
    assert effects.kernel_of(effects.REGISTRY[name], off) == effects.OFF
    needed = {array for other in off.effects for array in effects.REGISTRY[other].arrays}
    state = start.fill(off, needed)
    for array in effects.REGISTRY[name].arrays:
        assert bool(len(getattr(state, array))) == (array in needed)
    sent = Exchange(off, effect_costs.Still(off).mesh, {row: () for row in effects.REGISTRY}).sources
    for source in effects.REGISTRY[name].sources:
        assert (source in sent) == any(source in effects.REGISTRY[other].sources for other in off.effects)


def test_heat_alone_sends_no_momentum():
    case = cases.load(DISC)
    sent = Exchange(case, effect_costs.Still(case).mesh, {row: () for row in effects.REGISTRY}).sources
    assert set(sent) == {"alpha_g", "heat_coefficient", "heat"} <= SOURCES.keys()


def test_a_sub_step_is_timed_and_moves_the_grains():
    table = cases.to_table(BED) | {"effects": ["gravity"]}
    simulation = effect_costs.prepared(
        cases.from_table({key: value for key, value in table.items() if key not in effects.REGISTRY})
    )
    before = simulation.stepper.steps
    assert effect_costs.step(simulation, 1e-3) > 0.0
    assert simulation.stepper.steps == before + 1
    assert simulation.state.v == pytest.approx(-9.81e-3)


def test_a_liquid_is_measured_by_its_own_steps(tmp_path, monkeypatch):
    """What is kept makes the estimate of the case that it was measured on; of few particles nothing is."""
    monkeypatch.setattr(prices, "MEASURED", tmp_path / "speed.json")
    case = cases.load(scenes.HERE / "hydrostatic_tank" / "case.toml", ("resolution.spacing_mm=50",))
    monkeypatch.setattr(effect_costs, "FEW", 10**6)
    effect_costs.measured(case, lambda line: None)
    before = prices.speed()
    assert before == prices.SHIPPED
    monkeypatch.setattr(effect_costs, "FEW", 1)
    (row,) = effect_costs.measured(case, lambda line: None)
    assert row["method"] == "liquid" and prices.of_liquid(case) == pytest.approx(row["particle and step [us]"])
    kept = prices.speed()
    assert kept.moving == before.moving and kept.measured.startswith("this machine")
