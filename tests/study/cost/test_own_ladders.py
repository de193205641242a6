"""Ladders of cases of one's own: `cost.toml` beside their `case.toml`."""

import pytest

from sdph import cli
from sdph.schema import CaseError
from sdph.study.cost import ladder

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
