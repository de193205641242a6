"""A liquid that several processes share goes as by one process, ends as by one, and a process that dies is told of."""

import json
import os
import signal
import subprocess
import time
from pathlib import Path

import pytest

from sdph.cli import main
from sdph.engine import world
from sdph.engine.world import World
from sdph.running import ranks
from sdph.schema import CaseError
from tests.of_ranks import SDPH, WITH_MPI, alike, assert_same_bits, fine, run, shared_by

pytestmark = WITH_MPI
COARSE = ("--set", "resolution.spacing_mm=5.715", "--until", "0.02")
CASES = {  # name -> scene and options: what is shared of an effect at least once, in two dimensions and in three
    "front": (2, "dam_break", *COARSE),
    "shifting, corrected": (3, "square_patch", "--until", "0.05", "--set", "resolution.spacing_mm=50",
                            "--set", "liquid.pressure_gradient=corrected"),
    "two phases at a wall": (2, "drop_on_plate", "--until", "1e-4"),
    "thinning, periodic": (3, "power_law_poiseuille", "--until", "0.01"),
    "nozzle, open side": (3, "channel_bore", "--until", "0.02"),
    "drain, frame, in space": (2, "sloshing_cassini", "--until", "0.02"),
}  # fmt: skip


@pytest.mark.parametrize("name", CASES)
def test_a_shared_liquid_goes_as_one_process_takes_it(tmp_path, name):
    ranks, *options = CASES[name]
    alike(fine(tmp_path / "shared", *options, ranks=ranks), fine(tmp_path / "one", *options))
    told = json.loads((tmp_path / "shared/summary.json").read_text())
    assert told["ranks"] == ranks and 1.0 <= told["imbalance"] < 1.3 and told["halo_share"] > 0.0


def test_a_run_repeats_and_goes_on_by_other_processes_or_by_one(tmp_path):
    whole = fine(tmp_path / "whole", "dam_break", *COARSE)
    first, again = (fine(tmp_path / f"r{n}", "dam_break", *COARSE[:2], "--until", "0.01", ranks=4) for n in range(2))
    assert_same_bits(first, again)
    for cut, several in ((first, 3), (again, 1)):
        alike(fine(cut, "--resume", cut, "--until", "0.02", ranks=several), whole)


LONG = ("dam_break", "--set", "resolution.spacing_mm=3", "--set", "run.checkpoint_windows=1", "--ranks", "3")


def begun(folder: Path) -> subprocess.Popen:
    """A run by three processes that has left a checkpoint of its own."""
    going = subprocess.Popen((*SDPH, *LONG, "--out", str(folder)), stderr=subprocess.PIPE, text=True)
    end = time.monotonic() + 300.0  # kernels may have to be compiled
    while not list(folder.glob("checkpoints/00000000[1-9]")):
        assert time.monotonic() < end and going.poll() is None
        time.sleep(0.05)
    return going


def test_when_one_process_dies_all_end_and_the_run_says_how_to_go_on(tmp_path):
    going = begun(tmp_path / "run")
    os.kill(max(shared_by(tmp_path / "run")), signal.SIGKILL)
    told = going.communicate(timeout=10.0)[1]
    assert going.returncode == 3 and "signal 9" in told and "of 3" in told and "go on with: sdph run --resume" in told
    assert "Traceback" not in told and not shared_by(tmp_path / "run")
    assert fine(tmp_path / "run", "--resume", tmp_path / "run", "--until", "0.02", ranks=2)


def test_when_the_process_that_was_asked_is_killed_the_others_end(tmp_path):
    going = begun(tmp_path / "run")
    going.kill()
    going.communicate(timeout=30.0)
    end = time.monotonic() + 20.0  # each leaves a checkpoint, as when it is asked to stop
    while left := shared_by(tmp_path / "run"):
        assert time.monotonic() < end, left
        time.sleep(0.1)


