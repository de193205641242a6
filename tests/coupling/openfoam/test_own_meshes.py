"""sdphGasFoam on meshes that are no boxes, brought by the user."""

import json
import tomllib

import numpy as np
import own_meshes
import pytest
import tomli_w
from gas_boxes import box_case, template

from coupling.openfoam.solver import OpenFoamGas
from sdph.cli import main
from sdph.show import timeline

pytestmark = pytest.mark.openfoam

VELOCITY = (0.3, -0.2, 0.5)


def put_cylinder(folder):
    (folder / "system" / "blockMeshDict").write_text(own_meshes.cylinder(0.1, 0.4, 4, 16))
    return ("inlet", "outlet", "wall"), np.pi * 0.1**2 * 0.4


def put_sheared_box(folder):
    (folder / "system" / "blockMeshDict").write_text(own_meshes.sheared_box(0.1, 5))
    return ("all",), 0.1**3


def put_tetrahedra(folder):
    own_meshes.write_tetrahedra(folder / "constant" / "polyMesh", 0.1, 4)
    return ("all",), 0.1**3


@pytest.mark.parametrize("put_mesh", [put_cylinder, put_sheared_box, put_tetrahedra])
def test_uniform_flow_stays_uniform(tmp_path, put_mesh):
    """Cells get their velocity back from the fluxes of their faces: of a uniform flow to round-off, whatever their
    shape."""
    own = template(tmp_path)
    patches, volume = put_mesh(own)
    put_velocity(own, {name: fixed(VELOCITY) for name in patches}, VELOCITY)
    boundaries = {name: {"kind": "velocity_inlet", "velocity_m_s": list(VELOCITY)} for name in patches}
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
    head = own_meshes.HEAD.format(cls="volVectorField", name="U") + "dimensions [0 1 -1 0 0 0 0];\n"
    value = f"uniform ({' '.join(map(str, inside))})"
    (folder / "0" / "U").write_text(f"{head}internalField {value};\nboundaryField\n{{\n{rows}}}\n")


def round_vessel(folder, metrics):
    """A user's case of a cylinder along z, with a bed that gas blows through from below: its own mesh and start
    field."""
    assert main(["init", "bubbling_bed_3d", str(folder)]) == 0
    put_cylinder(folder / "gas")
    rest, above = (0, 0, 0), "type pressureInletOutletVelocity; value uniform (0 0 0);"
    put_velocity(folder / "gas", {"inlet": fixed((0, 0, 0.3)), "outlet": above, "wall": fixed(rest)}, rest)
    case = tomllib.loads((folder / "case.toml").read_text())
    case["run"] = {"end_time_s": 0.01, "output_interval_s": 0.01, "metrics": metrics}
    case["domain"] = {"size_m": [0.2, 0.2, 0.4], "gravity_m_s2": [0.0, 0.0, -9.81]}
    case["resolution"] = {"spacing_mm": 10.0, "cell_mm": 20.0}
    place = {"shape": "box", "lower_m": [0.06, 0.06, 0.0], "upper_m": [0.14, 0.14, 0.06]}
    case["particles"] = {"bed": place | {"volume_fraction": 0.6, "temperature_K": 350.0}}
    inlet = {"kind": "velocity_inlet", "side": "back", "velocity_m_s": [0.0, 0.0, 0.3]}
    outlet = {"kind": "pressure_outlet", "side": "front"}
    case["boundaries"] = {"inlet": inlet, "outlet": outlet, "wall": {"kind": "wall"}}
    # a floor in line with the lattice: behind facets dummies stand in none, and grains near packing start with a jolt
    case["walls"] = case.get("walls", {}) | {"source": "mesh"}
    (folder / "case.toml").write_text(tomli_w.dumps(case))
    return folder


def test_bed_in_a_round_vessel(tmp_path, capsys):
    """At default numerics nothing is lost, the gas goes round the bed, not off, and the grains weigh on the round
    floor."""
    vessel, out = round_vessel(tmp_path / "vessel", ["column"]), tmp_path / "out"
    assert main(["run", str(vessel), "--gas", "openfoam", "--out", str(out)]) == 0, capsys.readouterr().err
    summary = json.loads((out / "summary.json").read_text())
    drifts = {key: value for key, value in summary.items() if "drift" in key or "mismatch" in key}
    numerical = {key: drifts.pop(key) for key in ("gas_momentum_drift_kg_m_s", "gas_momentum_drift_rel")}
    assert len(drifts) >= 5 and max(drifts.values()) < 1e-8, drifts
    assert numerical["gas_momentum_drift_rel"] < 0.004  # cells are no boxes: 0.0020, 0.0011 with half of their size
    assert summary["heat_exchanged_J"] > 1.0
    _, _, gas = timeline.state_at(timeline.read(out), 0.01)
    assert 0.3 < np.linalg.norm(gas.cell_data["velocity"], axis=1).max() < 3.0  # comes in with 0.3 m/s, round the bed
    mass = 0.6 * 3060.0 * 0.08 * 0.08 * 0.06
    weight = mass * (1.0 - 1.225 / 3060.0) * 9.81 / (np.pi * 0.1**2)
    assert summary["weight_Pa"] == pytest.approx(weight, rel=0.03)  # chords for the arcs
    assert summary["superficial_velocity_m_s"] == pytest.approx(0.3, rel=0.05)
    assert 0.0 < summary["pressure_drop_Pa"] < 2.0 * weight


def test_a_bubble_in_a_round_vessel_is_refused(tmp_path, capsys):
    vessel, out = round_vessel(tmp_path / "vessel", ["bubble"]), tmp_path / "out"
    assert main(["run", str(vessel), "--gas", "openfoam", "--out", str(out)]) == 2
    assert "sdph: run.metrics holds bubble, which is of a plane bed" in capsys.readouterr().err.splitlines()[-1]
    assert not out.exists()


def test_bubble_in_a_tapered_vessel(tmp_path, capsys):
    """A plane mesh that is no grid: bed and gas are measured all the same."""
    vessel, out = tmp_path / "vessel", tmp_path / "out"
    assert main(["init", "bubbling_bed", str(vessel)]) == 0
    (vessel / "gas" / "system" / "blockMeshDict").write_text(own_meshes.taper(0.2, 0.4, 0.4, 10, 20))
    case = tomllib.loads((vessel / "case.toml").read_text())
    case["run"] |= {"end_time_s": 1e-3, "output_interval_s": 1e-3}
    case["domain"]["size_m"] = [0.4, 0.4]
    case["resolution"] = {"spacing_mm": 10.0, "cell_mm": 20.0}
    case["particles"]["bed"] |= {"lower_m": [0.1, 0.0], "upper_m": [0.3, 0.2]}
    case["probes"], case["track"] = {}, {}
    inlet = {"kind": "velocity_inlet", "side": "bottom", "velocity_m_s": [0.0, 0.3]}
    outlet = {"kind": "pressure_outlet", "side": "top"}
    case["boundaries"] = {"inlet": inlet, "outlet": outlet, "wall": {"kind": "wall"}}
    (vessel / "case.toml").write_text(tomli_w.dumps(case))
    assert main(["run", str(vessel), "--gas", "openfoam", "--out", str(out)]) == 0, capsys.readouterr().err
    summary = json.loads((out / "summary.json").read_text())
    assert summary["bed_height_m"] == pytest.approx(0.2, abs=0.02)
    assert summary["bubble_area_m2"] < 0.5 * 0.4 * (0.2 + 0.4)
    assert summary["pressure_drop_Pa"] > 0.0
