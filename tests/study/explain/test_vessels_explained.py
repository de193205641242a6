"""What `sdph explain` says of vessels: gas with no way out, and the mesh that a case brings."""

import json

import foam_cases
import own_meshes
import pytest

from coupling.openfoam import poly_mesh
from sdph import scenes
from sdph.case import read as cases
from sdph.cli import main
from sdph.scenes import paths
from sdph.schema import CaseError
from sdph.study import closed_vessels

BED = scenes.HERE / "bubbling_bed" / "case.toml"


def judged(*overrides: str) -> None:
    closed_vessels.refuse_filling(cases.load(BED, overrides), paths.gas_template("bubbling_bed"))


def test_gas_that_finds_no_way_out_is_refused_in_one_line(capsys):
    closed = "boundaries.outlet.kind='wall'"
    with pytest.raises(CaseError, match=r"boundaries.jet is a velocity_inlet, and 0.188 m2/s"):  # 0.02 7.5 + 0.48 0.08
        judged(closed)
    judged()
    judged(closed, "gas.equation_of_state='ideal'")  # it fills up
    judged("boundaries.outlet.kind='velocity_inlet'", "boundaries.outlet.velocity_m_s=[0.0, 0.3768]")  # 0.1884/0.5
    with pytest.raises(CaseError, match="find no way out"):
        judged("boundaries.outlet.kind='velocity_inlet'", "boundaries.outlet.velocity_m_s=[0.0, 0.3]")
    assert main(["explain", "bubbling_bed", "--set", closed]) == 2
    assert capsys.readouterr().err.count("\n") == 1


def made(tmp_path):
    """A round vessel from an OpenFOAM case, as `sdph init` makes it."""
    source = foam_cases.fluidised_bed(
        tmp_path / "foam", own_meshes.cylinder(0.05, 0.2, 4, 10), "(0 0 0.25)", "(0 0 -9.81)"
    )
    assert main(["init", "--from-openfoam", str(source), str(tmp_path / "mine")]) == 0
    return tmp_path / "mine"


@pytest.mark.openfoam
def test_an_own_mesh_is_counted_and_priced_as_openfoams(tmp_path, capsys):
    """Cells and particles are those that a run has, not those of the box around the mesh."""
    mine = made(tmp_path)
    capsys.readouterr()
    assert main(["explain", str(mine), "--json"]) == 0
    rows = {row["what"]: row for row in json.loads(capsys.readouterr().out)["expected"]}
    assert rows["gas cells"]["value"] == len(poly_mesh.PolyMesh(mine / "gas").volumes) == 480
    assert rows["particles"]["value"] == pytest.approx(3483, abs=5)  # the box would hold 5292
    assert "OpenFOAM gas" in rows["wall time"]["how"]


@pytest.mark.openfoam
def test_a_closed_vessel_of_ones_own_is_refused(tmp_path, capsys):
    mine = made(tmp_path)
    shut = ("--set", "boundaries.outlet.kind='wall'", "--set", "gas.equation_of_state='constant'")
    capsys.readouterr()
    assert main(["explain", str(mine), *shut]) == 2
    assert "boundaries.inlet is a velocity_inlet" in capsys.readouterr().err
