"""Run folders that were damaged, or hold what is not theirs: every command that reads one says so in one line."""

import json
import random
import shutil

import pytest
from test_restart import Reporter, load

from sdph import cli
from sdph.running import driver

READERS = {
    "report": ("report", "run", "--out", "report.html"),
    "view": ("view", "run", "--png", "run.png"),
    "movie": ("view", "run", "--movie", "run.gif"),
    "compare": ("compare", "run", "--against", "exact"),
}
PVD = '<VTKFile type="Collection"><Collection>{}</Collection></VTKFile>'
ENTRY = '<DataSet timestep="{}" part="{}" file="{}"/>'
JUNK = random.Random(1).randbytes(4000)


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    folder = tmp_path_factory.mktemp("whole") / "run"
    more = (
        "run.end_time_s=0.002",
        "run.output_interval_s=0.001",
        "run.report_at_s=[0.001]",
    )  # long enough to be compared
    driver.run(
        load("disc_cluster", "embedded", "heat.closure='paper'", *more), "disc_cluster", folder, None, Reporter()
    )
    return folder


@pytest.fixture
def read(whole, tmp_path, monkeypatch, capfd):
    """Damages a copy of the run and reads it by a command: (exit code, what it said on stderr)."""
    monkeypatch.chdir(tmp_path)
    shutil.copytree(whole, tmp_path / "run")

    def call(command, name=None, content=None):
        if name:
            file = tmp_path / "run" / name
            before = file.read_bytes() if file.is_file() else b""
            after = content(before) if callable(content) else content
            file.write_bytes(after if isinstance(after, bytes) else after.encode())
        capfd.readouterr()
        code = cli.main(list(READERS[command]))
        return code, capfd.readouterr().err

    return call


@pytest.mark.parametrize("command", READERS)
def test_the_whole_run_is_read(read, command):
    """So coarse that a comparison is outside tolerance, and so short that some of its times are missing."""
    code, said = read(command)
    if command == "compare":
        assert (
            code == 1 and said.endswith("ends at 0.002 s: no check at 0.005, 0.02, 0.1 s\n") and said.count("\n") == 1
        )
    else:
        assert (code, said) == (0, "")


def rows(change):
    """Changes the list of lines of a table."""
    return lambda data: "\r\n".join(change(data.decode().splitlines())) + "\r\n"


TABLES = {
    "empty": b"",
    "junk": JUNK,
    "another table": "a,b\n1,2\n",
    "head alone": rows(lambda lines: lines[:1]),
    "short row": rows(lambda lines: [*lines[:2], "0.1", *lines[2:]]),
    "long row": rows(lambda lines: [*lines[:2], lines[2] + ",1"]),
    "text for a number": rows(lambda lines: [*lines[:2], lines[2].replace(",", ",abc", 1)]),
    "times that fall": rows(lambda lines: [lines[0], *reversed(lines[1:])]),
    "nul": lambda data: data.replace(b".", b"\0"),
    "utf-16": lambda data: data.decode().encode("utf-16"),
}


@pytest.mark.parametrize("harm", TABLES)
def test_a_damaged_history_is_told_by_compare(read, harm):
    code, said = read("compare", "history.csv", TABLES[harm])
    assert (code, said.count("\n")) == (2, 1) and "history.csv" in said and "run it again" in said


@pytest.mark.parametrize("harm", [name for name in TABLES if name not in ("empty", "head alone", "times that fall")])
def test_a_damaged_history_is_told_by_report(read, harm):
    """What a run has only begun to write is no damage, and times that fall can be drawn."""
    code, said = read("report", "history.csv", TABLES[harm])
    assert (code, said.count("\n")) == (2, 1) and "history.csv" in said and "run it again" in said


@pytest.mark.parametrize("name", ["ledger", "metrics"])
@pytest.mark.parametrize("harm", TABLES)
def test_other_damaged_tables_are_told_when_they_are_read(whole, tmp_path, name, harm):
    from sdph.schema import CaseError
    from sdph.study import compare

    shutil.copytree(whole, tmp_path / "run")
    file, content = tmp_path / "run" / f"{name}.csv", TABLES[harm]
    if name == "metrics":  # the disc has no column but its times
        file.write_text("time_s,a\r\n0.0,1.0\r\n0.1,2.0\r\n0.2,3.0\r\n")
    after = content(file.read_bytes()) if callable(content) else content
    file.write_bytes(after if isinstance(after, bytes) else after.encode())
    with pytest.raises(CaseError, match=f"{name}.csv.* run it again"):
        getattr(compare.open_run(tmp_path / "run"), name)


