"""Numbers that READMEs and the page of what is measured tell are those of validation/record."""

import re

import pytest
from scripts import FOLDER, script

from sdph.study import record, validate

RECORDS = sorted(path.stem for path in (FOLDER / "record").glob("*.json"))
MADE = {"scene": "one", "date": "2026-11-28", "version": "0.1.0", "commit": "abc", "gas": "embedded"}
CHECKS = [
    {"name": "one, balances: mass", "value": 0.0, "reference": 0.0, "tolerance": 1e-10, "ok": True},
    {"name": "one, balances: loss", "value": 0.3, "reference": 0.0, "tolerance": 0.02, "ok": False},
    {"name": "one, exact: width [m]", "value": 0.012164, "reference": 0.01, "tolerance": 1e-3, "ok": False},
    {"name": "one, exact: sum m |v|", "value": 1.25e-11, "reference": 1.0, "tolerance": None, "ok": True},
]


@pytest.fixture(scope="module")
def recorded():
    return script("recorded")


@pytest.fixture
def of_one(recorded, monkeypatch):
    monkeypatch.setattr(recorded, "own", lambda scene: {"one": MADE | {"checks": CHECKS}}[scene])
    return recorded


def test_pages_tell_what_is_recorded(recorded):
    """Else: python validation/recorded.py"""
    for file, text in recorded.pages().items():
        assert file.read_text(encoding="utf-8") == text, file


def test_no_mark_is_overlooked(recorded):
    """One that stands apart from its number, or that has no end, would leave what is there as it is."""
    marks = recorded.TABLE, recorded.NUMBER, recorded.LIMITERS
    for file, text in recorded.pages().items():
        seen = {match["mark"].strip() for own in marks for match in own.finditer(text)}
        assert set(re.findall(r"<!-- \w+: .*?-->", text)) - seen == set(), file


@pytest.mark.parametrize("scene", validate.validated())
def test_every_readme_of_a_validation_has_a_table(scene):
    """`<!-- recorded: SCENE -->` or `<!-- recorded: SCENE, misses -->`, so that no miss to come can hide."""
    page = FOLDER / scene / "README.md"
    assert not page.is_file() or f"<!-- recorded: {scene}" in page.read_text(encoding="utf-8")


@pytest.mark.parametrize("scene", RECORDS)
def test_every_readme_of_a_record_has_its_limiters(scene):
    """What `test_pages_tell_what_is_recorded` then holds to be that of the record."""
    assert f"<!-- limiters: {scene} -->\n" in (FOLDER / scene / "README.md").read_text(encoding="utf-8")


def test_limiters_are_told_by_run_with_their_reason(of_one, monkeypatch):
    runs = {"one": {"a_share": 0.123, "b_Pa": 25536.0}, "calm, cold": {}, "other": {"a_share": 1.0}}
    monkeypatch.setattr(of_one, "own", lambda scene: MADE | {"checks": CHECKS, "limiters": runs})
    monkeypatch.setattr(of_one, "reasons", lambda: {"a_share": "it is so", "b_Pa": "it pulls"})
    made = of_one.filled(f"<!-- limiters: one -->\nold\n{of_one.END}\nafter\n")
    assert made.endswith(f"\n{of_one.END}\nafter\n") and "\nold\n" not in made and of_one.filled(made) == made
    assert "acted in calm, cold (2026-11-28)." in made
    assert "| | one | other | why |\n|--|--|--|--|\n| `a_share` | 0.12 | 1 | it is so |" in made
    assert "\n| `b_Pa` | 25536 |  | it pulls |\n<!--" in made


@pytest.mark.parametrize(
    ("limiters", "told"), [({}, "is not recorded: the record is older"), ({"limiters": {}}, "it makes runs of its own"),
                           ({"limiters": {"one": {}}}, "None of the [limiters]")],
)  # fmt: skip
def test_a_record_without_limiters_says_so(limiters, told, of_one, monkeypatch):
    monkeypatch.setattr(of_one, "own", lambda scene: MADE | {"checks": CHECKS} | limiters)
    made = of_one.filled(f"<!-- limiters: one -->\n{of_one.END}\n")
    assert told in made and "(2026-11-28)" in made and "|" not in made


@pytest.mark.parametrize("scene", RECORDS)
def test_every_miss_stands_in_the_readme_of_its_scene(scene, recorded):
    """A table of all checks, or `<!-- recorded: SCENE, misses -->`."""
    page = FOLDER / scene / "README.md"
    text = page.read_text(encoding="utf-8") if page.is_file() else ""
    missed = [check for check in record.read(FOLDER / "record", scene)["checks"] if not check["ok"]]
    assert [check["name"] for check in missed if recorded.row(check, scene) not in text] == []


