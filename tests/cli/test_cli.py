"""The command line as a user meets it: exit codes, one line for what is wrong, nothing touched that was there
before."""

import json
import os
import subprocess
import sys

import pytest
from test_output import snapshot

from coupling.gas import Unfinished
from sdph import cli, scenes
from sdph.scenes import paths

ENVIRONMENT = os.environ | {"PYTHONPATH": str(paths.PACKAGE.parent)}
SMALL = (
    "--gas",
    "embedded",
    "--set",
    "resolution.spacing_mm=20",
    "--set",
    "resolution.cell_mm=50",
    "--set",
    "run.output_interval_s=0.001",
    "--until",
    "0.002",
)


def sdph(*arguments, cwd, code=0):
    """Run the command in a folder; its exit code must be `code`."""
    command = [sys.executable, "-m", "sdph.cli", *map(str, arguments)]
    done = subprocess.run(command, cwd=cwd, env=ENVIRONMENT, capture_output=True, text=True, timeout=240, check=False)
    assert done.returncode == code, f"exit {done.returncode}\n{done.stdout}\n{done.stderr}"
    return done


def test_python_runs_the_package_as_the_command(tmp_path):
    """`python -m sdph`, where no script is installed."""
    for words, code in ((["--version"], 0), (["run", "no_such_case"], 2)):
        found = [
            subprocess.run([sys.executable, "-m", name, *words], cwd=tmp_path, env=ENVIRONMENT, capture_output=True,
                           text=True, timeout=240, check=False)
            for name in ("sdph", "sdph.cli")
        ]  # fmt: skip
        assert [(own.returncode, own.stdout, own.stderr) for own in found[:1]] == [
            (code, found[1].stdout, found[1].stderr)
        ]


@pytest.fixture
def refused(tmp_path, monkeypatch, capsys):
    """Runs a command in this process; gives the one line that is left when it is refused and nothing is touched."""
    monkeypatch.chdir(tmp_path)

    def call(*arguments):
        before = snapshot(tmp_path)
        assert cli.main(list(arguments)) == 2
        said = capsys.readouterr()
        assert said.out == ""
        (line,) = [text for text in said.err.splitlines() if not text.startswith("compiling kernels")]
        assert line.startswith("sdph: ") and snapshot(tmp_path) == before
        return line

    return call


@pytest.mark.parametrize("arguments", [("--help",), ("run", "--help"), ("--version",), ("list",)])
def test_asking_is_quick(tmp_path, arguments):
    """Neither numba nor numpy's heavier friends are imported to print a few lines."""
    code = (
        "import sys; from sdph import cli\n"
        "try: cli.main(sys.argv[1:])\n"
        "except SystemExit as end: assert not end.code\n"
        "heavy = {'numba', 'scipy', 'pyvista', 'matplotlib'} & sys.modules.keys()\n"
        "assert not heavy, heavy"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, *arguments],
        cwd=tmp_path,
        env=ENVIRONMENT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout


def test_list_names_every_scene(tmp_path):
    lines = sdph("list", cwd=tmp_path).stdout.splitlines()
    assert [line.split()[0] for line in lines] == scenes.names()
    assert all(len(line.split()) > 2 for line in lines)


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (("run", "disc_clusster"), ("disc_clusster", "disc_cluster")),
        (
            ("run", "disc_cluster", "--set", "resolution.spaceing_mm=1"),
            ("resolution.spaceing_mm", "did you mean resolution.spacing_mm?"),
        ),
        (("run", "disc_cluster", "--set", "resolution.spacing_mm=-1"), ("resolution.spacing_mm", "-1", "above 0")),
        (("run", "disc_cluster", "--set", "resolution.spacing_mm=nan"), ("resolution.spacing_mm", "nan")),
        (
            ("run", "disc_cluster", "--set", "resolution.spacing_mm=500"),
            ("spacing_mm = 500", "larger than particles.disc"),
        ),
        (("run", "disc_cluster", "--set", "grains.density_kg_m3='heavy'"), ("grains.density_kg_m3", "heavy")),
        (("run", "disc_cluster", "--set", "grains"), ("--set grains", "section.key=value")),
        (("run", "disc_cluster", "--np", "0"), ("coupling.gas_ranks", "at least 1")),
        (("run", "disc_cluster", "--until", "nan"), ("run.end_time_s = nan", "finite", "above 0")),
        (("sweep", "disc_cluster", "--set", "resolution.spacing_mm=20,25", "--until", "inf"), ("finite", "above 0")),
        (("run", "disc_cluster", "--until", "-1"), ("run.end_time_s", "-1", "above 0")),
        (("compare", "nowhere", "--against", "exact"), ("nowhere", "run it first")),
        (("view", "nowhere", "--png", "a.png"), ("nowhere", "run.pvd")),
        (("init", "no_such_scene", "folder"), ("no_such_scene",)),
        (("stress", "--map", "--json"), ("--json", "--map")),
        (("validate", "taylor_gren"), ("taylor_gren has no validation", "did you mean taylor_green?")),
    ],
)
def test_bad_input_is_one_line_and_code_2(refused, arguments, told):
    line = refused(*arguments)
    for part in told:
        assert part in line


