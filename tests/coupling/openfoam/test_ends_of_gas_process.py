"""Ends of sdphGasFoam: killed, told to stop or closed, it says so and leaves nothing."""

import contextlib
import os
import signal
import subprocess
import sys
import textwrap
import time
from pathlib import Path

import pytest
from busy_gas import busy, started
from gas_boxes import TEMPLATE, box, box_case

from coupling.gas import GasError
from coupling.openfoam.solver import OpenFoamGas


def alive(pids):
    found = []
    for pid in pids:
        with contextlib.suppress(FileNotFoundError, ProcessLookupError):  # it may end meanwhile
            found += [pid] * (" Z " not in Path(f"/proc/{pid}/stat").read_text())
    return found


def wait_for_end(pids, seconds=2.0):
    deadline = time.monotonic() + seconds
    while alive(pids) and time.monotonic() < deadline:
        time.sleep(0.02)
    return alive(pids)


@pytest.mark.parametrize("ranks, transport", [(1, "socket"), (1, "file"), (2, "socket"), (2, "file")])
def test_a_killed_solver_is_told_within_two_seconds_and_nothing_stays(tmp_path, ranks, transport):
    with box(tmp_path, (0.1, 0.06), 0.005, ranks=ranks, transport=transport) as gas:
        started(gas)
        busy(gas, 1)
        pids = solver_processes(gas)
        assert len(pids) == ranks
        os.kill(pids[-1], signal.SIGKILL)
        begin = time.monotonic()
        with pytest.raises(GasError, match=r"sdphGasFoam .*log: .*log\.sdphGasFoam") as told:
            busy(gas, 3)
        assert time.monotonic() - begin < 2.0
        assert "residual" not in str(told.value) and "---" not in str(told.value)
        assert not wait_for_end(pids)
    assert not list((tmp_path / "gas").glob("*exchange-*"))


def solver_processes(gas):
    """The ranks, wherever mpirun put them."""
    found = subprocess.run(["pgrep", "-f", f"sdphGasFoam -case {gas._folder} "], capture_output=True, text=True)
    pids = [int(pid) for pid in found.stdout.split()]
    return [pid for pid in pids if Path(f"/proc/{pid}/comm").read_text().strip() == "sdphGasFoam"]


@pytest.mark.parametrize("ranks", [1, 2])
def test_one_sigterm_ends_a_run_whose_gas_hangs(tmp_path, ranks):
    """Within 10 s, with the exit code of the signal; nothing stays behind."""
    settings = ("resolution.spacing_mm=20", "resolution.cell_mm=50", f"coupling.gas_ranks={ranks}")
    quick = [word for setting in settings for word in ("--set", setting)]
    command = [
        sys.executable,
        "-m",
        "sdph.cli",
        "run",
        "disc_cluster",
        "--gas",
        "openfoam",
        "--out",
        str(tmp_path / "run"),
        *quick,
    ]
    process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
    while not (tmp_path / "run" / "ledger.csv").is_file() or len((tmp_path / "run" / "ledger.csv").read_bytes()) < 500:
        time.sleep(0.1)
        assert process.poll() is None
    found = subprocess.run(["pgrep", "-f", f"sdphGasFoam -case {tmp_path}/run/gas "], capture_output=True, text=True)
    pids = [int(pid) for pid in found.stdout.split()]
    for pid in pids:
        os.kill(pid, signal.SIGSTOP)
    process.send_signal(signal.SIGTERM)
    _, said = process.communicate(timeout=10.0)
    assert process.returncode == 128 + signal.SIGTERM and "stopped by SIGTERM" in said.splitlines()[-1]
    assert not wait_for_end(pids)


@pytest.mark.parametrize("ranks, transport", [(1, "socket"), (2, "file")])
def test_the_solver_ends_when_the_particles_are_killed(tmp_path, ranks, transport):
    script = f"""
        import sys, time
        sys.path.insert(0, {str(Path(__file__).parent)!r})
        from pathlib import Path
        from gas_boxes import TEMPLATE, box_case
        from coupling.openfoam.solver import OpenFoamGas
        case = box_case((0.1, 0.06), 0.005, ranks={ranks}, transport={transport!r})
        gas = OpenFoamGas(case, Path({str(tmp_path)!r}) / "gas", TEMPLATE)
        gas.start(None, ())
        print("ready", flush=True)
        time.sleep(60)
    """
    process = subprocess.Popen([sys.executable, "-c", textwrap.dedent(script)], stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "ready\n"
    found = subprocess.run(["pgrep", "-f", "--", f"-case {tmp_path}/gas "], capture_output=True, text=True)
    pids = [int(pid) for pid in found.stdout.split()]
    assert len(pids) == (1 if ranks == 1 else 1 + ranks)
    process.kill()
    left = wait_for_end(pids, 3.0)
    process.wait()
    process.stdout.close()
    assert not left


def test_close_leaves_nothing(tmp_path):
    with box(tmp_path, (0.1, 0.06), 0.005, ranks=2) as gas:
        gas.start(None, ())
        pids = solver_processes(gas)
    assert len(pids) == 2
    assert not wait_for_end(pids)
    gas.close()
    with pytest.raises(GasError, match="closed"):
        gas.advance(1e-3, {})


def test_waiting_is_told(tmp_path):
    told = []
    gas = OpenFoamGas(box_case((0.1, 0.06), 0.005), tmp_path / "gas", TEMPLATE, status=told.append)
    try:
        gas.start(None, ())
        os.kill(gas._process.pid, signal.SIGSTOP)
        waker = subprocess.Popen(["sh", "-c", f"sleep 2.6; kill -CONT {gas._process.pid}"])
        gas.advance(1e-3, {})
        waker.wait()
    finally:
        gas.close()
    assert any(line.startswith("waiting for sdphGasFoam, 2 s, log: ") for line in told)
