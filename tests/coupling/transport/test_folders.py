"""Folders that go with their owner: a live one's stay whoever sweeps, a dead one's go, and nobody else's are
touched."""

import fcntl
import os
import signal
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

from coupling.transport.folders import OwnFolder, sweep

PREFIX = "sdph-test"


def owner(where):
    """(process that holds a folder with a file `gas` in it, the folder)."""
    script = f"""
        import sys, time
        from coupling.transport.folders import OwnFolder
        folder = OwnFolder({str(where)!r}, {PREFIX!r})
        (folder.path / "gas").touch()
        print(folder.path, flush=True)
        time.sleep(60)
    """
    process = subprocess.Popen([sys.executable, "-c", textwrap.dedent(script)], stdout=subprocess.PIPE, text=True)
    return process, Path(process.stdout.readline().strip())


def end(process):
    process.send_signal(signal.SIGKILL)
    process.wait()
    process.stdout.close()


def test_a_live_owner_keeps_a_dead_one_loses(tmp_path):
    process, folder = owner(tmp_path)
    try:
        sweep(tmp_path, PREFIX, {"gas"})
        assert (folder / "gas").exists()
    finally:
        end(process)
    sweep(tmp_path, PREFIX, {"gas"})
    assert not list(tmp_path.iterdir())


def test_what_may_be_somebody_elses_stays(tmp_path):
    outside, where = tmp_path / "outside", tmp_path / "where"
    for folder in (outside, where, where / f"{PREFIX}-mine", where / f"{PREFIX}-foreign"):
        folder.mkdir()
    for file in (outside / "gas", where / f"{PREFIX}-mine" / "thesis.tex", where / f"{PREFIX}-file"):
        file.touch()
    (where / f"{PREFIX}-link").symlink_to(outside)
    if os.geteuid() == 0:
        os.chown(where / f"{PREFIX}-foreign", 12345, 12345)
    sweep(where, PREFIX, {"gas"})
    left = {path.name.removeprefix(f"{PREFIX}-") for path in where.iterdir()}
    assert left >= {"mine", "file", "link"} | ({"foreign"} if os.geteuid() == 0 else set())
    assert (outside / "gas").exists()
    sweep(tmp_path / "nowhere", PREFIX, set())


def test_starts_at_once_do_not_take_each_others(tmp_path):
    """Owners come and go in four processes, each of which sweeps before and after."""
    script = f"""
        from coupling.transport.folders import OwnFolder, sweep
        for _ in range(300):
            sweep({str(tmp_path)!r}, {PREFIX!r}, {{"gas"}})
            folder = OwnFolder({str(tmp_path)!r}, {PREFIX!r})
            (folder.path / "gas").touch()
            sweep({str(tmp_path)!r}, {PREFIX!r}, {{"gas"}})
            assert (folder.path / "gas").exists()
            folder.close()
    """
    processes = [
        subprocess.Popen([sys.executable, "-c", textwrap.dedent(script)], stderr=subprocess.PIPE) for _ in range(4)
    ]
    said = [process.communicate(timeout=120)[1] for process in processes]
    assert [process.returncode for process in processes] == [0] * 4, said
    assert not list(tmp_path.iterdir())


def test_no_folder_is_seen_before_it_is_locked(tmp_path, monkeypatch):
    """Whoever sweeps in the moment before the lock is taken finds nothing that has the name."""
    lock, seen = fcntl.flock, []

    def flock(descriptor, how):
        seen.extend(tmp_path.glob(f"{PREFIX}-*"))
        lock(descriptor, how)

    monkeypatch.setattr(fcntl, "flock", flock)
    OwnFolder(tmp_path, PREFIX).close()
    assert not seen


def test_a_folder_that_cannot_be_locked_leaves_nothing(tmp_path, monkeypatch):
    def flock(descriptor, how):
        raise OSError("no locks here")

    monkeypatch.setattr(fcntl, "flock", flock)
    with pytest.raises(OSError, match="no locks"):
        OwnFolder(tmp_path, PREFIX)
    assert not list(tmp_path.iterdir())
