"""Limits that `explain` lists follow the factor on steps."""

import pytest

from sdph import scenes
from sdph.case import read as cases
from sdph.study.explain import factor, tables


def limits(scene, *overrides):
    rows = tables.explain(cases.load(scenes.find(scene)[1], overrides))["limits"]
    return {(row.get("of"), row["cause"]): row for row in rows}


@pytest.mark.parametrize(("scene", "coarse"), [("fluidised_column", ("resolution.spacing_mm=7.5",)), ("dam_break", ())])
def test_limits_of_steps_follow_the_factor_and_those_of_windows_do_not(scene, coarse):
    whole, half = limits(scene, *coarse), limits(scene, *coarse, "run.step_factor=0.5")
    assert whole.keys() == half.keys()
    for (of, cause), row in whole.items():
        share = 1.0 if of == "window" else 0.5
        assert half[of, cause]["largest [s]"] == pytest.approx(share * row["largest [s]"], rel=1e-12), cause
        assert half[of, cause]["rules"] == row["rules"]
        assert half[of, cause].get("how", "").endswith("times run.step_factor") == (of == "sub-step")


def test_a_sub_step_that_windows_alone_limit_does_not_follow():
    case = cases.load(scenes.find("fluidised_column")[1], ("run.step_factor=0.5",))
    rows = [{"of": "sub-step", "cause": "window", "largest [s]": 1.0, "how": ""}]
    assert factor.applied(case, rows) == rows
