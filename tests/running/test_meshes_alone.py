"""An OpenFOAM mesh without fields becomes a case."""

from test_adopted import adopted, tetrahedra


def test_a_mesh_alone_is_taken_and_asks_for_its_conditions(tmp_path, capsys):
    """Without OpenFOAM, as blockMesh or snappyHexMesh leave it: no fields."""
    table = adopted(tetrahedra(tmp_path / "cube"), tmp_path / "mine")
    assert table["boundaries"] == {"all": {"kind": "wall"}}
    assert "note: the case has a mesh alone (no folder 0): give the conditions" in capsys.readouterr().out
    (tmp_path / "cube/0").mkdir()
    adopted(tmp_path / "cube", tmp_path / "other")
    assert "mesh alone" not in capsys.readouterr().out