def test_a_run_that_is_asked_to_stop_leaves_a_checkpoint(tmp_path):
    going = begun(tmp_path / "run")
    going.terminate()
    told = going.communicate(timeout=20.0)[1]
    assert going.returncode == 128 + signal.SIGTERM and told.count("stopped by SIGTERM") == 1
    assert "last checkpoint" in told and not shared_by(tmp_path / "run")


def test_what_goes_unstable_is_told_once_with_its_own_code(tmp_path):
    done = run("dam_break", *COARSE, "--set", "run.step_factor=1000", "--out", tmp_path / "run", ranks=3)
    assert done.returncode == 5 and done.stderr.count("went unstable") == 1 and "Traceback" not in done.stderr
    assert json.loads((tmp_path / "run/failure.json").read_text())["kind"] == "Unstable"


def test_a_fault_of_ours_in_one_process_ends_all(monkeypatch, capsys):
    ended = []
    monkeypatch.setattr(ranks, "end", ended.append)
    ranks.end_all(ZeroDivisionError, ZeroDivisionError("a fault"), None)
    assert ended == [1] and "a fault" in capsys.readouterr().err


def test_processes_of_other_programs_are_refused_in_one_line(monkeypatch):
    here, told = World(), []
    here.everywhere = lambda own: told.append(own) or [own, own.replace("sources ", "sources 0")]
    with pytest.raises(CaseError, match=r"rank 1 \(from 0\) runs sdph .* of sources 0.*install the same"):
        ranks.agree(here)
    here.everywhere = lambda own: [own, own]
    ranks.agree(here)
    assert all(name in told[0] for name in ("numpy", "numba", "mpi4py"))


def test_others_wait_once_for_what_the_first_has_to_say(monkeypatch):
    other, slept = World(), []
    other.chief = False
    monkeypatch.setattr(world, "here", lambda: other)
    monkeypatch.setattr(time, "sleep", slept.append)
    ranks.wait_for_the_first.cache_clear()
    ranks.wait_for_the_first()
    ranks.wait_for_the_first()
    ranks.wait_for_the_first.cache_clear()
    assert slept == [ranks.GRACE] and ranks.GRACE < 5.0


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (("swirl_spray", "--ranks", "2"), "records a run"),
        (("bed_with_tube", "--ranks", "2", "--watch"), "a page is of one process"),
        (("gel_droplet", "--ranks", "2"), "only grains in a gas or a liquid alone are shared"),
        (("dam_break", "--ranks", "0"), "a whole number, at least 1"),
        (("dam_break", "--ranks", "100000"), "room for"),
        (("dam_break", "--ranks", "2", "--set", "run.launcher=no_such_launcher"), "there is no no_such_launcher"),
        (("dam_break", "--ranks", "2", "--watch"), "a page is of one process"),
    ],
)
def test_what_cannot_be_shared_is_refused_in_one_line(tmp_path, options, told, capsys):
    assert main(["run", *options, "--out", str(tmp_path / "run")]) == 2
    said = capsys.readouterr().err
    assert told in said and said.count("\n") == 1 and not (tmp_path / "run").exists()


def test_the_launcher_is_ones_own(tmp_path):
    launcher = "mpirun --oversubscribe --bind-to none" + " --allow-run-as-root" * (os.geteuid() == 0)
    fine(tmp_path / "run", "dam_break", *COARSE[:2], "--until", "1e-3", "--set", f"run.launcher={launcher}", ranks=2)
    assert json.loads((tmp_path / "run/summary.json").read_text())["ranks"] == 2


def test_more_processes_than_particles_are_refused(tmp_path):
    few = ("dam_break", "--set", "resolution.spacing_mm=40", "--set", "pools.column.upper_m=[0.05715,0.05715]")
    done = run(*few, "--out", tmp_path / "run", ranks=7)
    assert done.returncode == 2 and "no more ranks than these" in done.stderr and "Traceback" not in done.stderr
    assert not (tmp_path / "run").exists()
