"""Probes lie in the gas of a vessel."""

import math

import pytest
from test_vessel import INSIDE, filled

from sdph.cli import main

RADIUS = 0.1  # m, of the vessel


@pytest.mark.openfoam
def test_a_probe_in_no_cell_is_refused_and_one_at_the_wall_is_not(tmp_path, capsys):
    own = filled(tmp_path / "own", INSIDE)
    assert main(["run", str(own), "--set", "probes.far.at_m=[0.002, 0.002, 0.05]", "--out", str(tmp_path / "out")]) == 2
    said = capsys.readouterr().err.splitlines()[-1]
    assert "probes.far.at_m = (0.002, 0.002, 0.05) m is in no cell of the gas: the nearest, at (" in said
    assert not (tmp_path / "out").exists()
    cell = float(said.partition("is in no cell")[2].partition(" m away")[0].split()[-1])
    assert cell == pytest.approx(math.hypot(RADIUS - 0.002, RADIUS - 0.002) - RADIUS, rel=0.05)
    at_wall = ("--set", f"probes.near.at_m=[{RADIUS}, {1e-4}, 0.05]")
    assert main(["explain", str(own), *at_wall]) == 0
