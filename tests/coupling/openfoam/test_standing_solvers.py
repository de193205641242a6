"""Solvers whose time stands still are ended with a line; slow, paused and young ones are not. They are programs made
here, that write the times of a log and use the processor or sleep."""

import os
import sys
import time
from pathlib import Path

import pytest

from coupling.gas import GasError
from coupling.openfoam.programs import run as programs

HEAD = """#!{python}
import os, time, pathlib
pathlib.Path("pid").write_text(str(os.getpid()))

def spin(seconds):
    begun = time.process_time()
    while time.process_time() - begun < seconds:
        pass

def steps(first, last, seconds=0.0):
    for step in range(first, last):
        print(f"Time = {{step * 0.01:g}}\\n\\nSolving 2-D cloud", flush=True)
        spin(seconds)

"""
STANDS = "steps(1, 7)\nspin(120.0)"


@pytest.fixture(autouse=True)
def short(monkeypatch):
    monkeypatch.setattr(programs, "STILL", 0.4)
    monkeypatch.setattr(programs, "MANY", 3)
    monkeypatch.setattr(programs, "LOOK", 0.02)


@pytest.fixture
def watched(tmp_path):
    """Function that runs a solver of this name and these lines."""

    def run(text, name="someFoam", before=()):
        file = tmp_path / name
        file.write_text(HEAD.format(python=sys.executable) + text)
        file.chmod(0o755)
        programs._watch([*before, str(file)], tmp_path, tmp_path / f"log.{name}", 1.0, dict(os.environ))

    return run


def is_gone(pid, seconds=5.0):
    """Wait for the end of a process; False if it does not come."""
    deadline = time.monotonic() + seconds
    while time.monotonic() < deadline:
        try:
            if " Z " in Path(f"/proc/{pid}/stat").read_text():
                return True
        except OSError:
            return True
        time.sleep(0.05)
    return False


def test_a_solver_that_stands_still_is_ended(watched, tmp_path):
    begun = time.monotonic()
    with pytest.raises(GasError, match=r"^someFoam stands still at 0\.06 s since \d+ s") as told:
        watched(STANDS)
    assert time.monotonic() - begun < 60.0 and is_gone((tmp_path / "pid").read_text())
    line = str(told.value)
    assert "--until less than 0.06" in line and str(tmp_path / "log.someFoam") in line
    assert "arcel" not in line and "\n" not in line


def test_of_parcels_the_line_says_what_helps(watched):
    with pytest.raises(GasError, match=r"tracking of parcels can loop for ever where walls meet at an angle"):
        watched(STANDS, "reactingParcelFoam")


def test_ranks_are_seen_and_ended_in_groups_of_their_own(watched, tmp_path):
    """As mpirun starts them."""
    with pytest.raises(GasError, match="stands still at 0.06 s"):
        watched("os.setpgid(0, 0)\n" + STANDS, before=("sh", "-c", '"$0"; true'))
    assert is_gone((tmp_path / "pid").read_text())


@pytest.mark.parametrize(
    "text",
    [
        "steps(1, 7, 0.6)",  # each is longer than STILL, none than MANY of them
        "steps(1, 3)\nspin(1.0)\nsteps(3, 7)",  # fewer than KNOWN are done
        "spin(1.0)\nsteps(1, 7)",  # it reads a mesh
        "steps(1, 7)\ntime.sleep(2.0)\nsteps(7, 9)",  # it is paused, or waits for a disk
    ],
    ids=["slow", "young", "mesh", "paused"],
)
def test_a_solver_that_goes_on_is_not_ended(watched, tmp_path, text):
    watched(text + "\nprint('End')")
    assert (tmp_path / "log.someFoam").read_text().endswith("End\n")


def test_it_is_told_that_time_stands_still(watched, monkeypatch):
    monkeypatch.setattr(programs, "TELL", 0.1)
    monkeypatch.setattr(programs, "QUIET", 1.0)
    monkeypatch.setattr(programs, "FEW", 2)
    heard = []
    with programs.told(heard.append):
        watched("steps(1, 7, 0.1)\ntime.sleep(3.0)")
    assert heard[-1] in [f"someFoam: t = 0.06 of 1 s, stands still since {s} s" for s in (2, 3, 4)]
    left = [line for line in heard if line.startswith("someFoam: t = 0.06 of 1 s") and line.endswith("left")]
    assert left and len(set(left)) == 1  # it does not rise


def test_a_time_that_is_half_written_waits_for_its_end(tmp_path):
    log = tmp_path / "log"
    log.write_bytes(b"Time = 0.1\nTime = 0.1")
    with log.open("rb") as told, log.open("ab", buffering=0) as more:
        steps = programs.Steps(told, os.getpid())
        steps.look()
        assert (steps.time, steps.count) == (0.1, 1)
        more.write(b"25\n" + b"residual\n" * programs.TAIL)
        steps.look()
        assert (steps.time, steps.count) == (0.125, 2)


def test_processor_time_is_that_of_the_process():
    before, begun = programs.processor_time(os.getpid()), time.process_time()
    while time.process_time() - begun < 0.5:
        pass
    assert programs.processor_time(os.getpid()) - before == pytest.approx(0.5, abs=0.1)
    assert programs.processor_time(2**30) == 0.0  # no process has that number