def test_a_table_has_misses_and_no_balance_that_holds(of_one):
    text = f"before\n<!-- recorded: one -->\nold\n{of_one.END}\nafter\n"
    made = of_one.filled(text)
    assert made.startswith("before\n<!-- recorded: one -->\n") and made.endswith(f"\n{of_one.END}\nafter\n")
    assert "Recorded 2026-11-28 (commit abc, gas embedded): 4 checks, 2 missed; " in made
    assert (
        "| balances: loss | 0.3 | 0 | 0.02 | **missed** |\n| width [m] | 0.012164 | 0.01 | 0.001 | **missed** |" in made
    )
    assert "| sum m \\|v\\| | 1.25e-11 | 1 |  |  |" in made and "balances: mass" not in made and "\nold\n" not in made
    assert of_one.filled(made) == made


def test_the_head_of_a_table_names_parts_that_were_recorded_by_themselves(recorded):
    later = {"date": "2026-12-01", "commit": "def"}
    parts = {"lines": later, "drops": later, "films": later | {"commit": "fed"}}
    head = recorded.table(MADE | {"parts": parts, "checks": CHECKS}, True).splitlines()[0]
    assert head.startswith(
        "Recorded 2026-11-28 (commit abc, gas embedded; lines, drops 2026-12-01, def; films 2026-12-01, fed): 4 checks"
    )


def test_large_numbers_of_a_table_stand_as_they_are(recorded):
    check = {"name": "p [Pa]", "value": 151_234.5678, "reference": 1.5e5, "tolerance": 7512.3, "ok": True}
    assert recorded.row(check, "one") == "| p [Pa] | 151235 | 150000 | 7512 |  |"


def test_a_table_without_an_end_takes_nothing_of_what_follows(of_one):
    text = f"<!-- recorded: one -->\nwords\n<!-- recorded: one, misses -->\n{of_one.END}\n"
    assert of_one.filled(text).startswith("<!-- recorded: one -->\nwords\n<!-- recorded: one, misses -->\nRecorded")


def test_a_table_of_misses_has_no_others(of_one):
    made = of_one.filled(f"<!-- recorded: one, misses -->\n{of_one.END}\n")
    assert made.count("**missed**") == 2 and "sum m" not in made


@pytest.mark.parametrize(
    ("told", "where", "right"),
    [("9.9", "width [m]; value x 1000", "12.2"), ("10.0", "exact: width [m]; reference x 1000", "10.0"),
     ("+43", "width [m]; off", "+22"), ("-62.1", "width [m]; off", "+21.6"), ("0.00", "width [m]; bar", "0.00"),
     ("0.001", "width [m]; difference", "0.002"),
     ("1.00", "width [m]; ratio", "1.22"), ("3e-12", "|v|", "1e-11"), ("9.99e-9", "|v|", "1.25e-11"),
     ("7", "held", "1"), ("7", "judged", "3"), ("7", "reported", "1"),
     ("held", "width [m]", "**missed**"), ("**missed**", "mass", "held"), ("held", "mass", "held")],
)  # fmt: skip
def test_a_number_is_that_of_its_check_to_the_digits_told(told, where, right, of_one):
    assert of_one.filled(f"is {told}<!-- one: {where} --> g") == f"is {right}<!-- one: {where} --> g"


@pytest.mark.parametrize(("where", "count"), [("height [m]", 0), ("s", 2)])
def test_a_number_of_no_check_or_of_two_is_refused(where, count, of_one):
    with pytest.raises(ValueError, match=f"one: {count} checks end with"):
        of_one.filled(f"1<!-- one: {where} -->")


def test_a_page_with_a_mark_of_no_check_is_told_and_the_others_are_written(of_one, monkeypatch, tmp_path):
    texts = {"a.md": "1<!-- one: depth -->", "b.md": "1.0<!-- one: width [m] -->", "c.md": "2<!-- one: height -->"}
    for name, text in texts.items():
        (tmp_path / name).write_text(text)
    monkeypatch.setattr(of_one, "files", lambda: [tmp_path / name for name in texts])
    with pytest.raises(SystemExit) as ended:
        of_one.main()
    told = str(ended.value).splitlines()
    assert ["a.md: one: 0 checks" in told[0], "c.md: one: 0 checks" in told[1], len(told)] == [True, True, 2]
    written = {name: (tmp_path / name).read_text() for name in texts}
    assert written == texts | {"b.md": "0.0<!-- one: width [m] -->"}


def test_without_a_record_there_is_no_number(recorded):
    with pytest.raises(ValueError, match="nowhere: 0 checks end with 'width'"):
        recorded.filled("1<!-- nowhere: width -->")
    made = recorded.filled(f"<!-- recorded: nowhere, misses -->\n{recorded.END}")
    assert "Not recorded: `sdph validate nowhere --record" in made and "check |" not in made


def test_a_table_without_misses_is_one_line(of_one, monkeypatch):
    monkeypatch.setattr(of_one, "own", lambda scene: MADE | {"checks": CHECKS[:1]})
    assert "1 checks, 0 missed" in of_one.filled(f"<!-- recorded: one, misses -->\n{of_one.END}")
    assert "check |" not in of_one.filled(f"<!-- recorded: one, misses -->\n{of_one.END}")
