"""The end of a program of OpenFOAM in one line: how it ended and why, never a line of a solver that went on well."""

import signal

import pytest

from coupling.openfoam.programs import install
from coupling.openfoam.programs import run as programs

RESIDUAL = "smoothSolver:  Solving for T, Initial residual = 1.6e-14, Final residual = 1.6e-14, No Iterations 0\n"
GOING_ON = "Time = 0.001 s, dt = 0.001 s\n" + RESIDUAL
BOX = 74 * "-" + "\n"
ABORT = (
    BOX + "Primary job  terminated normally, but 1 process returned\na non-zero exit code. Per user-direction, the job "
    "has been aborted.\n" + BOX
)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        (GOING_ON, "its log breaks off at 0.001 s without a cause"),
        ("Time = 0.25\n\nCourant Number mean: 0.1 max: 0.2\n", "its log breaks off at 0.25 s without a cause"),
        (
            "Time = 1e-05\n" + RESIDUAL + "ExecutionTime = 0.1 s  ClockTime = 0 s\n\n",
            "its log breaks off at 1e-05 s without a cause",
        ),
        (GOING_ON + "sdphGasFoam: the particles closed the connection\n", "the particles closed the connection"),
        (GOING_ON + "--> FOAM FATAL ERROR: \nno\n  such file\n\n    From function f()\n", "no such file"),
        (GOING_ON + ABORT, "one of its processes was killed or failed without a word"),
        (
            GOING_ON
            + ABORT
            + BOX
            + "mpirun noticed that process rank 1 with PID 0 on node vm exited on signal 9 (Killed).\n"
            + BOX,
            "rank 1 exited on signal 9 (Killed)",
        ),
        (
            "blockMesh: error while loading shared libraries: libX.so\n",
            "blockMesh: error while loading shared libraries: libX.so",
        ),
        ("", "it wrote no log"),
    ],
)
def test_the_cause_is_told_and_not_a_residual(tmp_path, text, why):
    (tmp_path / "log").write_text(text)
    assert programs.reason(tmp_path / "log") == why


@pytest.mark.parametrize(
    ("code", "how"),
    [
        (-signal.SIGKILL, "was killed by SIGKILL (by"),
        (137, "was killed by SIGKILL"),
        (-11, "by SIGSEGV"),
        (1, "ended with code 1"),
    ],
)
def test_the_end_is_told(code, how):
    assert how in programs.ending(code)


@pytest.mark.parametrize(("given", "told"), [(None, "1"), ("0", "0")])
def test_ranks_that_wait_give_way_unless_told_otherwise(monkeypatch, given, told):
    monkeypatch.delenv("OMPI_MCA_mpi_yield_when_idle", raising=False)
    if given:
        monkeypatch.setenv("OMPI_MCA_mpi_yield_when_idle", given)
    command = install.mpirun(2)
    assert command[command.index("mpi_yield_when_idle") - 1 :][:3] == ["--mca", "mpi_yield_when_idle", told]
