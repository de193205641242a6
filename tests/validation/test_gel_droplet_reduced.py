"""Short form of `sdph validate gel_droplet_reduced`: all but most of the changes."""

import pytest

from sdph.study import validate


def study(name):
    return validate.part("gel_droplet_reduced", name)


@pytest.mark.parametrize("name", ["course", "rings", "claims"])
def test_every_check_passes(name, tmp_path):
    checks = study(name).checks(tmp_path)
    assert [check["name"] for check in checks if not check["ok"]] == []
    assert len(checks) >= 6


def test_changes_in_short(tmp_path, monkeypatch):
    changes = study("changes")
    monkeypatch.setattr(changes, "CHANGES", {name: changes.CHANGES[name] for name in ("C 0", "sphere")})
    monkeypatch.setattr(changes, "FLAWS", {0.1: changes.FLAWS[0.1]})
    assert [check["name"] for check in changes.checks(tmp_path) if not check["ok"]] == []
    assert (tmp_path / "changes.png").is_file()


def test_a_shell_twice_as_strong_is_seen(tmp_path, monkeypatch):
    course = study("course")
    monkeypatch.setattr(course.runs, "EVEN", "shell.yield_stress_Pa=9.8e5")
    assert not all(check["ok"] for check in course.checks(tmp_path))