@pytest.mark.parametrize("text", ["title = [", "\N{SNOWMAN}", 'dimensions = 2\n"two\\nlines" = 1\n'])
def test_bad_case_file_is_one_line_and_code_2(refused, tmp_path, text):
    (tmp_path / "case.toml").write_text(text, encoding="utf-8")
    refused("run", "case.toml")
    refused("run", ".")


COMMANDS = {
    "run": ("run", "@", "--until", "1e-6", "--out", "new"),
    "run --resume": ("run", "--resume", "@"),
    "run --accuracy": ("run", "@", "--accuracy", "2%"),
    "init": ("init", "@", "new"),
    "explain": ("explain", "@"),
    "view --png": ("view", "@", "--png", "new.png"),
    "view --movie": ("view", "@", "--movie", "new.gif"),
    "report": ("report", "@", "--out", "new.html"),
    "compare": ("compare", "@", "--against", "exact"),
    "validate": ("validate", "@"),
    "cost": ("cost", "@", "--out", "new", "--budget", "1s"),
    "stress": ("stress", "@"),
}


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize(
    "target",
    [
        "nowhere",
        "empty",
        "empty.toml",
        "junk.toml",
        "junk",
        "pipe",
        "dangling",
        "of_junk",
        "of_folder",
        "case.toml/deep",
        "",
        "..",
        "x" * 3000,
    ],
)
def test_what_is_no_case_and_no_run_is_refused_by_every_command(refused, tmp_path, command, target):
    junk = bytes(range(256)) * 8
    for name, content in (
        ("empty.toml", b""),
        ("junk.toml", junk),
        ("junk", junk),
        ("case.toml", b"title = 'not whole'\n"),
    ):
        (tmp_path / name).write_bytes(content)
    for name in ("empty", "of_junk", "of_folder/case.toml"):
        (tmp_path / name).mkdir(parents=True)
    for name in ("case.toml", "summary.json", "history.csv", "run.pvd", "origin.json"):
        (tmp_path / "of_junk" / name).write_bytes(junk)
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "dangling").symlink_to("gone")
    refused(*(target if word == "@" else word for word in COMMANDS[command]))


def test_a_report_replaces_nothing_but_a_file(tmp_path, refused):
    """Not a folder, and not a device, which a user who may do all would lose."""
    sdph("run", "disc_cluster", *SMALL, "--out", "mine", cwd=tmp_path)
    (tmp_path / "folder").mkdir()
    os.mkfifo(tmp_path / "pipe")
    for target in ("folder", "pipe", "."):
        assert "no file that a report could be written to" in refused("report", "mine", "--out", target)
    assert (tmp_path / "pipe").is_fifo()