@pytest.mark.parametrize("command", ["report", "compare"])
def test_a_table_of_gigabytes_is_refused_before_it_is_read(read, tmp_path, command):
    with open(tmp_path / "run" / "history.csv", "r+b") as file:
        file.truncate(3 * 2**30)
    code, said = read(command)
    assert (code, said.count("\n")) == (2, 1) and "history.csv is too long a table" in said
    assert "it has 3221225472 bytes; at most 33554432 are allowed" in said and "longer windows" in said


@pytest.mark.parametrize("name", ["ledger", "metrics"])
def test_other_tables_of_gigabytes_are_refused_before_they_are_read(whole, tmp_path, name):
    from sdph.schema import CaseError
    from sdph.study import compare

    shutil.copytree(whole, tmp_path / "run")
    with open(tmp_path / "run" / f"{name}.csv", "r+b") as file:
        file.truncate(3 * 2**30)
    with pytest.raises(CaseError, match=f"{name}.csv is too long a table"):
        getattr(compare.open_run(tmp_path / "run"), name)


def test_a_row_that_is_still_being_written_is_not_there_yet(read):
    assert read("report", "history.csv", lambda data: data + b"0.1,29")[0] == 0


def test_a_run_whose_first_rows_are_still_to_come_is_reported(read):
    assert read("report", "history.csv", b"")[0] == 0


TIMELINES = {
    "empty": "",
    "junk": JUNK,
    "html": "<html><body>no</body></html>",
    "no entries": PVD.format(""),
    "no time": PVD.format('<DataSet part="0" file="fields/particles_00000.vtp"/>'),
    "time that is none": PVD.format(ENTRY.format("soon", 0, "fields/particles_00000.vtp")),
    "nan": PVD.format(ENTRY.format("nan", 0, "fields/particles_00000.vtp")),
    "no file": PVD.format('<DataSet timestep="0" part="0"/>'),
    "part that is none": PVD.format(ENTRY.format("0", "x", "fields/particles_00000.vtp")),
    "gas alone": PVD.format(ENTRY.format("0", 1, "fields/gas_00000.vtr")),
    "a picture": PVD.format(ENTRY.format("0", 0, "mine.png")),
    "the case": PVD.format(ENTRY.format("0", 0, "case.toml")),
    "outside": PVD.format(ENTRY.format("0", 0, "../../etc/passwd.vtp")),
    "absolute": PVD.format(ENTRY.format("0", 0, "/etc/passwd.vtp")),
    "not there": PVD.format(ENTRY.format("0", 0, "fields/gone.vtp")),
    "a folder": PVD.format(ENTRY.format("0", 0, "fields/folder.vtp")),
    "gas for particles": PVD.format(ENTRY.format("0", 0, "fields/gas_00000.vtr")),
    "particles for gas": PVD.format(
        ENTRY.format("0", 0, "fields/particles_00000.vtp") + ENTRY.format("0", 1, "fields/particles_00000.vtp")
    ),
}


@pytest.mark.parametrize("command", ["report", "view", "movie"])
@pytest.mark.parametrize("harm", TIMELINES)
def test_a_damaged_timeline_is_told(read, tmp_path, command, harm):
    (tmp_path / "run" / "fields" / "folder.vtp").mkdir()
    code, said = read(command, "run.pvd", TIMELINES[harm])
    assert (code, said.count("\n")) == (2, 1) and "run it again" in said and "run/" in said


