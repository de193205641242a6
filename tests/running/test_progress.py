"""What a run says of itself while it goes: the line, the page, and what is refused or stopped because it would get
nowhere."""

import contextlib
import gc
import json
import os
import re
import subprocess
import sys
import time
from types import SimpleNamespace

import numba
import numpy as np
import pytest
from numba.core import event
from test_cli import SMALL, refused, sdph  # noqa: F401  (`refused` is a fixture)
from test_restart import load

from sdph import cli
from sdph.case import read as cases
from sdph.laws import cached
from sdph.methods.grains.bounds import COLLAPSE
from sdph.methods.grains.method import Stepper
from sdph.running import compiling, driver, ranks
from sdph.running.progress import Reporter
from sdph.running.simulation import Simulation
from sdph.schema import CaseError
from sdph.show import watch
from sdph.study import memory as room


class Terminal(list):
    """A stderr that is a terminal."""

    def write(self, text):
        self.append(text)

    def flush(self):
        pass

    def isatty(self):
        return True


LINE = re.compile(
    r"t = 0\.0004 s, window \d.*e-\d\d s \(.+\), 80 particles, residual \d.*\(\w+\), closure \d.* \(\w+\), 0 s left"
)


def test_the_line_on_a_terminal_says_all(tmp_path, monkeypatch):
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    monkeypatch.setenv("COLUMNS", "300")
    monkeypatch.setattr("sdph.running.progress.REFRESH", 0.0)
    reporter = Reporter()
    driver.run(load("disc_cluster", "embedded"), "disc_cluster", tmp_path / "run", None, reporter)
    reporter.close()
    assert LINE.search("".join(terminal)), "".join(terminal)[-500:]


def changed(case, effects=None, temperature_K=None):
    """A case with other effects, all of it of one temperature."""
    table = cases.to_table(case)
    for name in set(table["effects"]) - set(effects or table["effects"]):
        table.pop(name, None)
    table["effects"] = effects or table["effects"]
    for own in (table["gas"], *table["particles"].values(), *table["boundaries"].values()):
        if temperature_K and "temperature_K" in own:
            own["temperature_K"] = temperature_K
    return cases.from_table(table)


def test_a_run_goes_on_when_nobody_reads_what_it_says(tmp_path):
    """`2>&1 | head`: it ended, and told of a full disc."""
    command = [sys.executable, "-m", "sdph.cli", "run", "disc_cluster", *SMALL, "--out", "run"]
    reader, writer = os.pipe()
    os.close(reader)
    with os.fdopen(writer) as nobody:
        done = subprocess.run(command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=nobody, timeout=240)
    assert done.returncode == 0 and (tmp_path / "run/summary.json").is_file()
    assert not (tmp_path / "run/failure.json").exists()


def test_what_ranks_say_is_passed_on_until_nobody_reads(monkeypatch):
    reader, writer = os.pipe()
    os.close(reader)
    nobody = os.fdopen(writer, "w")
    monkeypatch.setattr(sys, "stderr", nobody)
    assert ranks._passed_on(["a line\n", f"{ranks.RULE}\n", "why\n", f"{ranks.RULE}\n", "another\n"]) == ["why"]
    monkeypatch.undo()
    with contextlib.suppress(BrokenPipeError):
        nobody.close()


def test_a_case_without_heat_shows_no_residual_of_it(tmp_path):
    shown = []
    for name, changes in (("warm", {}), ("cold", {"effects": ["drag"], "temperature_K": 300.0})):
        case = changed(load("disc_cluster", "embedded"), **changes)
        page = SimpleNamespace(show=lambda simulation, line: shown.append(line))
        driver.run(case, "disc_cluster", tmp_path / name, None, Reporter(quiet=True, page=page))
    assert "(heat)" in shown[0] and "residual" in shown[-1] and "(heat)" not in shown[-1]


def test_no_garbage_is_looked_for_while_kernels_compile():
    before = gc.isenabled()
    with event.trigger_event("numba:compile"), event.trigger_event("numba:compile"):
        assert not gc.isenabled()
    assert before and gc.isenabled()


def test_compiling_is_told_once_and_only_where_it_takes_time(tmp_path, monkeypatch):
    """In a process that finds no kernels, on stderr; kernels that compile at once are not told of."""
    heard = []
    monkeypatch.setattr(compiling, "PATIENCE", 0.05)
    slow, quick = (numba.njit(lambda x, k=k: x + k) for k in (1, 2))
    with compiling.told(heard.append):
        with event.trigger_event("numba:compile"):
            time.sleep(0.2)
            with event.trigger_event("numba:compile"):
                time.sleep(0.2)
        slow(1.0)
    assert heard == [compiling.TEXT]
    heard.clear()
    monkeypatch.setattr(compiling, "PATIENCE", 60.0)
    with compiling.told(heard.append):
        quick(1.0)
        quick(2.0)
    assert not heard


