"""sdphGasFoam on meshes that are no boxes, brought by the user."""

import numpy as np
import own_meshes
import pytest
from gas_boxes import TEMPLATE, box_case

from coupling.openfoam.solver import OpenFoamGas

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
    template = tmp_path / "template"
    for part in ("constant", "system"):
        (template / part).mkdir(parents=True)
        for path in (TEMPLATE / part).iterdir():
            (template / part / path.name).write_bytes(path.read_bytes())
    patches, volume = put_mesh(template)
    (template / "0").mkdir()
    (template / "0" / "U").write_text(uniform_velocity(patches))
    boundaries = {name: {"kind": "wall", "velocity_m_s": list(VELOCITY)} for name in patches}
    gas = OpenFoamGas(box_case((0.2, 0.2, 0.4), 0.02, boundaries=boundaries), tmp_path / "gas", template)
    try:
        gas.start(None, ())
        state = gas.advance(1e-6, {})
    finally:
        gas.close()
    assert gas.mesh.volumes.sum() == pytest.approx(volume, rel=0.05)  # chords for the arcs of a cylinder
    assert np.abs(state.fields["velocity"] - VELOCITY).max() < 1e-12


def uniform_velocity(patches) -> str:
    value = f"uniform ({' '.join(map(str, VELOCITY))})"
    fixed = "".join(f"    {name} {{ type fixedValue; value {value}; }}\n" for name in patches)
    head = own_meshes.HEAD.format(cls="volVectorField", name="U")
    return f"{head}dimensions [0 1 -1 0 0 0 0];\ninternalField {value};\nboundaryField\n{{\n{fixed}}}\n"