FIELDS = {
    "empty": b"",
    "cut": lambda data: data[: len(data) // 2],
    "cut, with its end": lambda data: data[: len(data) // 2] + b"</VTKFile>",
    "junk": JUNK + b"</VTKFile>",
    "of another kind": lambda data: data.replace(b"PolyData", b"ImageData").replace(b"RectilinearGrid", b"ImageData"),
    "an array gone": lambda data: data.replace(b'Name="density"', b'Name="destiny"'),
    "more than memory": lambda data: data.replace(b'NumberOfPoints="', b'NumberOfPoints="99999999').replace(
        b'xtent="0 ', b'xtent="0 9999999'
    ),
    "blocks of no size": lambda data: data.replace(b"AQAAAACAAA", b"AQAAAAAAAA"),
}


@pytest.mark.parametrize("command", ["report", "view"])
@pytest.mark.parametrize("name", ["particles_00002.vtp", "gas_00002.vtr"])
@pytest.mark.parametrize("harm", FIELDS)
def test_damaged_fields_are_told(read, command, name, harm):
    code, said = read(command, f"fields/{name}", FIELDS[harm])
    assert (code, said.count("\n")) == (2, 1) and f"{name} is damaged or missing" in said


def without(key):
    def change(data):
        table = json.loads(data)
        del table[key]
        return json.dumps(table)

    return change


NOTES = {
    "empty": b"",
    "junk": JUNK,
    "a list": "[1, 2]",
    "deep": "[" * 100_000,
    "a text for a number": '{"time_s": "long", "title": "t"}',
    "no time": without("time_s"),
    "a list for a number": '{"time_s": [1.0]}',
    "a number too long": '{"time_s": 1' + "0" * 400 + "}",
}


@pytest.mark.parametrize("command", ["report", "compare"])
@pytest.mark.parametrize("harm", NOTES)
def test_a_damaged_summary_is_told(read, command, harm):
    code, said = read(command, "summary.json", NOTES[harm])
    assert (code, said.count("\n")) == (2, 1) and "summary.json" in said


@pytest.mark.parametrize("harm", ["empty", "junk", "a list", "deep", "no such keys"])
@pytest.mark.parametrize("name", ["failure.json", "origin.json", "compare_exact.json"])
def test_other_damaged_notes_are_told(read, name, harm):
    code, said = read("report", name, NOTES.get(harm, '{"command": 5}'))
    assert (code, said.count("\n")) == (2, 1) and name in said


@pytest.mark.parametrize("command", READERS)
@pytest.mark.parametrize("content", [b"", JUNK, b"dimensions = 2\n", b"domain = 5\n", b"[domain]\nsize_m = 1\n"])
def test_a_damaged_case_is_told(read, command, content):
    code, said = read(command, "case.toml", content)
    assert (code, said.count("\n")) == (2, 1)


def test_a_case_that_was_changed_too_far_to_be_compared_is_told(read):
    code, said = read("compare", "case.toml", lambda data: data.replace(b"particles.disc", b"particles.other"))
    assert (code, said.count("\n")) == (2, 1) and "disc" in said


def test_a_history_without_the_column_that_is_compared_is_told(read):
    code, said = read(
        "compare", "history.csv", lambda data: data.replace(b"centre_temperature_K", b"middle_temperature_K")
    )
    assert (code, said.count("\n")) == (2, 1) and "history.csv has no centre_temperature_K" in said


def test_the_curves_of_a_report_bear_the_name_of_their_run(whole, tmp_path):
    """One of two runs has no history: the curve is the other's."""
    from matplotlib import pyplot

    from sdph.study import report

    for name in ("without", "with"):
        shutil.copytree(whole, tmp_path / name)
    (tmp_path / "without" / "history.csv").unlink()
    names, legend = [], pyplot.Axes.legend
    pyplot.Axes.legend = lambda axes, **how: (names.extend(axes.get_legend_handles_labels()[1]), legend(axes, **how))
    try:
        report.write([tmp_path / "without", tmp_path / "with"], tmp_path / "report.html")
    finally:
        pyplot.Axes.legend = legend
    assert names and set(names) == {"with"}


@pytest.mark.parametrize("name", ["$\\frac{$ <b>&", "_$x$ b", "ä" * 60])
def test_a_run_folder_may_have_any_name(whole, tmp_path, monkeypatch, capfd, name):
    monkeypatch.chdir(tmp_path)
    shutil.copytree(whole, tmp_path / name)
    assert cli.main(["report", name]) == 0
    assert cli.main(["view", name, "--png", "a.png"]) == 0
    assert cli.main(["compare", name, "--against", "exact"]) == 1  # so coarse that it is outside tolerance