def test_a_reader_that_has_read_enough_is_no_error(tmp_path):
    code = "import sys; from sdph import cli; [cli.main(['list']) for _ in range(100)]"
    told = subprocess.Popen(
        [sys.executable, "-c", code], cwd=tmp_path, env=ENVIRONMENT, stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    told.stdout.readline()
    told.stdout.close()
    assert told.stderr.read() == b""
    assert told.wait() == 0
    told.stderr.close()


def test_process_ends_with_code_2_and_one_line(tmp_path):
    done = sdph("run", "disc_clusster", cwd=tmp_path, code=2)
    assert (done.stdout, done.stderr.count("\n")) == ("", 1)
    assert "disc_cluster" in done.stderr


@pytest.mark.parametrize(
    "arguments",
    [(), ("fly",), ("run",), ("run", "disc_cluster", "--np", "two"), ("compare", "x", "--against", "nothing")],
)
def test_wrong_usage_is_code_2_and_one_line(capsys, arguments):
    assert cli.main(list(arguments)) == 2
    said = capsys.readouterr().err
    assert said.startswith("sdph: ") and said.count("\n") == 1 and "--help" in said


@pytest.mark.parametrize("arguments", [
    ("run", "dam_break", "--gas", "embedded"),
    ("run", "disc_cluster", "--gas", "embedded", "--np", "2"),
    ("run", "--resume", "nowhere", "--out", "x"),
    ("run", "disc_cluster", "--accuracy", "2%", "--set", "resolution.cell_mm=20"),
    ("run", "disc_cluster", "--set", "particles.disc.volume_fraction=0.9"),
    ("run", "bubbling_bed", "--gas", "embedded", "--set", "resolution.cell_mm=40", "--set", "resolution.spacing_mm=20",
    "--out", "bed"),
])  # fmt: skip
def test_what_would_do_nothing_or_cannot_be_is_refused_and_leaves_no_folder(refused, arguments):
    refused(*arguments)


def test_a_film_takes_no_picture_and_no_time(refused):
    for more in (("--png", "b.png"), ("--time", "1")):
        assert "--movie is of all instants" in refused("view", "nowhere", "--movie", "a.gif", *more)


def test_run_leaves_a_whole_folder_and_is_not_run_over(tmp_path, refused):
    summary = json.loads(sdph("run", "disc_cluster", *SMALL, "--out", "mine", "--json", cwd=tmp_path).stdout)
    folder = tmp_path / "mine"
    assert summary == json.loads((folder / "summary.json").read_text())
    assert summary["time_s"] == 0.002
    assert summary["exchange_energy_mismatch_rel"] <= 1e-12
    for name in ("case.toml", "ledger.csv", "history.csv", "run.pvd"):
        assert (folder / name).stat().st_size > 0
    assert len(list((folder / "fields").iterdir())) == 6  # start and two outputs, particles and gas
    assert not list(folder.rglob("*.part"))
    assert "another run" in refused("run", "disc_cluster", *SMALL, "--out", "mine")
    # the case it wrote is the case it ran
    again = json.loads(sdph("run", "mine", "--out", "again", "--json", cwd=tmp_path).stdout)
    for key in (
        "time_s",
        "particles",
        "cells",
        "windows",
        "centre_temperature_K",
        "centre_gas_temperature_K",
        "heat_exchanged_J",
    ):
        assert again[key] == pytest.approx(summary[key], rel=1e-10), key


def test_init_gives_a_folder_of_ones_own(tmp_path, refused):
    sdph("init", "disc_cluster", "mine", cwd=tmp_path)
    assert (tmp_path / "mine" / "case.toml").read_text() == (scenes.HERE / "disc_cluster" / "case.toml").read_text()
    assert "another run or case" in refused("init", "disc_cluster", "mine")
    file = tmp_path / "mine" / "case.toml"
    file.write_text(file.read_text().replace("spacing_mm = 2.5", "spacing_mm = 250.0"))
    assert "spacing_mm = 250" in refused("run", "mine")


def test_unnamed_runs_are_numbered(tmp_path):
    (tmp_path / "runs" / "disc_cluster").mkdir(parents=True)
    sdph("run", "disc_cluster", *SMALL, cwd=tmp_path)
    assert (tmp_path / "runs" / "disc_cluster-2" / "summary.json").is_file()
    assert not list((tmp_path / "runs" / "disc_cluster").iterdir())


def test_a_gas_that_does_not_even_begin_its_first_window_is_code_3_and_one_line(monkeypatch, capsys):
    def unfinished(options):
        raise Unfinished("sdphGasFoam says: too hot")

    monkeypatch.setitem(cli.COMMANDS, "list", unfinished)
    assert cli.main(["list"]) == 3
    assert capsys.readouterr().err == "sdph: sdphGasFoam says: too hot\n"


@pytest.mark.parametrize("name, told", [("\\u0000\\u001b[31m", r"\x00\x1b[31m"), ("x" * 10**5, " [...] ")])
def test_what_was_given_cannot_command_the_terminal_nor_fill_it(refused, name, told):
    line = refused("explain", "disc_cluster", "--set", f'scene="{name}"').removesuffix("\n")
    assert told in line and line.isprintable() and len(line) < 2100
