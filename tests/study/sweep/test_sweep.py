"""`sdph sweep`: points, runs that are done once, failures that are told, the table and its figure."""

import csv
import json
import signal
import subprocess
import sys
import time
import types
from concurrent.futures import ThreadPoolExecutor, as_completed

import pytest

from sdph import cli
from sdph.schema import CaseError
from sdph.study import pool
from sdph.study.sweep import jobs, plan

SMALL = ("--set", "resolution.cell_mm=50", "--gas", "embedded", "--until", "0.001")
FINE = {"exit_code": 0, "reason": ""}


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("1,2.5", ["1", "2.5"]),
        ("[1.0,2.0],[3.0,[4.0,5.0]]", ["[1.0,2.0]", "[3.0,[4.0,5.0]]"]),
        ("'a,b',c", ["'a,b'", "c"]),
        ("1:3:3", ["1", "2", "3"]),
        ("0:1:3", ["0.0", "0.5", "1.0"]),
        ("0.1:0.3:3,7", ["0.1", "0.2", "0.3", "7"]),
        ("1e-3:2e-3:2", ["0.001", "0.002"]),
        ("C:/meshes/a.stl", ["C:/meshes/a.stl"]),
    ],
)
def test_values_of_a_key(text, found):
    assert plan.values(text, text) == found


@pytest.mark.parametrize(
    ("sets", "said"),
    [
        (["a.b"], "give it as section.key=v1,v2"),
        (["a.b="], "a value is missing"),
        (["a.b=1,,2"], "a value is missing"),
        (["a.b=1:2:1"], "n a whole number of at least 2"),
        (["a.b=1", "a.b=2"], "a.b was given already"),
        (["a.b=1:2:200", "a.c=1:2:200"], "that makes 40000 runs"),
    ],
)
def test_values_that_are_none_are_refused(sets, said):
    with pytest.raises(CaseError, match=said):
        plan.points(sets)


def test_a_list_meets_a_grid(tmp_path):
    (tmp_path / "list.csv").write_text("heat.closure,resolution.cell_mm\npaper,50\ngeometric,\n", encoding="utf-8")
    found = plan.points(["resolution.spacing_mm=10,20"], tmp_path / "list.csv")
    assert found == [
        {"heat.closure": closure, "resolution.cell_mm": cell, "resolution.spacing_mm": spacing}
        for closure, cell in (("paper", "50"), ("geometric", ""))
        for spacing in ("10", "20")
    ]
    with pytest.raises(CaseError, match="it is a column of"):
        plan.points(["heat.closure=paper"], tmp_path / "list.csv")
    (tmp_path / "list.csv").write_text("heat.closure\n", encoding="utf-8")
    with pytest.raises(CaseError, match="it has no rows"):
        plan.points([], tmp_path / "list.csv")


