"""Vessels that no scene has (validation/own_vessel/others), set up as its README says."""

import shutil
from pathlib import Path

import pytest

from sdph import cli

OTHERS = Path(__file__).parents[2] / "validation" / "own_vessel" / "others"


@pytest.mark.openfoam
@pytest.mark.parametrize("vessel", sorted(folder.name for folder in OTHERS.iterdir()))
def test_a_vessel_is_meshed_and_filled(tmp_path, capsys, vessel):
    mine = tmp_path / "mine"
    assert cli.main(["init", "disc_cluster", str(mine)]) == 0
    for file in (OTHERS / vessel).iterdir():
        shutil.copy(file, mine / ("gas/system" if file.name == "blockMeshDict" else ""))
    capsys.readouterr()
    assert cli.main(["explain", str(mine)]) == 0
    told = capsys.readouterr().out
    assert "EXPECTED" in told and "in no cell" not in told
