"""Records of `sdph validate`: what is kept of a scene, and by which command."""

import json
import subprocess

import pytest

from sdph import __version__, cli
from sdph.scenes import paths
from sdph.study import compare, record, validate

CHECKS = [compare.check("flux", 1.02, 1.0, 0.01, True), compare.check("level", float("nan"), 0.0, 1e-3)]


def test_a_record_comes_back_as_it_was_written(tmp_path):
    file = record.write(tmp_path / "new", "stefan_tube", CHECKS, "embedded")
    assert file == tmp_path / "new" / "stefan_tube.json"
    found = record.read(tmp_path / "new", "stefan_tube")
    assert (found["scene"], found["version"], found["gas"]) == ("stefan_tube", __version__, "embedded")
    assert len(found["date"].split("-")) == 3 and found["checks"][0] == CHECKS[0]
    assert found["checks"][1]["value"] is None and not found["checks"][1]["ok"]  # JSON knows no nan
    assert record.read(tmp_path, "poiseuille") is None


def test_the_commit_tells_of_programs_that_differ_from_it(tmp_path, monkeypatch):
    package = tmp_path / "sdph"
    package.mkdir()
    monkeypatch.setattr(paths, "PACKAGE", package)
    assert record.commit() is None
    (package / "a.py").write_text("a = 1\n")
    for words in ("init -q", "add .", "-c user.name=a -c user.email=a@b.c commit -qm first"):
        subprocess.run(["git", "-C", tmp_path, *words.split()], check=True)
    (tmp_path / "record.json").write_text("{}")
    clean = record.commit()
    assert len(clean) >= 7 and not clean.endswith("+")
    (package / "a.py").write_text("a = 2\n")
    assert record.commit() == clean + "+"


def test_validate_records_a_scene(tmp_path, monkeypatch, capsys):
    """Of all scenes, each by a command of its own: tests/study/test_apart.py."""
    monkeypatch.setattr(validate, "validate", lambda scene, *rest: CHECKS[:1])
    assert cli.main(["validate", "one", "--gas", "embedded", "--record", str(tmp_path)]) == cli.CHECK_FAILED
    found = json.loads((tmp_path / "one.json").read_text())
    assert found["gas"] == "embedded" and found["checks"] == CHECKS[:1]
    assert "FAILED" in capsys.readouterr().out


def test_no_record_of_a_scene_that_was_changed(tmp_path, capsys):
    words = ["validate", "stefan_tube", "--set", "run.end_time_s=1", "--record", str(tmp_path / "new")]
    assert cli.main(words) == cli.BAD_INPUT
    assert "a record is of the scene as it is" in capsys.readouterr().err and not (tmp_path / "new").exists()


def row(name: str, part: str, value: float = 1.0) -> dict:
    return compare.check(name, value, 1.0, 0.1) | {"part": part}


OLD = [row("a", "packed_bed"), row("b", "water_drops"), row("c", "bed_profiles")]


def stamped(monkeypatch, commit: str) -> None:
    monkeypatch.setattr(record, "commit", lambda: commit)


def recorded(folder, monkeypatch, scene: str, checks: list[dict], commit: str) -> dict:
    """The record of experiments after `validate SCENE --record`, whose runs give `checks`."""
    stamped(monkeypatch, commit)
    monkeypatch.setattr(validate, "validate", lambda *given: list(checks))
    assert cli.main(["validate", scene, "--record", str(folder)]) == cli.FINE
    return record.read(folder, "experiments")


def test_a_part_of_a_study_replaces_its_own_checks_alone(tmp_path, monkeypatch):
    stamped(monkeypatch, "old")
    record.write(tmp_path, "experiments", OLD, None)
    new = [row("b", "water_drops", 1.05), row("d", "water_drops")]
    found = recorded(tmp_path, monkeypatch, "experiments.water_drops", new, "new")
    assert found["checks"] == [OLD[0], *new, OLD[2]] and found["commit"] == "old"
    assert list(found["parts"]) == ["water_drops"] and found["parts"]["water_drops"]["commit"] == "new"
    assert found["parts"]["water_drops"]["date"] == found["date"]
    again = recorded(tmp_path, monkeypatch, "experiments.water_drops", [*new, row("e", "water_drops")], "old")
    assert "parts" not in again and len(again["checks"]) == 5  # of the whole's date and commit


def test_a_part_that_is_run_by_name_alone_stays_in_the_record_of_the_whole(tmp_path, monkeypatch):
    """Neither lost nor told to have vanished; a check of another part that is gone is."""
    stamped(monkeypatch, "old")
    record.write(tmp_path, "experiments", OLD, None)
    drop = row("spread", "drop_spread")
    assert recorded(tmp_path, monkeypatch, "experiments.drop_spread", [drop], "long")["checks"] == [*OLD, drop]
    found = recorded(tmp_path, monkeypatch, "experiments", OLD, "new")
    assert found["checks"] == [*OLD, drop] and found["commit"] == "new"
    assert {name: own["commit"] for name, own in found["parts"].items()} == {"drop_spread": "long"}
    assert [check["name"] for check in validate.vanished("experiments", OLD[1:], tmp_path)] == ["a"]
    assert [check["name"] for check in validate.vanished("experiments.drop_spread", [], tmp_path)] == ["spread"]


@pytest.mark.parametrize("old", [None, [compare.check("a", 1.0, 1.0, 0.1)]])
def test_no_part_is_put_into_a_record_that_names_no_parts(tmp_path, monkeypatch, capsys, old):
    """Nor where there is no record; said before the part is run."""
    monkeypatch.setattr(paths, "data", lambda name: tmp_path / "none")
    monkeypatch.setattr(validate, "validate", lambda *given: pytest.fail("the part is run"))
    if old:
        record.write(tmp_path, "experiments", old, None)
    before = record.read(tmp_path, "experiments")
    assert cli.main(["validate", "experiments.water_drops", "--record", str(tmp_path)]) == cli.BAD_INPUT
    (line,) = capsys.readouterr().err.splitlines()
    assert "no part can be put in" in line and f"sdph validate experiments --record {tmp_path}" in line
    assert record.read(tmp_path, "experiments") == before


def test_json_of_a_part_has_what_that_of_a_scene_has(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(validate, "validate", lambda *given: [OLD[0]])
    monkeypatch.setattr(validate, "vanished", lambda *given: [])
    assert cli.main(["validate", "experiments.packed_bed", "--json"]) == cli.FINE
    (found,) = json.loads(capsys.readouterr().out)["checks"]
    assert list(found) == ["name", "value", "reference", "tolerance", "ok"]


@pytest.mark.parametrize(
    "path", sorted((paths.data("validation") / "record").glob("*.json")), ids=lambda path: path.stem
)
def test_records_are_of_scenes_that_there_are(path):
    found = record.read(path.parent, path.stem)
    assert found["scene"] == path.stem in validate.validated()
    assert found["checks"] and {"date", "version", "commit", "gas"} <= found.keys()
    if path.stem in validate.STUDIES:
        assert {check["part"] for check in found["checks"]} <= set(validate.parts(path.stem))
        assert set(found.get("parts", ())) <= {check["part"] for check in found["checks"]}
