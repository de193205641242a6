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


def test_no_record_of_a_part_of_a_study(tmp_path, capsys):
    words = ["validate", "experiments.bed_profiles", "--record", str(tmp_path / "new")]
    assert cli.main(words) == cli.BAD_INPUT
    assert "a record is of all of experiments" in capsys.readouterr().err and not (tmp_path / "new").exists()


@pytest.mark.parametrize(
    "path", sorted((paths.data("validation") / "record").glob("*.json")), ids=lambda path: path.stem
)
def test_records_are_of_scenes_that_there_are(path):
    found = record.read(path.parent, path.stem)
    assert found["scene"] == path.stem in validate.validated()
    assert found["checks"] and {"date", "version", "commit", "gas"} <= found.keys()
