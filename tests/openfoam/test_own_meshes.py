"""sdphGasFoam on meshes that are no boxes, brought by the user."""

import json
import tomllib

import numpy as np
import own_meshes
import pytest
import tomli_w
from gas_boxes import box_case, template

from coupling.openfoam.solver import OpenFoamGas
from sdph import view
from sdph.cli import main

pytestmark = pytest.mark.openfoam

VELOCITY = (0.3, -0.2, 0.5)


def put_cylinder(folder):
    (folder / "system" / "blockMeshDict").write_text(own_meshes.cylinder(0.1, 0.4, 4, 8))
    return ("inlet", "outlet", "wall"), np.pi * 0.1**2 * 0.4


def put_sheared_box(folder):
    (folder / "system" / "blockMeshDict").write_text(own_meshes.sheared_box(0.1, 5))
    return ("all",), 0.1**3


def put_tetrahedra(folder):
    own_meshes.write_tetrahedra(folder / "constant" / "polyMesh", 0.1, 4)
    return ("all",), 0.1**3


@pytest.mark.parametrize("put_mesh", [put_cylinder, put_sheared_box, put_tetrahedra])
def test_uniform_flow_stays_uniform(tmp_path, put_mesh):
    """Cells get their velocity back from the fluxes through their faces: of a uniform flow to round-off, whatever their shape."""
    own = template(tmp_path)
    patches, volume = put_mesh(own)
    put_velocity(own, {name: fixed(VELOCITY) for name in patches}, VELOCITY)
    boundaries = {name: {"kind": "wall", "velocity_m_s": list(VELOCITY)} for name in patches}
    gas = OpenFoamGas(box_case((0.2, 0.2, 0.4), 0.02, boundaries=boundaries), tmp_path / "gas", own)
    try:
        gas.start(None, ())
        state = gas.advance(1e-6, {})
    finally:
        gas.close()
    assert gas.mesh.volumes.sum() == pytest.approx(volume, rel=0.05)  # chords for the arcs of a cylinder
    assert np.abs(state.fields["velocity"] - VELOCITY).max() < 1e-12


def fixed(velocity) -> str:
    return f"type fixedValue; value uniform ({' '.join(map(str, velocity))});"


def put_velocity(folder, patches, inside) -> None:
    """The start field 0/U: `patches` name -> boundary condition."""
    (folder / "0").mkdir()
    rows = "".join(f"    {name} {{ {condition} }}\n" for name, condition in patches.items())
    field = f"dimensions [0 1 -1 0 0 0 0];\ninternalField uniform ({' '.join(map(str, inside))});\nboundaryField\n{{\n{rows}}}\n"
    (folder / "0" / "U").write_text(own_meshes.HEAD.format(cls="volVectorField", name="U") + field)


def test_bed_in_a_round_vessel(tmp_path, capsys):
    """A user's cylinder along z, with a bed that gas blows through from below, at default numerics: nothing is lost,
    and the gas goes round the bed, not off."""
    vessel, out = tmp_path / "vessel", tmp_path / "out"
    assert main(["init", "bubbling_bed_3d", str(vessel)]) == 0
    put_cylinder(vessel / "gas")
    rest, above = (0, 0, 0), "type pressureInletOutletVelocity; value uniform (0 0 0);"
    put_velocity(vessel / "gas", {"inlet": fixed((0, 0, 0.3)), "outlet": above, "wall": fixed(rest)}, rest)
    case = tomllib.loads((vessel / "case.toml").read_text())
    case["run"] = {"end_time_s": 0.01, "output_interval_s": 0.01}
    case["domain"] = {"size_m": [0.2, 0.2, 0.4], "gravity_m_s2": [0.0, 0.0, -9.81]}
    case["resolution"] = {"spacing_mm": 10.0, "cell_mm": 20.0}
    bed = {"shape": "box", "lower_m": [0.06, 0.06, 0.0], "upper_m": [0.14, 0.14, 0.06], "volume_fraction": 0.6}
    case["particles"] = {"bed": bed | {"temperature_K": 350.0}}
    inlet = {"kind": "velocity_inlet", "side": "back", "velocity_m_s": [0.0, 0.0, 0.3]}
    case["boundaries"] = {"inlet": inlet, "outlet": {"kind": "pressure_outlet", "side": "front"}, "wall": {"kind": "wall"}}
    (vessel / "case.toml").write_text(tomli_w.dumps(case))
    assert main(["run", str(vessel), "--gas", "openfoam", "--out", str(out)]) == 0, capsys.readouterr().err
    summary = json.loads((out / "summary.json").read_text())
    drifts = {key: value for key, value in summary.items() if "drift" in key or "mismatch" in key}
    assert len(drifts) >= 5 and max(drifts.values()) < 1e-8, drifts
    _, _, gas = view.state_at(view.read(out), 0.01)
    assert 0.3 < np.linalg.norm(gas.cell_data["velocity"], axis=1).max() < 3.0  # comes in with 0.3 m/s, through half of the floor
