"""OpenFOAM that is found but cannot be used: `auto` takes the embedded gas in one line, `openfoam` is an error.

A comparator that cannot run is one line too, and no reason for `make demo` to fail.
"""

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

from coupling.openfoam.comparators import run as comparators
from sdph.cli import main

pytestmark = pytest.mark.openfoam

SHORT = ("run", "disc_cluster", "--until", "1e-4")
INSTEAD = "the gas is solved by the embedded solver"


@pytest.fixture
def tools(tmp_path, monkeypatch):
    """A folder that is the whole PATH: links to what runs here, less what a test takes away or replaces."""
    folder = tmp_path / "bin"
    folder.mkdir()
    for name in ("blockMesh", "dpkg-query", "sh", "mpirun"):
        (folder / name).symlink_to(shutil.which(name))
    monkeypatch.setenv("PATH", str(folder))
    return folder


def replace(program, script: str) -> None:
    program.unlink()
    program.write_text(f"#!/bin/sh\n{script}\n")
    program.chmod(0o755)


def said(capsys) -> list[str]:
    """Lines of standard error that are not the course of the run."""
    return [line for line in capsys.readouterr().err.splitlines() if not line.startswith("t = ")]


def test_nothing_to_compile_with(tmp_path, tools, monkeypatch, capsys):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    assert main([*SHORT, "--out", str(tmp_path / "auto")]) == 0
    lines = [line for line in said(capsys) if "compiling" not in line]
    assert len(lines) == 1 and "g++ was not found" in lines[0] and INSTEAD in lines[0]
    assert main([*SHORT, "--gas", "openfoam", "--out", str(tmp_path / "openfoam")]) == 2
    assert "g++ was not found" in said(capsys)[-1]
    assert main(["run", "--resume", str(tmp_path / "auto"), "--until", "2e-4"]) == 0


def test_headers_that_cannot_be_had(tmp_path, tools, monkeypatch, capsys):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    for name, script in (("g++", "exit 1"), ("apt-get", "echo 'E: Failed to fetch' >&2; exit 100")):
        (tools / name).touch()
        replace(tools / name, script)
    assert main([*SHORT, "--out", str(tmp_path / "auto")]) == 0
    lines = [line for line in said(capsys) if line.startswith("OpenFOAM")]
    assert len(lines) == 1 and "E: Failed to fetch" in lines[0] and INSTEAD in lines[0]
    assert main([*SHORT, "--gas", "openfoam", "--out", str(tmp_path / "openfoam")]) == 3


def test_programs_that_abort(tmp_path, tools, capsys):
    replace(tools / "blockMesh", "echo 'error in IOstream sha1'; kill -ABRT $$")
    assert main([*SHORT, "--out", str(tmp_path / "auto")]) == 0
    lines = said(capsys)
    assert len(lines) == 1 and "OpenFOAM cannot be used: blockMesh" in lines[0]
    assert "IOstream sha1" in lines[0] and INSTEAD in lines[0]
    assert main([*SHORT, "--gas", "openfoam", "--out", str(tmp_path / "openfoam")]) == 3
    assert "IOstream sha1" in said(capsys)[-1]
    assert main(["run", "--resume", str(tmp_path / "auto"), "--until", "2e-4"]) == 0  # by the solver that it began with


def own_case(folder, more: str = ""):
    """The command that runs a case with a blockMeshDict of its own, which is none."""
    assert main(["init", "disc_cluster", str(folder)]) == 0
    head = "FoamFile { version 2.0; format ascii; class dictionary; object blockMeshDict; }"
    (folder / "gas" / "system" / "blockMeshDict").write_text(f"{head}{more}")
    return ("run", str(folder), "--until", "1e-4")


def test_a_mesh_that_only_openfoam_reads_is_not_left_out(tmp_path, tools, capsys):
    case = own_case(tmp_path / "case")
    replace(tools / "blockMesh", "exit 1")
    assert main([*case, "--out", str(tmp_path / "out")]) == 3
    assert "is a mesh that only OpenFOAM reads" in said(capsys)[-1]


def test_a_case_that_is_wrong_is_not_taken_for_openfoam_that_is(tmp_path, tools, capsys):
    case = own_case(tmp_path / "case", " vertices 5;")
    assert main([*case, "--out", str(tmp_path / "out")]) == 3
    lines = said(capsys)
    assert lines[-1].startswith("sdph: blockMesh ended with code 1") and not any(INSTEAD in line for line in lines)
    log = Path(re.search(r"log: (.*?)\)", lines[-1])[1])
    assert "vertices" in log.read_text()


def test_a_program_that_is_missing_is_named(tmp_path, tools, capsys):
    (tools / "mpirun").unlink()
    (tools / "decomposePar").symlink_to("/usr/bin/decomposePar")
    assert main([*SHORT, "--gas", "openfoam", "--np", "2", "--out", str(tmp_path / "out")]) == 3
    assert "mpirun cannot be started: No such file or directory" in said(capsys)[-1]


def test_a_comparator_that_aborts(tmp_path, monkeypatch, capsys):
    often = ("--set", "run.output_interval_s=0.001")
    assert main([*SHORT[:2], *often, "--until", "1e-3", "--gas", "embedded", "--out", str(tmp_path / "run")]) == 0
    said(capsys)
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin" / "twoPhaseEulerFoam").touch()
    replace(tmp_path / "bin" / "twoPhaseEulerFoam", "echo 'error in IOstream sha1'; kill -ABRT $$")
    monkeypatch.setenv("PATH", f"{tmp_path / 'bin'}{os.pathsep}{os.environ['PATH']}")
    monkeypatch.setattr(comparators, "shelf", lambda: tmp_path / "references")
    assert main(["compare", str(tmp_path / "run"), "--against", "tfm"]) == 3
    price, line = said(capsys)
    assert "twoPhaseEulerFoam begins" in price
    assert line.startswith("sdph: twoPhaseEulerFoam") and "error in IOstream sha1" in line


@pytest.mark.parametrize("code, fine", [(0, True), (3, True), (1, False), (2, False)])
def test_demo_goes_on_without_a_comparator(tmp_path, code, fine):
    """The recipe of the Makefile, with a program in place of sdph that ends as `compare` does where no two fluids
    run."""
    venv = tmp_path / "venv"
    (venv / "bin").mkdir(parents=True)
    (venv / "bin" / "sdph").touch()
    replace(venv / "bin" / "sdph", f'case "$*" in *tfm) echo "sdph: aborted" >&2; exit {code};; esac')
    (venv / "installed").touch()
    (tmp_path / "demo").mkdir()
    make = ["make", "-C", str(Path(__file__).parents[3]), "demo", f"VENV={venv}", f"RUN={tmp_path / 'demo'}"]
    done = subprocess.run(make, capture_output=True, text=True)
    assert (done.returncode == 0) is fine, done.stderr
    assert "sdph: aborted" in done.stderr
