"""What `sdph validate` holds a scene to: each reference gives a check, and no check of the record is lost."""

import json
import math
from types import SimpleNamespace

import pytest

from sdph import cli
from sdph.study import compare, record, validate

HELD, MISSED = compare.check("flux", 1.0, 1.0, 0.01, True), compare.check("level", 0.2, 0.0, 1e-3)
REPORTED = compare.check("share", 0.3, 1.0, math.inf)
RECORD = [check | {"name": f"one, exact: {check['name']}"} for check in (HELD, MISSED, REPORTED)]


def run_of(monkeypatch, **references):
    """Runs of nothing, whose references give what they are told to."""
    module = SimpleNamespace(**{name: lambda run, found=found: found for name, found in references.items()})
    monkeypatch.setattr(validate.compare, "scene_module", lambda scene: module)
    monkeypatch.setattr(validate.driver, "run", lambda *given: None)
    monkeypatch.setattr(validate.compare, "open_run", lambda folder: SimpleNamespace(summary={}, notices=[]))


def verdicts(checks) -> dict:
    return {check["name"]: check["ok"] for check in checks}


def test_a_reference_that_gives_no_check_has_missed(tmp_path, monkeypatch):
    """Among others that hold, and alone."""
    run_of(monkeypatch, exact=[HELD], tfm=[])
    found = validate.validate("poiseuille", (), None, tmp_path)
    assert verdicts(found) == {"poiseuille, exact: flux": True, "poiseuille, tfm: gives a check": False}


def test_a_part_of_a_study_that_gives_no_check_has_missed(tmp_path, monkeypatch):
    part = validate.part(validate.EXPERIMENTS, "liquid_fluidisation")
    monkeypatch.setattr(part, "checks", lambda *given: [])
    found = validate.validate("experiments.liquid_fluidisation", (), None, tmp_path)
    assert verdicts(found) == {"liquid_fluidisation: gives a check": False}
    assert found[0]["part"] == "liquid_fluidisation"


def test_a_check_that_the_record_has_and_the_run_lacks_has_missed(tmp_path):
    """By name, as often as it is there; one that is new is no matter."""
    record.write(tmp_path, "one", [*RECORD, RECORD[0]], None)
    assert validate.vanished("one", [*RECORD, RECORD[0], HELD], tmp_path) == []
    (found,) = validate.vanished("one", RECORD, tmp_path)
    assert found["name"] == "one, exact: flux" and not found["ok"] and math.isnan(found["value"])
    assert found["reference"] == 1.0
    gone = validate.vanished("one", RECORD[:1], tmp_path)
    assert verdicts(gone) == {"one, exact: flux": False, "one, exact: level": False, "one, exact: share": False}
    assert "share" in compare.table(gone)  # whose infinite tolerance JSON has not kept
    assert validate.vanished("two", [], tmp_path) == validate.vanished("two", [], None) == []


def test_the_record_that_came_along_is_held_to_where_no_other_is_kept(tmp_path):
    shipped = record.read(validate.paths.data("validation") / "record", "poiseuille")["checks"]
    for folder in (None, tmp_path / "new"):
        assert [check["name"] for check in validate.vanished("poiseuille", [], folder)] == [
            check["name"] for check in shipped
        ]


def test_a_lost_check_ends_validate_by_1_and_stays_in_the_record(tmp_path, monkeypatch, capsys):
    """Until somebody deletes it there; not where keys are overridden, which may end a run before."""
    record.write(tmp_path, "one", RECORD, None)
    monkeypatch.setattr(validate, "validate", lambda *given: [RECORD[0]])
    assert cli.main(["validate", "poiseuille", "--set", "run.end_time_s=1"]) == cli.FINE
    assert cli.main(["validate", "poiseuille"]) == cli.CHECK_FAILED
    capsys.readouterr()
    words = ["validate", "one", "--record", str(tmp_path), "--json"]
    assert "lacks" not in capsys.readouterr().err
    for _ in range(2):
        assert cli.main(words) == cli.CHECK_FAILED
        out, err = capsys.readouterr()
        assert "one lacks 2 checks that its record has" in err
        assert verdicts(json.loads(out)["checks"]) == verdicts(record.read(tmp_path, "one")["checks"])
    kept = record.read(tmp_path, "one")["checks"]
    assert [(check["ok"], check["value"]) for check in kept] == [(True, 1.0), (False, None), (False, None)]
    record.write(tmp_path, "one", RECORD[:1], None)
    assert cli.main(words) == cli.FINE


@pytest.mark.parametrize("gas", [(), ("--gas", "embedded")])
def test_a_solver_that_is_asked_for_loses_no_check(tmp_path, monkeypatch, gas):
    record.write(tmp_path, "one", RECORD, None)
    monkeypatch.setattr(validate, "validate", lambda *given: RECORD[:1])
    assert cli.main(["validate", "one", *gas, "--record", str(tmp_path)]) == cli.CHECK_FAILED
