"""Ladders of cases of one's own: `cost.toml` beside their `case.toml`."""

import json
import re

import pytest

from sdph import cli
from sdph.schema import CaseError
from sdph.study.cost import choice, climb, ladder, measured_case

LADDER = """
metrics = ["heat_exchanged_J"]

[knobs]
"resolution.spacing_mm" = [20.0, 14.0, 10.0]
"resolution.cell_mm" = [40.0, 28.0, 20.0]
"""


@pytest.fixture
def mine(tmp_path):
    """A disc of one's own, short."""
    assert cli.main(["init", "disc_cluster", str(tmp_path / "mine")]) == 0
    case = tmp_path / "mine" / "case.toml"
    text = case.read_text().replace("end_time_s = 0.1", "end_time_s = 0.002").replace("report_at_s", "# report_at_s")
    case.write_text(text.replace("output_interval_s = 0.02", "output_interval_s = 0.001"))
    return tmp_path / "mine"


def test_a_case_of_ones_own_is_priced_by_its_own_ladder(mine, tmp_path, capsys):
    """By its folder and by its file, from where it left off; nothing goes into the folder of the case."""
    (mine / "cost.toml").write_text(LADDER)
    before = sorted(path.name for path in mine.iterdir())
    out = ["--out", str(tmp_path / "cost")]
    assert cli.main(["cost", str(mine), *out, "--budget", "1000"]) == 0
    told = capsys.readouterr().out
    assert "Richardson's limit of the ladder" in told and "all 3/3" in told
    rows = (tmp_path / "cost" / "cost.csv").read_text()
    assert rows.count("all ") == 3 and "heat_exchanged_J" in rows
    assert cli.main(["cost", str(mine / "case.toml"), *out]) == 0
    assert "measured before" in capsys.readouterr().out
    assert (tmp_path / "cost" / "cost.csv").read_text() == rows
    assert (tmp_path / "cost" / "cost.png").is_file() and sorted(path.name for path in mine.iterdir()) == before


@pytest.fixture
def priced(mine, tmp_path, monkeypatch):
    """The disc with its ladder, and rows of that case in runs/cost."""
    monkeypatch.chdir(tmp_path)
    (mine / "cost.toml").write_text(LADDER)
    own = ladder.declared(str(mine))
    file = tmp_path / "runs/cost/mine/cost.csv"
    measured_case.keep(str(mine), own, file)
    for n, step in enumerate(own.steps):
        told = {"metrics": json.dumps({"heat_exchanged_J": (1.0 + 0.001 * step, None, None)}), "wall_s": 1.0 / step}
        climb._keep(file, {"label": f"all {n + 1}/3", "solver": "sdph", **own.level(n), **told, **climb._machine(1)})
    return mine


def test_an_accuracy_is_that_of_the_ladder_of_this_very_case(priced, capsys):
    """What the ladder sets may be another in the case; all else may not, nor what its files hold."""
    case, run = priced / "case.toml", ["run", str(priced), "--accuracy", "heat_exchanged_J=2.5%", "--json"]
    text = case.read_text()
    assert cli.main([*run, "--out", "first"]) == 0
    assert "resolution.spacing_mm=14.0" in capsys.readouterr().err
    case.write_text(re.sub(r"spacing_mm = [0-9.]+", "spacing_mm = 13.0", text))
    assert cli.main([*run, "--out", "second"]) == 0
    capsys.readouterr()
    case.write_text(text.replace("end_time_s = 0.002", "end_time_s = 0.003"))
    for command in (run, ["cost", str(priced)]):
        assert cli.main(command) == 2
        told = capsys.readouterr().err
        assert "was measured of another case: run.end_time_s differs" in told and told.count("\n") == 1
    (priced.parent / "runs/cost/mine/case.json").unlink()
    assert cli.main(run) == 2
    assert "does not say which case it was measured of" in capsys.readouterr().err


def test_rows_of_a_case_of_ones_own_are_not_taken_for_a_scene_called_so(priced, tmp_path):
    rows = tmp_path / "runs/cost/mine"
    rows.rename(tmp_path / "runs/cost/disc_cluster")
    file, _ = choice.measured("disc_cluster")
    assert file.parts[-3:-1] == ("validation", "disc_cluster")
    with pytest.raises(CaseError, match="of a case of your own; give another folder"):
        measured_case.keep("disc_cluster", ladder.declared("disc_cluster"), rows.parent / "disc_cluster" / "cost.csv")


def test_without_a_ladder_it_is_said_how_to_give_one(mine, capsys):
    assert cli.main(["cost", str(mine)]) == 2
    told = capsys.readouterr().err
    assert told.count("\n") == 1 and f"give {mine / 'cost.toml'} with [knobs]" in told and "bubbling_bed" in told


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("knobs = 3", r"\[knobs\] must hold lists of one length, of 3 values or more"),
        ("metrics = []\n[knobs]\n'resolution.spacing_mm' = [3.0, 2.0, 1.0]", "metrics must be a list of keys"),
        ("metrics = ['a']\n[knobs]\n'resolution.spacing_mm' = [2.0, 1.0]", "of 3 values or more"),
        (
            "metrics = ['a']\n[knobs]\n'resolution.spacing' = [3.0, 2.0, 1.0]",
            "no key resolution.spacing; did you mean resolution.spacing_mm",
        ),
        ("metric = ['a']\n[knobs]\n'resolution.spacing_mm' = [3.0, 2.0, 1.0]", "did you mean metrics"),
        ("metrics = [", "cost.toml: "),
    ],
)
def test_a_ladder_that_cannot_be_is_one_line(mine, text, says):
    (mine / "cost.toml").write_text(text)
    with pytest.raises(CaseError, match=says) as refused:
        ladder.declared(str(mine))
    assert "\n" not in str(refused.value)
