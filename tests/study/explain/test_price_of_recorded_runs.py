"""`sdph explain` of a spray prices the sheet whose drops it is of."""

import pytest

from sdph import scenes
from sdph.case import judge
from sdph.case import read as cases
from sdph.study import explained
from sdph.study.explain import mps, recorded, tables


def load(scene, *overrides):
    return cases.load(scenes.find(scene)[1], overrides)


def test_the_sheet_of_a_spray_has_the_price_that_it_has_alone():
    spray = load("swirl_spray")
    sheet = judge.scales_of(load("swirl_sheet", *spray.nozzles["mouth"].record_set))
    alone = {row["what"]: row["value"] for row in mps.expected(sheet, mps.limits(sheet))}
    found = recorded.rows(spray, [{"what": "wall time", "value": 100.0, "unit": "s"}])
    own = {row["what"]: row["value"] for row in found if row["nozzle"] == "mouth" and row["records"] == "swirl_sheet"}
    assert own == alone and alone["wall time"] > 100.0
    assert found[-1]["what"] == "wall time of all"
    assert found[-1]["value"] == pytest.approx(100.0 + alone["wall time"])


def test_explain_shows_it(tmp_path):
    parts = explained.explained(load("swirl_spray", 'coupling.gas="embedded"'), tmp_path)
    own = {row["what"]: row["value"] for row in parts["runs before it"]}
    (alone,) = [row["value"] for row in parts["expected"] if row["what"] == "wall time"]
    assert own["wall time of all"] == pytest.approx(alone + own["wall time"])
    assert "RUNS BEFORE IT" in tables.text(parts)


def test_what_has_been_run_is_not_priced(tmp_path):
    file = tmp_path / "case.toml"
    file.write_text(cases.dumps(load("swirl_sheet")))
    (tmp_path / "droplets.csv").write_text("time_s\n")
    spray = load("swirl_spray", f'nozzles.mouth.record="{tmp_path}"', "nozzles.mouth.record_set=[]")
    (row,) = recorded.rows(spray, [])
    assert row["what"] == "has been run already" and row["value"] == str(tmp_path)


def test_other_cases_record_nothing():
    assert recorded.rows(load("spray_cone"), []) == []
    assert recorded.rows(load("swirl_sheet"), [{"what": "wall time", "value": 1.0}]) == []
