"""`sdph validate` and `sdph stress` by processes of their own: all are judged whatever one of them does."""

import json

import pytest

from sdph import cli
from sdph.study import apart, record, validate

SMALL = ("liquid_one_particle", "no_particles")


def told(capsys) -> tuple[list[dict], list[str]]:
    """Checks that were printed, and the lines beside them."""
    out, err = capsys.readouterr()
    return json.loads(out)["checks"], err.splitlines()


def test_hard_cases_by_workers_are_those_of_one_process(capsys):
    pytest.importorskip("distributed", reason="dask is not installed: pip install 'sdph[sweep]'")
    codes, found = [], []
    for more in ((), ("--workers", "2")):
        codes.append(cli.main(["stress", *SMALL, *more, "--json"]))
        checks, lines = told(capsys)
        found.append({check["name"]: check["ok"] for check in checks})
    assert codes == [0, 0] and found[0] == found[1] and len(found[0]) > 10
    assert sorted(line.split()[0] for line in lines if "checks hold" in line) == ["1/2", "2/2"]


def test_one_that_cannot_be_judged_ends_no_other(tmp_path, monkeypatch, capsys):
    """All scenes in turn, here three of which one is none: its reason is told, its exit code counts, the rest is kept
    on record."""
    monkeypatch.setattr(validate, "validated", lambda: ["stefan_tube", "nothing", "gel_droplet_reduced"])
    assert cli.main(["validate", "--gas", "embedded", "--record", str(tmp_path / "kept"), "--json"]) == 2
    checks, lines = told(capsys)
    assert any("nothing: nothing has no validation" in line for line in lines)
    for scene in ("stefan_tube", "gel_droplet_reduced"):
        own = record.read(tmp_path / "kept", scene)
        kept = [{key: value for key, value in check.items() if key != "part"} for check in own["checks"]]
        assert kept and all(check in checks for check in kept)


def test_a_check_that_fails_is_one_and_what_ended_is_more(monkeypatch, capsys):
    """Exit code 1 where all came to a judgement; 128 and more where a signal ended one."""
    monkeypatch.setattr(validate, "validated", lambda: ["a", "b"])
    bad = {"name": "x", "value": 2.0, "reference": 1.0, "tolerance": 0.5, "ok": False}
    for code, expected in ((1, 1), (137, 137)):
        last = {"exit_code": code, "reason": "", "checks": [bad], "took_s": 1.0}
        monkeypatch.setattr(
            apart, "checked", lambda job, last=last: last if job.name == "b" else last | {"exit_code": 0}
        )
        assert cli.main(["validate", "--json"]) == expected
        assert told(capsys)[0] == [bad, bad]


def test_one_scene_is_one_job(capsys):
    assert cli.main(["validate", "stefan_tube", "--workers", "2"]) == 2
    assert "part the scenes among them" in capsys.readouterr().err
