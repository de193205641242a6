"""The sides of the domain as walls around a mesh of one's own."""

import pytest
from test_vessel import filled

from sdph.case import read as cases
from sdph.cli import main


@pytest.mark.openfoam
def test_sides_of_the_domain_as_walls_let_grains_out_where_the_outlet_is(tmp_path, capsys):
    """Patches have no side in the case: the first one named was taken for all sides."""
    box = {"shape": "box", "lower_m": [0.05, 0.05, 0.0], "upper_m": [0.15, 0.15, 0.05], "volume_fraction": 0.3}
    own = filled(tmp_path / "own", box | {"temperature_K": 300.0}, walls={"source": "mesh"})
    assert main(["run", str(own), "--gas", "openfoam", "--out", str(tmp_path / "out")]) == 0, capsys.readouterr().err
    kept = cases.load(tmp_path / "out" / "case.toml").boundaries
    sides = {name: boundary.side for name, boundary in kept.items()}
    assert sides == {"inlet": "back", "outlet": "front", "wall": None}


@pytest.mark.openfoam
def test_a_region_outside_the_vessel_blames_no_mesh_that_the_case_has_not(tmp_path, capsys):
    corner = {"shape": "box", "lower_m": [0.0, 0.0, 0.0], "upper_m": [0.01, 0.01, 0.05], "volume_fraction": 0.6}
    own = filled(tmp_path / "own", corner | {"temperature_K": 350.0})
    assert main(["explain", str(own), "--gas", "openfoam"]) == 2
    said = capsys.readouterr().err.splitlines()[-1]
    assert "in front of the walls of the gas's mesh" in said and "walls.mesh" not in said