def rows_of(folder):
    with open(folder / "sweep.csv", newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_a_sweep_goes_on_where_it_was_left(tmp_path, monkeypatch, capsys):
    """Runs that are done are not done again, more values make more runs, one that cannot be run is told and marked."""
    monkeypatch.chdir(tmp_path)
    command = ["sweep", "disc_cluster", *SMALL, "--out", "study"]
    assert cli.main([*command, "--set", "resolution.spacing_mm=20"]) == 0
    first = rows_of(tmp_path / "study")
    stamp = (tmp_path / "study" / "runs" / first[0]["run"] / "summary.json").stat().st_mtime_ns
    more = ["--set", "resolution.spacing_mm=20,25,-1", "--plot", "centre_rise_K"]
    capsys.readouterr()
    assert cli.main([*command, *more]) == 1
    said = capsys.readouterr()
    assert "3 runs, 1 of them to do" in said.err and said.out.startswith("2 of 3: ")
    rows = rows_of(tmp_path / "study")
    assert [row["exit_code"] for row in rows] == ["0", "0", "2"] and rows[0] == first[0]
    assert "resolution.spacing_mm = -1" in rows[2]["reason"] and rows[2]["centre_rise_K"] == ""
    assert float(rows[1]["centre_rise_K"]) > 0.0 and rows[1]["resolution.spacing_mm"] == "25"
    run = tmp_path / "study" / "runs" / rows[0]["run"]
    assert (run / "summary.json").stat().st_mtime_ns == stamp
    assert float(rows[0]["time_s"]) == json.loads((run / "summary.json").read_text())["time_s"] == 0.001
    assert (tmp_path / "study" / "sweep.png").stat().st_size > 5000


def job(tmp_path, name="a", refused=""):
    return jobs.Job({"resolution.spacing_mm": "20"}, str(tmp_path / "runs" / name), (), str(tmp_path), 0, refused)


@pytest.mark.parametrize(
    ("code", "again", "stays"), [(5, False, True), (5, True, False), (3, False, False), (130, False, False)]
)
def test_failures_that_last_stay_and_others_are_tried_again(tmp_path, code, again, stays):
    before = {"a": {"exit_code": code, "reason": "it said so"}}
    assert (jobs.standing(job(tmp_path), before, again) is not None) == stays
    assert jobs.standing(job(tmp_path, refused="no"), {}, again) == {"exit_code": 2, "reason": "no"}


def test_a_run_that_was_cut_goes_on_and_one_that_fails_says_why(tmp_path, monkeypatch):
    """Commands that are given to `sdph run`, by a stand-in for the process."""
    given = []

    def process(command, **more):
        given.append(command[3:])
        more["stdout"].write("t = 1 s\nsdph: pressure is -7e23 in cell 3; lower it\nsee the log\n")
        return 5

    monkeypatch.setattr(jobs, "ended", process)
    own = job(tmp_path)
    outcome = jobs.done(own)
    assert (outcome["exit_code"], outcome["reason"]) == (5, "pressure is -7e23 in cell 3; lower it")
    folder = tmp_path / "runs" / "a"
    folder.mkdir()
    for name in ("case.toml", "origin.json"):
        (folder / name).write_text("")
    jobs.done(own)
    assert given[-1] == ["run", "--resume", str(folder)]


class Client:
    """Stand-in for the client of dask, on threads."""

    loop = None

    def __init__(self, address=None, **more):
        if address == "tcp://nobody:1":
            raise OSError("Timed out")
        self.given, self.pool = more, ThreadPoolExecutor(more.get("n_workers", 1))

    def __enter__(self):
        return self

    def __exit__(self, *error):
        self.pool.shutdown()

    def submit(self, function, job, **more):
        return self.pool.submit(function, job)


def test_workers_of_dask_do_the_runs(tmp_path, monkeypatch):
    """By a stand-in; one that is lost is told as a failure."""
    monkeypatch.setitem(
        sys.modules,
        "distributed",
        types.SimpleNamespace(Client=Client, as_completed=lambda futures, loop: as_completed(futures)),
    )

    def done(own):
        if own.name == "b":
            raise RuntimeError("worker died")
        return FINE

    found = {own.name: told for own, told in pool.outcomes([job(tmp_path, "a"), job(tmp_path, "b")], done, workers=2)}
    assert found["a"] == FINE and found["b"]["reason"] == "its worker failed: worker died"
    with pytest.raises(CaseError, match="no scheduler of dask answers there"):
        list(pool.outcomes([job(tmp_path)], jobs.done, scheduler="tcp://nobody:1"))


def test_dask_that_is_missing_is_told(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(CaseError, match=r"pip install 'sdph\[sweep\]'"):
        list(pool.outcomes([job(tmp_path)], jobs.done, workers=2))


def test_workers_of_the_real_dask(tmp_path):
    pytest.importorskip("distributed", reason="dask is not installed: pip install 'sdph[sweep]'")
    code = cli.main(
        [
            "sweep",
            "disc_cluster",
            *SMALL,
            "--out",
            str(tmp_path),
            "--workers",
            "2",
            "--set",
            "resolution.spacing_mm=20,25",
        ]
    )
    assert code == 0 and [row["exit_code"] for row in rows_of(tmp_path)] == ["0", "0"]


def test_a_sweep_that_is_ended_ends_its_run(tmp_path):
    """SIGTERM to the sweep is the run's too: it stops, with its checkpoint, and the next call goes on."""
    out = tmp_path / "out"
    words = [
        "sweep",
        "dam_break",
        "--set",
        "liquid.courant=0.2,0.25",
        "--set",
        "resolution.spacing_mm=0.7",
        "--out",
        out,
    ]
    sweep = subprocess.Popen([sys.executable, "-m", "sdph.cli", *map(str, words)], stderr=subprocess.DEVNULL)
    deadline = time.monotonic() + 200.0
    while not (begun := [path for path in out.rglob("ledger.csv") if len(path.read_text().splitlines()) > 3]):
        assert time.monotonic() < deadline
        time.sleep(0.2)
    sweep.terminate()
    assert sweep.wait(60.0) == 128 + signal.SIGTERM
    size = begun[0].stat().st_size
    time.sleep(2.0)
    assert begun[0].stat().st_size == size
    assert list(begun[0].parent.glob("checkpoints/*"))