def test_what_kernels_took_to_compile_is_no_time_of_a_part(monkeypatch):
    """By a clock that goes a second each time that it is looked at; callees that compile within callers count once."""
    now = iter(range(100))
    for own in (cached, compiling):
        monkeypatch.setattr(own, "time", SimpleNamespace(perf_counter=lambda: float(next(now))))

    def work(value):
        with event.trigger_event("numba:compile"), event.trigger_event("numba:compile"):
            next(now)
        return value

    wall = {"particles": 1.0, "compiling": 2.0}
    assert compiling.timed(wall, "particles", work, 7) == 7
    assert wall == {"particles": 1.0 + 4.0 - 2.0, "compiling": 2.0 + 2.0}


def test_a_run_says_that_it_compiles_beside_its_json(tmp_path, monkeypatch, capsys):
    begin = Simulation.start

    def start(simulation):
        with event.trigger_event("numba:compile"):
            time.sleep(0.3)
        begin(simulation)

    monkeypatch.setattr(Simulation, "start", start)
    monkeypatch.setattr(compiling, "PATIENCE", 0.05)
    assert cli.main(["run", "disc_cluster", *SMALL, "--json", "--out", str(tmp_path / "mine")]) == 0
    told = capsys.readouterr()
    assert told.err.count(compiling.TEXT) == 1 and json.loads(told.out)["time_s"] == 0.002


def test_json_hides_no_warning(tmp_path):
    """What is printed is JSON alone; the warning stands beside it, and no progress does."""
    done = sdph(
        "run", "disc_cluster", *SMALL, "--set", "resolution.cell_mm=100", "--json", "--out", "mine", cwd=tmp_path
    )
    assert json.loads(done.stdout)["time_s"] == 0.002
    assert "warning: domain / cell = 5, safe from 10" in done.stderr and "t = " not in done.stderr


def test_the_page_shows_the_run(tmp_path):
    reporter = Reporter(quiet=True, page=watch.Page(tmp_path / "run"))
    driver.run(load("disc_cluster", "embedded"), "disc_cluster", tmp_path / "run", None, reporter)
    page = (tmp_path / "run" / watch.NAME).read_text()
    assert LINE.search(page) and 'http-equiv="refresh"' in page and "Heated disc" in page
    from matplotlib.image import imread

    picture = imread(tmp_path / "run" / watch.PICTURE)
    assert len(np.unique(picture.reshape(-1, picture.shape[2]), axis=0)) > 100
    assert not list((tmp_path / "run").glob(".*"))


def test_watch_is_a_word_of_the_command(tmp_path):
    sdph("run", "disc_cluster", *SMALL, "--watch", "--out", "mine", cwd=tmp_path)
    assert (tmp_path / "mine" / watch.NAME).exists() and (tmp_path / "mine" / watch.PICTURE).exists()


@pytest.mark.parametrize("key", ["resolution.spacing_mm=1e-4", "resolution.cell_mm=1e-4"])
def test_a_case_larger_than_the_machine_is_refused(refused, key):  # noqa: F811
    said = refused("run", "disc_cluster", "--set", key)
    assert "GB are free here" in said and "resolution.spacing_mm" in said


def test_memory_is_told_and_a_case_that_fits_is_not_refused(monkeypatch):
    assert 1e6 < room.available() < 1e15
    room.refuse_too_large(load("bubbling_bed", "embedded"))
    monkeypatch.setattr(room, "available", lambda: 1e6)
    with pytest.raises(CaseError, match="0.001 GB are free"):
        room.refuse_too_large(load("bubbling_bed", "embedded"))


def test_a_run_whose_sub_steps_collapse_is_stopped(tmp_path, monkeypatch, capsys):
    """Sound that nothing in the case can account for: exit code 5, and the sub-step, the particle and the place are
    named."""
    measure = Stepper._sub_step

    def sub_step(stepper, left):
        step = measure(stepper, left)
        if stepper.steps == 10:
            stepper.scratch.sound[7] = 2.0 * COLLAPSE * stepper.guard.reach
        return step

    monkeypatch.setattr(Stepper, "_sub_step", sub_step)
    overrides = [
        word
        for text in ("resolution.spacing_mm=20", "resolution.cell_mm=20", "run.end_time_s=0.01")
        for word in ("--set", text)
    ]
    assert (
        cli.main(["run", "bubbling_bed", "--gas", "embedded", *overrides, "--out", str(tmp_path / "run")])
        == cli.WENT_UNSTABLE
    )
    said = capsys.readouterr().err
    assert (
        "speed of sound of particle" in said
        and "the sub-step has fallen to" in said
        and len(said.splitlines()[-1:]) == 1
    )
    assert (tmp_path / "run" / "last_good.npz").exists()
