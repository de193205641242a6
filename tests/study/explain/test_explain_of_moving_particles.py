"""`sdph explain` of moving particles against their runs, and what it and `run` refuse alike."""

import pytest

from sdph import scenes
from sdph.case import read as cases
from sdph.engine.clock import alone
from sdph.methods.mps.method import MpsStepper
from sdph.methods.mps.scales import scales_of
from sdph.schema import CaseError
from sdph.study.explain import mps, tables

COARSE = "resolution.spacing_mm=5.715"  # of dam_break: ten across its column


def load(scene: str, *changes: str):
    return cases.load(scenes.HERE / scene / "case.toml", ("method.name=mps", *changes))


def foreseen(case) -> int:
    (found,) = [row["value"] for row in tables.explain(case)["expected"] if row["what"] == "steps"]
    return found


def taken(case) -> int:
    """Steps of a run, which stops at each row of its history."""
    stepper, clock = MpsStepper(case), alone(case)
    while not clock.over(stepper.time):
        end = clock.next(stepper.time)
        while stepper.time < end - clock.shortest:
            stepper.step(end - stepper.time)
    return stepper.steps


@pytest.mark.parametrize(("scene", "changes"), [
    ("dam_break", (COARSE,)),
    ("dam_break", (COARSE, "pools.column.lower_m=[0.1,0.06]", "pools.column.upper_m=[0.15,0.1]")),  # a block that falls
    ("hydrostatic_tank", ("resolution.spacing_mm=50", "run.end_time_s=0.5")),
])  # fmt: skip
def test_steps_are_those_of_the_run(scene, changes):
    """260 steps of the dam break and 258 of the block, 300 told; 80 of water at rest, and 80 told."""
    case = load(scene, *changes)
    assert foreseen(case) == pytest.approx(taken(case), rel=0.2)


def test_liquid_falls_to_the_level_at_which_its_tank_holds_it():
    """A column a wide and 2 a high in a channel of 5 a: to 0.4 a. Water at rest is there."""
    a = 0.05715
    assert scales_of(load("dam_break", COARSE)).drop == pytest.approx(1.6 * a, rel=2e-3)
    assert scales_of(load("hydrostatic_tank")).drop == pytest.approx(0.0, abs=1e-3)
    tipped = "domain.gravity_m_s2=[9.81,0.0]"  # the column then lies on its side, before a floor that is 3 a long
    assert scales_of(load("dam_break", COARSE, tipped)).drop == pytest.approx((5.0 - 2.0 / 3.0) * a, rel=2e-3)


def test_a_fall_ends_with_the_run_or_on_the_floor():
    """Without a tank g t is added to what liquid starts with, 0.3 m/s; with outflow the floor of the domain ends it."""
    table = cases.to_table(load("dam_break", COARSE, "pools.column.velocity_m_s=[0.3,0.0]"))
    table["effects"] = ["gravity"]
    table.pop("tank")
    case = cases.from_table(table)
    assert scales_of(case).reached == pytest.approx(0.3 + 9.81 * 0.2)
    table |= {"effects": ["gravity", "outflow"], "run": table["run"] | {"end_time_s": 5.0, "output_interval_s": 0.5}}
    assert scales_of(cases.from_table(table)).reached == pytest.approx((0.3**2 + 2.0 * 9.81 * 0.1143) ** 0.5)


@pytest.mark.parametrize(("change", "told"), [
    ({"pools": {"column": {"shape": "tank", "fill": 0.5}}}, "pools.column has shape = 'tank'"),
    ({"pools": {}}, "no liquid: give it in a section"),
    ({"run": {"end_time_s": 0.1, "output_interval_s": 0.1, "forces": ["left"]}},
     r'with method.name = "mps" history.csv has the force on the whole tank alone'),
    ({"domain": {"size_m": [0.3, 0.3], "lower_m": [-0.1, 0.0], "gravity_m_s2": [0.0, -9.81]}},
     'not of solids nor of method.name = "mps"'),
])  # fmt: skip
def test_what_moving_particles_cannot_be_is_refused_as_the_case_is_read(change, told):
    """So that `run` ends as `explain` does, before either makes or judges anything."""
    with pytest.raises(CaseError, match=told):
        cases.from_table(cases.to_table(load("dam_break", COARSE)) | change)


def test_a_pool_outside_its_tank_is_not_sent_to_what_is_refused():
    wide = load("dam_break", COARSE, "pools.column.upper_m=[0.4,0.1]")
    with pytest.raises(CaseError, match="make it smaller$"):
        mps.limits(scales_of(wide))
