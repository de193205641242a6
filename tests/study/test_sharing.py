"""`explain --ranks` foresees what a run's summary then tells; `init --slurm` leaves a script that a shell takes."""

import json
import os
import shutil
import subprocess

import pytest

from sdph import scenes
from sdph.case import read as cases
from sdph.cli import main
from sdph.schema import CaseError
from sdph.study import sharing

PATCH = ("square_patch", "resolution.spacing_mm=25")


def told(number: int) -> dict:
    case = cases.load(scenes.HERE / PATCH[0] / "case.toml", (PATCH[1],))
    return {row["what"]: row["value"] for row in sharing.rows(case, number)}


def test_shares_are_even_and_copies_grow_with_the_ranks():
    two, four = told(2), told(4)
    assert two["fullest rank over the mean, walls left out"] < 1.06 > four["fullest rank over the mean, walls left out"]
    assert 0.0 < two["copies of others', over own particles"] < four["copies of others', over own particles"]
    assert four["memory of a rank"] < two["memory of a rank"]
    assert 1.0 > two["expected efficiency, one thread a rank"] > four["expected efficiency, one thread a rank"] > 0.0


@pytest.mark.skipif(
    shutil.which("mpirun") is None and "CI" not in os.environ, reason="there is no mpirun (apt install openmpi-bin)"
)
def test_the_run_has_the_copies_that_were_foreseen(tmp_path):
    options = ["--set", PATCH[1], "--until", "1e-3", "--out", str(tmp_path / "run"), "--ranks", "2"]
    assert main(["run", PATCH[0], *options]) == 0
    found = json.loads((tmp_path / "run/summary.json").read_text())["halo_share"]
    assert found == pytest.approx(told(2)["copies of others', over own particles"], rel=0.1)


def test_explain_prints_it_and_refuses_what_run_refuses(capsys):
    assert main(["explain", PATCH[0], "--set", PATCH[1], "--ranks", "2", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["ranks"][0] == {"what": "ranks", "value": 2, "unit": ""}
    with pytest.raises(CaseError, match="only grains in a gas or a liquid alone"):
        sharing.rows(cases.load(scenes.HERE / "thick_ring" / "case.toml"), 2)


def test_a_script_for_slurm_stands_beside_the_case(tmp_path):
    assert main(["init", "dam_break", str(tmp_path / "case"), "--slurm"]) == 0
    assert subprocess.run(["sh", "-n", str(tmp_path / "case/job.sh")], check=False).returncode == 0
    script = (tmp_path / "case/job.sh").read_text()
    assert "--ranks $SLURM_NTASKS" in script and "--resume run" in script and 'run.launcher="srun' in script
    assert "if [ -f run/origin.json ]" in script  # of a job that was cut before its first checkpoint too


def test_a_tank_that_nozzles_alone_fill_has_no_shares_yet():
    """Walls are there at the start, and no liquid that processes could share."""
    table = cases.to_table(cases.load(scenes.HERE / "free_overfall" / "case.toml"))
    del table["pools"]
    found = {row["what"]: row["value"] for row in sharing.rows(cases.from_table(table), 2)}
    assert found == {"ranks": 2, "particles at the start": 0}
